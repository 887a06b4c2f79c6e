"""Whole runs of random tasks, each proved safe by the independent checker."""

import pytest
from random_tasks import RandomTasks

from rmfs.layout import load
from rmfs.measure.checker import check


def proved(tasks, until_s):
    report = check(tasks.layout, tasks.traffic.trace(), until_us=round(until_s * 1e6))
    assert report.ok, report.summary()


@pytest.mark.parametrize("robots", [8, 32, 96])
@pytest.mark.parametrize("seed", [1, 2])
def test_default_layout(robots, seed):
    """One, and three times as many robots as the layout is meant for."""
    tasks = RandomTasks(load("default", [(["robots"], robots)]), seed).run(900)
    proved(tasks, 900)


def test_a_hall_of_highways():
    tasks = RandomTasks(load("basic"), 3).run(1200)
    proved(tasks, 1200)


def test_elevators(reference):
    """Three tiers: one robot an elevator, nobody stranded."""
    tasks = RandomTasks(reference("generated/f-two-tiers-elevators.xinst"), 1).run(1200)
    proved(tasks, 1200)
    assert (tasks.traffic.trips()["unhindered_s"] > 0).all()


def test_path_planning_instance(reference):
    tasks = RandomTasks(reference("pp/1-4-4-32-550.xinst"), 1).run(1800)
    proved(tasks, 1800)


def busy_throughout(tasks, until_s, every_s):
    """Every robot finishes a station visit in every stretch of time."""
    for start in range(0, until_s, every_s):
        seen = {robot for time, robot in tasks.visits if start <= time < start + every_s}
        missing = set(range(tasks.layout.robots)) - seen
        assert not missing, f"{missing} did nothing from {start} s\n{tasks.traffic.state_report()}"


def test_short_cuts_do_not_freeze_the_queue(reference):
    """Trap (a) of first-come queue places: the short cut lets a later robot pass (about 900 s)."""
    tasks = RandomTasks(reference("pp/1-4-4-32-550.xinst"), 1).run(2400)
    busy_throughout(tasks, 2400, 600)


def test_places_are_not_given_away_under_a_waiting_robot(reference):
    """Trap (b): a place offered while the loaded robot still stood there (64 robots, 1,060 s)."""
    tasks = RandomTasks(reference("pp/1-4-4-32-550.xinst", robots=64), 1).run(2400)
    busy_throughout(tasks, 2400, 800)


def test_totals_add_up():
    """The seconds of all states are the time passed; the distance is that of the trace's runs."""
    tasks = RandomTasks(load("default"), 1).run(700)
    motion = tasks.traffic.motion()
    states = ["moving_s", "turning_s", "waiting_s", "served_s", "idle_s", "transfer_s", "riding_s"]
    assert abs(sum(motion[name] for name in states) - 700).max() < 1e-6
    layout, trace = tasks.layout, tasks.traffic.trace()
    runs = (trace["kind"] == 2) & (trace["t1_us"] <= 700e6)
    dx = layout.x_m[trace["to_wp"][runs]] - layout.x_m[trace["from_wp"][runs]]
    dy = layout.y_m[trace["to_wp"][runs]] - layout.y_m[trace["from_wp"][runs]]
    under_way = motion["distance_m"].sum() - (abs(dx) + abs(dy)).sum()
    assert 0 <= under_way < 60 * layout.robots


@pytest.mark.parametrize("reset_s", [333, 457.25])
def test_totals_after_a_reset(reset_s):
    """Motion under way at the reset counts only with what comes after it."""
    tasks = RandomTasks(load("default"), 1).run(reset_s)
    before = tasks.traffic.motion()
    tasks.traffic.reset_statistics()
    assert all(abs(values).max() < 1e-9 for values in tasks.traffic.motion().values())
    after = tasks.run(900).traffic.motion()
    whole = RandomTasks(load("default"), 1).run(900).traffic.motion()
    for name, values in whole.items():
        assert abs(before[name] + after[name] - values).max() < 1e-6, name
    assert (tasks.traffic.trips()["distance_m"] >= 0).all()
