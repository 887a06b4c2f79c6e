"""Path planning that takes simulated time: modes, invocation, copies, replay, attribution."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from ledger import check_delays

import rmfs
from rmfs.errors import InputError, ReplayError
from rmfs.measure.dictionary import reproducible
from rmfs.simulation.run import Simulation

SHORT = {"layout.robots": 24, "scenario.warmup_s": 100, "scenario.duration_s": 400}
DISTURBED = {
    "scenario.disturbances.breakdowns": {"every_s": 60, "lasting_s": 20},
    "scenario.disturbances.closures": {"every_s": 100, "lasting_s": 40},
    "scenario.disturbances.late_motions": {
        "probability": 0.05,
        "least_s": 1.0,
        "most_s": 10.0,
        "repair": True,
    },
}
WORK = {"pacing.planning": "work", "pacing.planning.seconds_per_label": 0.05}
WALL = {"pacing.planning": "wall", "pacing.planning.speed": 3000.0}
MODES: dict[str, dict[str, Any]] = {
    "fixed": {"pacing.planning": "fixed=1.5"},
    "fixed, saturated": {"pacing.planning": "fixed=8"},
    "each": {"pacing.planning": "fixed=4", "pacing.planning.planners": "each"},
    "work": WORK,
    "wall": WALL,
    "periodic": {"pacing.planning": "fixed=0.5", "pacing.planning.period_s": 7},
    "lazy": {"pacing.planning": "work", "pacing.planning.lazy": True},
}


def simulated(given: dict[str, Any], **options: Any) -> Any:
    return rmfs.simulate(seed=2, set=SHORT | given, trace=True, **options)


def searches(run: Any) -> Any:
    return run.table("plans").drop(columns="wall_s")


def same(one: Any, other: Any, ignore: tuple[str, ...] = ()) -> bool:
    columns = [name for name in reproducible("footprint") if name not in ignore]
    moved = all(np.array_equal(one.trace[name], other.trace[name]) for name in one.trace)
    return moved and one.footprint[columns].equals(other.footprint[columns])


@pytest.fixture(scope="module")
def instant() -> Any:
    return simulated({})


@pytest.mark.parametrize(
    "given",
    [
        {"pacing.planning": "fixed=0"},
        {"pacing.planning": "fixed=0", "pacing.planning.planners": "each"},
        {
            "pacing.planning": "work",
            "pacing.planning.seconds_per_label": 0,
            "pacing.planning.seconds_per_search": 0,
        },
    ],
)
def test_plans_that_take_no_time_change_nothing(given: dict[str, Any], instant: Any) -> None:
    run = simulated(given)
    assert same(run, instant)
    assert (run.footprint["planning_charged_s"], run.footprint["plan_wait_s"]) == (0.0, 0.0)
    plans = run.table("plans")
    assert not plans["took_us"].any() and len(plans) > 100
    assert instant.table("plans").empty


@pytest.mark.parametrize("disturbed", [False, True])
@pytest.mark.parametrize("mode", MODES)
def test_runs_are_safe_and_their_delays_add_up(mode: str, disturbed: bool, instant: Any) -> None:
    run = simulated(MODES[mode] | (DISTURBED if disturbed else {}))
    assert run.check().ok
    check_delays(run)
    plans, trips = run.table("plans"), run.table("trips")
    assert (plans["begun_us"] >= plans["asked_us"]).all()
    assert run.footprint["plan_wait_s"] > 0 or mode == "lazy"
    assert (trips["awaited_s"] <= trips["end_s"] - trips["start_s"]).all()
    # what began in the measured time is charged in it
    measured = plans[plans["begun_us"] > SHORT["scenario.warmup_s"] * 1e6]
    charged_s = measured["took_us"].sum() / 1e6
    assert run.footprint["planning_charged_s"] == pytest.approx(charged_s, abs=1e-9)
    robots = run.table("robots")
    assert robots["awaiting_plan_s"].sum() == run.footprint["plan_wait_s"]
    assert (robots["awaiting_plan_s"] <= robots["waiting_s"] + 1e-9).all()
    if not disturbed:
        assert not same(run, instant)


def test_one_planner_makes_one_plan_at_a_time() -> None:
    plans = simulated(MODES["fixed, saturated"]).table("plans")
    # a plan may need several searches, of which the first is charged
    took_us = plans.groupby("begun_us")["took_us"].sum()
    assert set(took_us) == {8_000_000}
    # always busy, for there are always robots that wait
    assert (np.diff(took_us.index) == 8_000_000).all()
    assert (plans.groupby("begun_us")["robot"].nunique() == 1).all()


def test_with_a_planner_for_each_robot_none_waits_for_another() -> None:
    plans = simulated(MODES["each"]).table("plans")
    plans = plans[plans["took_us"] > 0]
    again = plans.groupby("robot")["begun_us"].shift() + 4_000_000
    started = plans["asked_us"].where(again.isna(), np.maximum(plans["asked_us"], again))
    assert (plans["begun_us"] == started).all()


def test_a_batch_begins_at_multiples_of_the_period_with_loaded_robots() -> None:
    run = simulated({"pacing.planning": "instant", "pacing.planning.period_s": 7})
    plans = run.table("plans")
    assert not (plans["begun_us"] % 7_000_000).any()
    assert (plans["begun_us"] - plans["asked_us"] < 7_000_000).all()
    turns = plans.drop_duplicates(["robot", "begun_us"])
    loaded_first = 0
    for _, batch in turns.groupby("begun_us"):
        falls = (batch["asked_us"].diff() < 0).sum()
        # in the order of requests among those with a pod, and among those without
        assert falls <= 1
        loaded_first += falls
    assert loaded_first > 5


def test_a_robot_departs_when_its_plan_is_there() -> None:
    """No motion of a trip starts before the end of its search, and the wait is that of the plan."""
    run = simulated(MODES["fixed"])
    plans, trips = run.table("plans"), run.table("trips")
    trips = trips[(trips["awaited_s"] > 0) & (trips["start_s"] > 110)]
    assert len(trips) > 20
    ready_us = set(zip(plans["robot"], plans["begun_us"] + plans["took_us"], strict=True))
    moves = {kind: run.trace[kind] for kind in ("robot", "t0_us", "t1_us", "kind")}
    for trip in trips.itertuples():
        begin_us = round(trip.start_s * 1e6)
        there_us = begin_us + round(trip.awaited_s * 1e6)
        assert (trip.robot, there_us) in ready_us
        during = (moves["robot"] == trip.robot) & (moves["t0_us"] < there_us)
        during &= moves["t1_us"] > begin_us
        assert (moves["kind"][during] == 0).all(), (trip, moves["kind"][during])


def test_labels_are_charged_at_their_rate() -> None:
    plans = simulated(WORK | {"pacing.planning.seconds_per_search": 0.25}).table("plans")
    expected_us = 250_000 + 50_000 * plans["labels"]
    assert (np.abs(plans["took_us"] - expected_us) <= 1).all()
    assert (plans["labels"] > 0).any()


@pytest.mark.parametrize("given", [WALL, WALL | DISTURBED, WORK, MODES["periodic"]])
def test_a_replay_repeats_the_run(given: dict[str, Any], tmp_path: Path) -> None:
    run = simulated(given)
    run.save(tmp_path / "run")
    disturbances = {key: value for key, value in given.items() if "disturbances" in key}
    replay = {"pacing.planning": f"replay={tmp_path / 'run'}"}
    again = simulated(disturbances | replay)
    assert same(again, run)
    assert searches(again).equals(searches(run))


def test_a_replay_of_another_run_is_refused(tmp_path: Path) -> None:
    simulated(WORK).save(tmp_path / "run")
    replay = {"pacing.planning": f"replay={tmp_path / 'run'}"}
    with pytest.raises(ReplayError, match=r"plan \d+ \(robot \d+ at .* labels\) was another one"):
        simulated(replay | {"layout.robots": 23})
    simulated({}).save(tmp_path / "instant")
    with pytest.raises(InputError, match="plans took no time in that run"):
        simulated({"pacing.planning": f"replay={tmp_path / 'instant'}"})


@pytest.mark.parametrize("mode", ["fixed, saturated", "each", "work", "periodic", "lazy"])
def test_a_copy_made_while_robots_wait_for_plans_continues_identically(
    mode: str, tmp_path: Path
) -> None:
    given = SHORT | MODES[mode] | DISTURBED
    whole = rmfs.simulate(seed=2, set=given, trace=True)
    simulation = Simulation(seed=2, set=given, trace=True)
    simulation.run_until(203.7)
    twin = simulation.fork()
    simulation.save(tmp_path / "state")
    loaded = Simulation.load(tmp_path / "state")
    for copied in (twin, loaded, simulation):
        copied.run()
        assert same(copied.result(), whole)
        assert searches(copied.result()).equals(searches(whole))


def test_measured_planning_cannot_be_copied() -> None:
    simulation = Simulation(set=SHORT | WALL)
    with pytest.raises(InputError, match=r"pacing.planning wall cannot be copied"):
        simulation.fork()


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"pacing.planning": "fixd=1"}, "fixd=1: no such mode; did you mean fixed"),
        ({"pacing.planning": 3}, "3: no such mode; valid: instant, fixed, work, wall, replay"),
        ({"pacing.planning": "fixed"}, "must have a value, as in fixed=SECONDS"),
        ({"pacing.planning": "work=2"}, "work takes no value after ="),
        ({"pacing.planning": "fixed=-1"}, "seconds"),
        ({"pacing.planning": "fixed=1", "pacing.planning.planners": "two"}, "planners"),
        ({"pacing.planning": "fixed=1", "pacing.planning.speed": 2}, "unknown key speed"),
        ({"pacing.planning.period_s": -1}, "period_s"),
        (
            {"pacing.planning": "fixed=1", "controllers.pp": "whca-n"},
            "not possible with the rolling path planner whca-n",
        ),
    ],
)
def test_wrong_settings_are_refused(given: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=r"^pacing.planning: .*" + message):
        Simulation(set=SHORT | given)
