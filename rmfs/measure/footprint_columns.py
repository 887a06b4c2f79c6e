"""The columns of the footprint."""

from __future__ import annotations

from rmfs.measure.columns import COUNT_OR_EMPTY, INTEGER, REAL, TEXT, Column


def _shares_of_robots() -> tuple[Column, ...]:
    told = {
        "waiting": "standing with a way to go, or in a queue",
        "turning": "turning on the spot",
        "served": "standing at a station",
        "transfer": "lifting or setting down a pod",
        "riding": "in an elevator",
        "idle": "standing without anything to do",
    }
    return tuple(
        Column(f"robot_{name}_share", REAL, "share", f"Robot time {what}")
        for name, what in told.items()
    )


def _quartiles(name: str, meaning: str) -> tuple[Column, ...]:
    told = {"lower_quartile": "First quartile of", "upper_quartile": "Third quartile of"}
    return tuple(
        Column(f"{name}_{key}_s", REAL, "s", f"{what} {meaning}") for key, what in told.items()
    )


def _spread(name: str, meaning: str) -> tuple[Column, ...]:
    told = {"mean": "Mean of", "median": "Median of"}
    return (
        *(Column(f"{name}_{key}_s", REAL, "s", f"{what} {meaning}") for key, what in told.items()),
        *_quartiles(name, meaning),
    )


