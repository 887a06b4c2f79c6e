"""Whether more or less of a column of the footprint is better."""

from __future__ import annotations

from typing import Literal, cast

Better = Literal["more", "less", "neither"]

_MORE = """
orders_completed lines_picked units_picked bundles_stored units_stored
orders_per_h lines_per_h units_per_h bundles_per_h units_score units_per_h_at_pile_on
units_per_visit lines_per_visit orders_per_visit bundles_per_visit late_bound_units_per_visit
sim_per_wall
"""

_LESS = """
robots pods pick_stations replenishment_stations
distance_m distance_per_robot_m distance_per_unit_m loaded_distance_m
trip_time_mean_s trip_delay_mean_s
pick_station_idle_share robot_queueing_share robot_waiting_share
order_turnover_mean_s order_turnover_median_s
order_turnover_lower_quartile_s order_turnover_upper_quartile_s
order_throughput_time_mean_s order_throughput_time_median_s
order_throughput_time_lower_quartile_s order_throughput_time_upper_quartile_s
bundle_turnover_mean_s bundle_turnover_median_s
bundle_turnover_lower_quartile_s bundle_turnover_upper_quartile_s
bundle_throughput_time_mean_s bundle_throughput_time_median_s
bundle_throughput_time_lower_quartile_s bundle_throughput_time_upper_quartile_s
late_share orders_late late_by_mean_s late_by_median_s
late_by_lower_quartile_s late_by_upper_quartile_s
order_lateness_mean_s order_lateness_median_s
order_lateness_lower_quartile_s order_lateness_upper_quartile_s
backlog_orders_mean backlog_orders_end backlog_bundles_mean backlog_bundles_end orders_short
plan_failures collisions
optimiser_failures optimiser_gap_mean stale_decision_share failed_decision_share
wall_s decision_wall_s optimiser_wall_s optimiser_wall_median_s planning_wall_s paced_s peak_rss_mb
"""

_GOALS = dict.fromkeys(_MORE.split(), "more") | dict.fromkeys(_LESS.split(), "less")


def better_of(column: str) -> Better:
    """Return what is better of a column of the footprint, all else being equal.

    "neither" is said of inputs, of counts that are means to an end (tasks, trips, decisions), of
    shares that may be high for good and for bad reasons (busy robots), and of unknown columns.
    """
    return cast("Better", _GOALS.get(column, "neither"))
