"""Improving plans: fewer delays, the same safety."""

import pytest
from random_tasks import RandomTasks

from rmfs.layout import load
from rmfs.measure.checker import check
from rmfs.traffic import PlannerSettings

SEEDS = [1, 2, 3]


def tasks_of(labels, seed, layout="study-32", robots=32, until_s=500):
    planner = PlannerSettings("time-windows", {"labels": 50_000, "improve_labels": labels})
    tasks = RandomTasks(load(layout, [(["robots"], robots)]), seed, planner=planner)
    return tasks.run(until_s)


def delay_s(tasks):
    trips = tasks.traffic.trips()
    taken = (trips["t1_us"] - trips["t0_us"]) / 1e6
    return float((taken - trips["unhindered_s"]).mean())


def test_plans_get_better():
    """Over three seeds the robots are late by less, and replacements are counted."""
    before = [tasks_of(0, seed) for seed in SEEDS]
    after = [tasks_of(200, seed) for seed in SEEDS]
    assert all(tasks.traffic.counters()["improvements"] == 0 for tasks in before)
    assert all(tasks.traffic.counters()["improvements"] > 0 for tasks in after)
    assert sum(map(delay_s, after)) < sum(map(delay_s, before))


@pytest.mark.parametrize("seed", SEEDS)
def test_improved_plans_are_safe(seed):
    """In dense traffic, where most plans are late; every robot goes on working."""
    tasks = tasks_of(200, seed, "default", 64)
    report = check(tasks.layout, tasks.traffic.trace(), until_us=500_000_000)
    assert report.ok, report.summary()
    assert {robot for _, robot in tasks.visits} == set(range(64)), tasks.traffic.state_report()


def test_improved_plans_over_elevators_are_safe():
    tasks = tasks_of(200, 1, "study-tiers", 4)
    report = check(tasks.layout, tasks.traffic.trace(), until_us=500_000_000)
    assert report.ok, report.summary()
    assert tasks.traffic.motion()["riding_s"].sum() > 0
