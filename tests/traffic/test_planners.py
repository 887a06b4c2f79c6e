"""Every path planner on random tasks, each run proved safe by the independent checker."""

import hashlib

import pytest
from random_tasks import RandomTasks

from rmfs.control import registry
from rmfs.control.choices import choose
from rmfs.control.pp import planner_settings
from rmfs.control.problems import Problem
from rmfs.errors import InputError
from rmfs.layout import load
from rmfs.measure.checker import check
from rmfs.traffic import PlannerSettings, Traffic

PLANNERS = [
    *({"name": name} for name in registry.built_in(Problem.PP)),
    {"name": "time-windows", "swift": True},
    {"name": "far", "reroute": False},
    {"name": "whca-v", "runs_granted": 1, "restart_at_once": False},
]
SEEDS = [1, 2]


def settings(table, seed=1):
    return planner_settings(choose(Problem.PP, table, "test"), seed)


def named(table):
    return "-".join(str(value) for value in table.values())


def proved(tasks, until_s):
    report = check(tasks.layout, tasks.traffic.trace(), until_us=round(until_s * 1e6))
    assert report.ok, report.summary()


@pytest.mark.parametrize("table", PLANNERS, ids=named)
@pytest.mark.parametrize("seed", SEEDS)
def test_default_layout(table, seed):
    """16 robots: nobody collides, every robot finishes tasks."""
    layout = load("default", [(["robots"], 16)])
    tasks = RandomTasks(layout, seed, planner=settings(table)).run(700)
    proved(tasks, 700)
    assert {robot for _, robot in tasks.visits} == set(range(16)), tasks.traffic.state_report()


@pytest.mark.parametrize("table", PLANNERS, ids=named)
def test_elevators(table, reference):
    """Three tiers: rides are planned and granted like runs."""
    layout = reference("generated/f-two-tiers-elevators.xinst")
    tasks = RandomTasks(layout, 1, planner=settings(table)).run(500)
    proved(tasks, 500)
    assert len(tasks.visits) > layout.robots / 2
    assert tasks.traffic.motion()["riding_s"].sum() > 0


@pytest.mark.slow
@pytest.mark.parametrize("table", PLANNERS, ids=named)
@pytest.mark.parametrize("name", ["1-4-4-32-550", "1-12-20-128-1965", "3-12-12-96-1650"])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_path_planning_instances(table, name, seed, reference):
    layout = reference(f"pp/{name}.xinst")
    proved(RandomTasks(layout, seed, planner=settings(table)).run(600), 600)


@pytest.mark.parametrize("table", PLANNERS, ids=named)
def test_the_same_seed_gives_the_same_trace(table):
    def digest():
        tasks = RandomTasks(load("default"), 3, planner=settings(table)).run(200)
        trace = tasks.traffic.trace()
        return hashlib.sha256(b"".join(trace[key].tobytes() for key in sorted(trace))).hexdigest()

    assert digest() == digest()


def test_rolling_planners_ask_for_runs_that_are_refused():
    """With one run granted at a time, wishes and what is granted differ now and then."""
    tasks = RandomTasks(
        load("default", [(["robots"], 32)]),
        1,
        planner=settings({"name": "whca-v", "runs_granted": 1}),
    ).run(300)
    counters = tasks.traffic.counters()
    assert counters["refusals"] > 0
    assert counters["replans"] > counters["plans"]


def test_unknown_planner_and_parameters():
    with pytest.raises(InputError, match="no pp rule named whca; did you mean whca-"):
        choose(Problem.PP, {"name": "whca"}, "test")
    with pytest.raises(InputError, match="window_m"):
        choose(Problem.PP, {"name": "whca-v", "window_m": 3}, "test")
    with pytest.raises(ValueError, match="there is no planner magic"):
        Traffic(load("default"), planner=PlannerSettings("magic", {}))
    with pytest.raises(ValueError, match="parameter period_s is missing"):
        Traffic(load("default"), planner=PlannerSettings("far", {}))
