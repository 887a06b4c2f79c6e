"""The tables of the hand-told run against figures worked out on paper."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from fake_run import run

from rmfs.control.solutions import from_text
from rmfs.measure import decisions, footprint, series
from rmfs.measure.dictionary import TABLES, markdown, names, reproducible
from rmfs.measure.footprints import all_tables
from rmfs.measure.tables.motion import HEAT
from rmfs.measure.tables.tidy import tidy


@pytest.fixture(scope="module")
def told():
    return run()


@pytest.fixture(scope="module")
def made(told):
    return all_tables(told)


EXPECTED = {
    "layout": "fake-layout",
    "seed": 3,
    "warmup_s": 100.0,
    "duration_s": 400.0,
    "robots": 2,
    "pods": 3,
    "pick_stations": 2,
    "replenishment_stations": 1,
    "skus": 2,
    "orders_completed": 1,  # order 0 was done in the warm-up, order 2 never
    "lines_picked": 2,
    "units_picked": 2,
    "bundles_stored": 1,
    "orders_per_h": 9.0,
    "units_per_h": 18.0,
    "lines_per_h": 18.0,
    "bundles_per_h": 9.0,
    "units_per_h_bound": 2 * 41 * 9.0,  # two stations, 10 s a unit: 41 picks may start in 400 s
    "units_score": 2 / 82,
    "units_per_h_at_pile_on": 720.0,
    "pick_visits": 2,
    "replenishment_visits": 1,
    "units_per_visit": 1.0,
    "lines_per_visit": 1.0,
    "orders_per_visit": 0.5,
    "bundles_per_visit": 1.0,
    "late_bound_units_per_visit": 1.0,
    "distance_m": 800.0,
    "distance_per_robot_m": 400.0,
    "distance_per_unit_m": 400.0,
    "loaded_distance_m": 400.0,
    "trips": 3,
    "trip_time_mean_s": 20.0,
    "trip_delay_mean_s": 5.0,
    # station 0 was busy 100-115, station 1 200-210, of 400 s each
    "pick_station_idle_share": 1 - 25.0 / 800.0,
    # 250-260 and 495-500
    "replenishment_station_idle_share": 1 - 15.0 / 400.0,
    # robot 0: pick until 110, park until 210; robot 1: from 170 to the end
    "robot_busy_share": (110.0 + 330.0) / 800.0,
    "robot_moving_share": 0.5,
    "robot_queueing_share": 0.2,
    "robot_idle_share": 0.1,
    "order_turnover_mean_s": 210.0,
    "order_turnover_median_s": 210.0,
    "order_throughput_time_median_s": 150.0,
    "late_share": 0.0,
    # order 1 was due at 300, order 2 is at 1000
    "on_time_share": 1.0,
    "lateness_p95_s": -90.0,
    "lateness_max_s": -90.0,
    "orders_overdue_end": 0,
    "oldest_order_end_s": 350.0,
    # order 2 waits from 150 to the end
    "backlog_orders_mean": 350.0 / 400.0,
    "backlog_orders_end": 1,
    # order 1 is open until 210
    "open_orders_mean": 110.0 / 400.0,
    "orders_created": 1,
    "order_redraws": 0,
    "orders_short": 4,  # and 3 in the warm-up
    "bundles_created": 2,
    "units_stored": 4,
    "bundle_turnover_mean_s": 130.0,
    "pods_lifted": 1,
    # 60 at first, 2 taken in the warm-up; then 1 at 108, 2 at 203, and 8 put at 250
    "inventory_share_mean": (58 * 8 + 57 * 95 + 55 * 47 + 63 * 250) / 400.0 / 300.0,
    "plans": 7,
    "plan_failures": 2,
    "replans": 1,
    "expansions": 99,
    "planning_wall_s": 0.25,
    "disturbances": 2,
    "disturbed_s": 400.0,
    "late_motions": 3,
    "lateness_s": 7.5,
    "plans_repaired": 1,
    "orders_cancelled": 0,
    "orders_partial": 0,
    "units_not_delivered": 0,
    "orders_stuck_end": 1,
    "oldest_stuck_end_s": 300.0,
    # two by the rule, two by a solution, one by the rule in place of a solution
    "decisions": 5,
    "decision_wall_s": 0.001,
    "optimiser_calls": 3,
    "optimiser_gap_mean": 0.25,
    "paced_s": 5.0 + 2.0,
    "optimiser_failures": 1,
    "optimiser_wall_s": 0.5,
    "optimiser_decision_share": 2 / 6,
    "heuristic_decision_share": 2 / 6,
    "stale_decision_share": 1 / 6,
    "failed_decision_share": 1 / 6,
    "wall_s": 0.5,
    "sim_per_wall": 1000.0,
}


@pytest.mark.parametrize("column", EXPECTED)
def test_footprint(made, column):
    value = made["footprint"][column].iloc[0]
    expected = EXPECTED[column]
    assert value == (expected if isinstance(expected, str) else pytest.approx(expected))


def test_footprint_is_empty_where_nothing_was_measured(made):
    row = made["footprint"].iloc[0]
    assert pd.isna(row["collisions"])


def test_footprint_tells_collisions_when_the_checker_ran(told):
    from rmfs.measure.checker import CheckReport

    assert footprint(told, CheckReport())["collisions"] == 0


def test_every_column_is_described_and_in_order(made):
    for name, frame in made.items():
        assert list(frame.columns) == names(name)
        described = {column.name: column.dtype for column in TABLES[name]}
        assert {column: str(frame[column].dtype) for column in frame} == described


PROMISED = """
layout scenario controllers seed warmup_s duration_s tiers robots pods pick_stations
replenishment_stations skus orders_completed lines_picked units_picked bundles_stored orders_per_h
lines_per_h units_per_h bundles_per_h units_per_h_bound units_score pick_visits units_per_visit
lines_per_visit orders_per_visit bundles_per_visit distance_m distance_per_robot_m
distance_per_unit_m trips trip_time_mean_s pick_station_idle_share
replenishment_station_idle_share robot_busy_share robot_moving_share robot_queueing_share
order_turnover_mean_s order_turnover_median_s order_throughput_time_median_s late_share
backlog_orders_mean inventory_share_mean plans plan_failures replans collisions decisions
decision_wall_s optimiser_calls optimiser_gap_mean paced_s wall_s sim_per_wall peak_rss_mb
"""


def test_footprint_begins_with_the_promised_columns():
    promised = PROMISED.split()
    assert names("footprint")[: len(promised)] == promised


def test_measured_columns_do_not_repeat():
    told = set(names("footprint")) - set(reproducible("footprint"))
    of_optimisers = {"optimiser_wall_s", "optimiser_wall_median_s"}
    of_others = {"wall_s", "sim_per_wall", "peak_rss_mb", "decision_wall_s", "planning_wall_s"}
    assert told == of_optimisers | of_others


def test_dictionary_says_something_of_every_column():
    for columns in TABLES.values():
        assert len({column.name for column in columns}) == len(columns)
        assert all(column.meaning for column in columns)
    page = markdown()
    assert all(f"| `{column.name}` |" in page for columns in TABLES.values() for column in columns)


def test_undescribed_columns_are_refused():
    with pytest.raises(ValueError, match="colour"):
        tidy("heat", HEAT, {name: [] for name in [*names("heat"), "colour"]})
    with pytest.raises(ValueError, match="visits"):
        tidy("heat", HEAT, {name: [] for name in names("heat") if name != "visits"})


def test_series(told):
    frame = series(told)
    assert frame["time_s"].tolist() == [160, 220, 280, 340, 400, 460, 500]
    assert frame["interval_s"].tolist() == [60] * 6 + [40]
    assert frame["units_picked"].tolist() == [1, 1, 0, 0, 0, 0, 0]
    assert frame["orders_completed"].tolist() == [0, 1, 0, 0, 0, 0, 0]
    assert frame["bundles_stored"].tolist() == [0, 0, 1, 0, 0, 0, 0]
    assert frame["backlog_orders"].tolist() == [1] * 7
    assert frame["open_orders"].tolist() == [1, 0, 0, 0, 0, 0, 0]
    assert frame["backlog_bundles"].tolist() == [2, 2, 1, 1, 1, 1, 1]
    assert frame["distance_m"].tolist() == [120] * 6 + [80]
    assert frame["robots_moving"].tolist() == pytest.approx([1.0] * 7)
    assert frame["robots_task_pick"].tolist() == [0, 1, 0, 0, 0, 0, 0]
    assert frame["robots_task_rest"].tolist() == [1, 1, 1, 1, 1, 1, 1]
    assert frame["robots_task_replenish"].tolist() == [0, 0, 1, 1, 1, 1, 1]
    assert frame["pick_station_busy_share"].tolist()[:2] == pytest.approx([15 / 120, 10 / 120])
    assert frame["inventory_share"].iloc[-1] == pytest.approx(63 / 300)


def test_stations(made):
    frame = made["stations"]
    assert frame["kind"].tolist() == ["pick", "pick", "replenishment"]
    assert frame["units_picked"].tolist() == [1, 1, 0]
    assert frame["late_bound_units"].tolist() == [1, 1, 0]
    assert frame["orders_completed"].tolist() == [1, 0, 0]
    assert frame["bundles_stored"].tolist() == [0, 0, 1]
    assert frame["visits"].tolist() == [1, 1, 1]
    assert frame["visit_time_mean_s"].tolist()[:2] == [60.0, 30.0]
    assert frame["busy_s"].tolist() == pytest.approx([15.0, 10.0, 15.0])
    assert frame["active_share"].tolist() == [1.0, 0.5, 1.0]
    assert frame["units_per_h_at_pile_on"].tolist()[:2] == [360.0, 360.0]


def test_orders(made):
    frame = made["orders"]
    assert frame["order"].tolist() == [1, 2]  # order 0 was done before the measured time
    assert frame["units"].tolist() == [3, 3]
    assert frame["turnover_s"].iloc[0] == 210.0
    assert frame["lateness_s"].iloc[0] == -90.0
    assert frame["completed_s"].isna().tolist() == [False, True]


def test_robots(made):
    frame = made["robots"]
    assert frame["task_pick_s"].tolist() == [10.0, 60.0]
    assert frame["task_park_s"].tolist() == [100.0, 0.0]
    assert frame["task_rest_s"].tolist() == [290.0, 70.0]
    assert frame["tasks_pick"].tolist() == [0, 1]
    assert frame["units_picked"].tolist() == [1, 1]
    assert frame["pods_lifted"].tolist() == [0, 1]


def test_pods_and_skus(made):
    assert made["pods"]["lifts"].tolist() == [0, 1, 0]
    assert made["pods"]["units_picked"].tolist() == [1, 1, 0]
    assert made["pods"]["pick_visits"].tolist() == [1, 1, 0]
    assert made["skus"]["units_picked"].tolist() == [1, 1]
    assert made["skus"]["pods_end"].tolist() == [2, 2]


def test_trips_heat_and_decisions(told, made):
    assert made["trips"]["kind"].tolist() == ["to_pod", "to_station", "to_storage"]
    assert made["heat"]["visits"].sum() == 66
    assert decisions(told)["time_s"].tolist() == [150.0, 160.0, 300.0, 490.0]


def test_questions_to_optimisers(made):
    asked = made["decisions"].iloc[1:]
    assert asked["source"].unique().tolist() == ["optimiser"]
    assert asked["outcome"].tolist() == ["solution", "failed", "waiting"]
    assert asked["failure"].tolist() == ["", "its worker died", ""]
    assert asked["sizes"].tolist() == ["orders=8 pods=3"] * 3
    assert asked["decisions"].tolist() == [2, 1, 0]
    assert asked["paced_s"].iloc[:2].tolist() == [5.0, 2.0]
    assert (asked["build_s"].iloc[0], asked["solve_s"].iloc[0]) == (0.125, 0.375)
    assert asked[["applied", "stale", "fallback"]].to_numpy().tolist() == [
        [2, 1, 0],
        [0, 0, 1],
        [0, 0, 0],
    ]
    assert made["decisions"]["call"].isna().tolist() == [True, False, False, False]


def test_answers_are_kept_whole_warm_up_included(made):
    kept = made["answers"]
    assert kept["call"].tolist() == [0, 1, 2, 3]
    assert kept["requested_us"].tolist() == [50_000_000, 160_000_000, 300_000_000, 490_000_000]
    assert kept["completed_us"].tolist() == [60_000_000, 165_000_000, 302_000_000, -1]
    solution = from_text(kept["solution"].iloc[0])
    assert solution["order"].dtype == np.int64
    assert (solution["order"].tolist(), solution["share"]) == ([4, 2], 0.1)
    assert kept["solution"].tolist()[2:] == ["", ""]


def test_a_question_at_the_end_of_the_warm_up_is_measured():
    # in floating-point numbers, 16.1 x 1e6 is slightly more than 16,100,000
    told = run()
    told.recorder.start_s = 16.1
    told.recorder.questions[0].requested_us = 16_100_000
    asked = decisions(told)
    assert asked["call"].dropna().tolist() == [0, 1, 2, 3]