FOOTPRINT = (
    Column("layout", TEXT, "", "Name of the layout"),
    Column("scenario", TEXT, "", "Name of the scenario"),
    Column("controllers", TEXT, "", "Name of the set of controllers, and exchanges by hand"),
    Column("seed", INTEGER, "", "Seed of all random streams of the run"),
    Column("warmup_s", REAL, "s", "Simulated time before the measured time"),
    Column("duration_s", REAL, "s", "Measured time"),
    Column("tiers", INTEGER, "tiers", "Floors of the layout"),
    Column("robots", INTEGER, "robots", "Robots"),
    Column("pods", INTEGER, "pods", "Pods"),
    Column("pick_stations", INTEGER, "stations", "Pick stations"),
    Column("replenishment_stations", INTEGER, "stations", "Replenishment stations"),
    Column("skus", INTEGER, "SKUs", "SKUs of the scenario"),
    Column("orders_completed", INTEGER, "orders", "Pick orders whose last unit was picked"),
    Column("lines_picked", INTEGER, "lines", "Order lines whose last unit was picked"),
    Column("units_picked", INTEGER, "units", "Units picked from pods into orders"),
    Column("bundles_stored", INTEGER, "bundles", "Replenishment bundles put into pods"),
    Column("orders_per_h", REAL, "1/h", "orders_completed / duration"),
    Column("lines_per_h", REAL, "1/h", "lines_picked / duration"),
    Column("units_per_h", REAL, "1/h", "units_picked / duration"),
    Column("bundles_per_h", REAL, "1/h", "bundles_stored / duration"),
    Column(
        "units_per_h_bound",
        REAL,
        "1/h",
        "No run of this layout with these SKUs picks more in such a time, under any controllers, "
        "demand or seed: proven (see bounds)",
    ),
    Column("units_score", REAL, "share", "units_per_h / units_per_h_bound; at most 1"),
    Column(
        "pick_visits",
        INTEGER,
        "visits",
        "Stays of a pod at a pick station in which at least one unit was picked; a pod that keeps "
        "its place for further requests makes one visit",
    ),
    Column("units_per_visit", REAL, "units", "Pile-on: units_picked / pick_visits"),
    Column("lines_per_visit", REAL, "lines", "lines_picked / pick_visits"),
    Column("orders_per_visit", REAL, "orders", "orders_completed / pick_visits"),
    Column("bundles_per_visit", REAL, "bundles", "bundles_stored / replenishment_visits"),
    Column("distance_m", REAL, "m", "Distance driven by all robots"),
    Column("distance_per_robot_m", REAL, "m", "distance_m / robots"),
    Column("distance_per_unit_m", REAL, "m", "distance_m / units_picked"),
    Column(
        "trips",
        INTEGER,
        "trips",
        "Trips that ended: to a pod, to a station (ending at its queue zone), to a storage place, "
        "or to a resting place",
    ),
    Column("trip_time_mean_s", REAL, "s", "Mean time from the start to the end of a trip"),
    Column(
        "pick_station_idle_share",
        REAL,
        "share",
        "1 - time in which the stations handle a unit / (pick stations x duration)",
    ),
    Column(
        "replenishment_station_idle_share",
        REAL,
        "share",
        "1 - time in which the stations handle a bundle / (replenishment stations x duration)",
    ),
    Column(
        "robot_busy_share",
        REAL,
        "share",
        "Robot time with a task other than resting (pick, replenish, park, reposition)",
    ),
    Column("robot_moving_share", REAL, "share", "Robot time driving"),
    Column(
        "robot_queueing_share",
        REAL,
        "share",
        "Robot time from entering a station's queue zone to standing at the station; overlaps with "
        "the other shares",
    ),
    Column("order_turnover_mean_s", REAL, "s", "Mean time from arrival to completion of an order"),
    Column("order_turnover_median_s", REAL, "s", "Median of the same"),
    Column(
        "order_throughput_time_median_s",
        REAL,
        "s",
        "Median time from an order's assignment to a station to its completion",
    ),
    Column(
        "late_share", REAL, "share", "Completed orders that were completed after their due time"
    ),
    Column(
        "backlog_orders_mean",
        REAL,
        "orders",
        "Time average of the number of orders that wait for a station",
    ),
    Column(
        "inventory_share_mean",
        REAL,
        "share",
        "Time average of the space that stored units use / capacity of all pods",
    ),
    Column("plans", INTEGER, "plans", "Paths planned and accepted"),
    Column("plan_failures", INTEGER, "plans", "Searches that found no path yet"),
    Column("replans", INTEGER, "plans", "Paths changed before they were driven to the end"),
    Column(
        "collisions",
        COUNT_OR_EMPTY,
        "events",
        "Overlaps of two bodies found by the independent trace checker, warm-up included; empty "
        "where it did not run",
    ),
    Column("decisions", INTEGER, "decisions", "Decisions given by all controllers"),
    Column(
        "decision_wall_s",
        REAL,
        "s",
        "Wall time spent in controllers, also where they came to no decision",
        measured=True,
    ),
    Column("optimiser_calls", INTEGER, "calls", "Decision problems handed to an optimiser"),
    Column(
        "optimiser_gap_mean",
        REAL,
        "share",
        "Mean relative gap between value and bound of the optimisers' solutions; empty without",
    ),
    Column(
        "paced_s",
        REAL,
        "s",
        "Simulated time from questions to optimisers to their answers, added up",
    ),
    Column(
        "wall_s", REAL, "s", "Wall time of the whole simulation, loading excluded", measured=True
    ),
    Column("sim_per_wall", REAL, "s/s", "(warmup_s + duration_s) / wall_s", measured=True),
    Column("peak_rss_mb", REAL, "MB", "Largest memory the process has used", measured=True),
    # from here on: further columns, in no promised order
    Column(
        "optimiser_failures", INTEGER, "calls", "Questions whose optimiser died, hung or raised"
    ),
    Column("optimiser_wall_s", REAL, "s", "Wall time of all optimisers", measured=True),
    Column(
        "optimiser_wall_median_s", REAL, "s", "Wall time of an optimiser, median", measured=True
    ),
    *(
        Column(
            f"{source}_decision_share",
            REAL,
            "share",
            f"Decisions {what} / all of these four kinds; empty if nobody asks optimisers",
        )
        for source, what in {
            "optimiser": "by solutions of optimisers",
            "heuristic": "by the own rule of controllers that ask optimisers",
            "stale": "of solutions that no longer held",
            "failed": "by the own rule because an optimiser failed or found nothing",
        }.items()
    ),
    Column(
        "units_per_h_at_pile_on",
        REAL,
        "1/h",
        "What the pick stations would pick with the pile-on of this run, never waiting for a pod "
        "longer than motion needs (see measures): sum over stations",
    ),
    Column("orders_created", INTEGER, "orders", "Orders that arrived"),
    Column("order_redraws", INTEGER, "draws", "Drawn orders that the stock could not serve"),
    Column(
        "orders_short",
        INTEGER,
        "orders",
        "Orders for which stock was short when they arrived: there was less than they and the "
        "orders before them want; they wait",
    ),
    Column("backlog_orders_end", INTEGER, "orders", "Orders that wait for a station at the end"),
    Column("open_orders_mean", REAL, "orders", "Time average of the orders open at stations"),
    Column("bundles_created", INTEGER, "bundles", "Bundles that arrived"),
    Column("units_stored", INTEGER, "units", "Units in the stored bundles"),
    Column(
        "replenishment_visits",
        INTEGER,
        "visits",
        "Stays of a pod at a replenishment station in which at least one bundle was stored",
    ),
    Column(
        "late_bound_units_per_visit",
        REAL,
        "units",
        "Units picked that were bound to the pod after its robot had got the task / pick_visits",
    ),
    Column("order_turnover_lower_quartile_s", REAL, "s", "First quartile of order turnover"),
    Column("order_turnover_upper_quartile_s", REAL, "s", "Third quartile of order turnover"),
    Column("order_throughput_time_mean_s", REAL, "s", "Mean time from assignment to completion"),
    Column("bundle_turnover_mean_s", REAL, "s", "Mean time from a bundle's arrival to its storage"),
    Column("bundle_turnover_median_s", REAL, "s", "Median of the same"),
    Column("pods_lifted", INTEGER, "lifts", "Pods lifted"),
    Column("loaded_distance_m", REAL, "m", "Distance driven with a pod"),
    Column(
        "trip_delay_mean_s",
        REAL,
        "s",
        "Mean of trip time less a lower bound of the time the trip takes without other robots; "
        "trips to stations are left out, since the bound there depends on the queue place",
    ),
    *_shares_of_robots(),
    *(
        Column(f"tasks_{task}", INTEGER, "tasks", f"Tasks {task} started")
        for task in ("pick", "replenish", "park", "reposition", "rest")
    ),
    Column("orders_late", INTEGER, "orders", "Orders completed after their due time"),
    *_spread("order_lateness", "completion less due time of an order, negative if early"),
    *_spread("late_by", "completion less due time of the late orders"),
    *_quartiles("order_throughput_time", "time from assignment to completion"),
    *_quartiles("bundle_turnover", "time from a bundle's arrival to its storage"),
    *_spread("bundle_throughput_time", "time from a bundle's assignment to its storage"),
    Column(
        "backlog_bundles_mean",
        REAL,
        "bundles",
        "Time average of the bundles not yet given pod and station",
    ),
    Column("backlog_bundles_end", INTEGER, "bundles", "Bundles not yet given both at the end"),
    Column(
        "pick_station_active_share", REAL, "share", "Pick stations' time switched on / duration"
    ),
    Column(
        "replenishment_station_active_share",
        REAL,
        "share",
        "Replenishment stations' time switched on / duration",
    ),
    Column("expansions", INTEGER, "labels", "Labels expanded by the path planner"),
    Column(
        "disturbances",
        INTEGER,
        "disturbances",
        "Breakdowns, slow robots, closed waypoints and elevators out of use in the measured time",
    ),
    Column("disturbed_s", REAL, "s", "How long these lasted, added up, within the measured time"),
    Column("planning_wall_s", REAL, "s", "Wall time spent in path planning", measured=True),
)
