"""Disturbed robots: they stop for a while or drive slower, plans are repaired, nobody collides."""

from __future__ import annotations

import random

import pytest
from random_tasks import RandomTasks

from rmfs.control import registry
from rmfs.control.choices import choose
from rmfs.control.pp import planner_settings
from rmfs.control.problems import Problem
from rmfs.layout import load
from rmfs.measure.checker import FindingKind, Slow, check
from rmfs.traffic import Step, Traffic

SECOND = 1_000_000
SHARES = (0.5, 0.25)


def driven(name, seed=1, robots=24, until_s=600):
    """Random tasks; every few seconds a robot stops for up to a minute or changes its speed."""
    chosen = planner_settings(choose(Problem.PP, {"name": name}, "test"), seed)
    layout = load("default", [(["robots"], robots)])
    tasks = RandomTasks(layout, seed, planner=chosen)
    tasks.traffic = Traffic(layout, record_trace=True, planner=chosen, slow_shares=SHARES)
    tasks.bound_for = [0] * len(layout.stations)
    tasks.idle_pods = list(range(layout.pods))
    for robot in range(robots):
        tasks.fetch(robot)
    draw = random.Random(seed)
    level, since, slow = [0] * robots, [0] * robots, []
    held = changed = 0
    for second in range(until_s):
        tasks.run(second)
        robot, now = draw.randrange(robots), second * SECOND
        if draw.random() < 0.1:
            held += tasks.traffic.hold(robot, draw.randrange(60 * SECOND)) is not None
        wanted = draw.randrange(len(SHARES) + 1)
        if wanted != level[robot] and tasks.traffic.slow_down(robot, wanted):
            if level[robot]:
                slow.append(Slow(robot, since[robot], now, SHARES[level[robot] - 1]))
            level[robot], since[robot] = wanted, now
            changed += 1
    end = 10**15
    slow += [Slow(r, since[r], end, SHARES[k - 1]) for r, k in enumerate(level) if k]
    assert held > until_s / 40
    assert changed > until_s / 20
    return tasks, slow


@pytest.mark.parametrize("name", registry.built_in(Problem.PP))
def test_disturbed_traffic_is_safe_and_goes_on(name):
    tasks, slow = driven(name)
    until_us = tasks.traffic.now_us
    report = check(tasks.layout, tasks.traffic.trace(), until_us=until_us, slow=slow)
    assert report.ok, report.summary()
    assert len(tasks.visits) > 24
    states = ["moving_s", "turning_s", "waiting_s", "served_s", "idle_s", "transfer_s", "riding_s"]
    motion = tasks.traffic.motion()
    assert abs(sum(motion[s] for s in states) - until_us / SECOND).max() < 1e-6


def test_the_checker_holds_slow_robots_to_their_speed():
    """Told that they should be fast, or slow at other times, runs are too long or short."""
    tasks, slow = driven("time-windows", seed=2, until_s=300)
    trace, until_us = tasks.traffic.trace(), tasks.traffic.now_us
    assert check(tasks.layout, trace, until_us=until_us, slow=slow).ok
    assert check(tasks.layout, trace, until_us=until_us).ok  # each run tells its own top speed
    without = check(tasks.layout, trace, until_us=until_us, slow=())
    assert without.of(FindingKind.DURATION)
    other = [one._replace(share=one.share * 0.9) for one in slow]
    assert check(tasks.layout, trace, until_us=until_us, slow=other).of(FindingKind.DURATION)


@pytest.fixture
def one():
    layout = load("default", [(["robots"], 1)])
    return layout, Traffic(layout, record_trace=True, slow_shares=(0.5,))


def finished(traffic, until_s=600):
    """When the robot has done all it was told."""
    while events := traffic.advance(until_s * SECOND):
        if events[-1][1] == 8:
            return events[-1][0]
    raise AssertionError


def test_a_robot_that_stands_is_late_by_its_breakdown(one):
    layout, traffic = one
    goal = layout.pod_waypoint.tolist()[0]
    traffic.command(0, [(Step.DRIVE, goal)])
    planned = traffic.plan(0)[-1].end_us
    assert traffic.hold(0, 30 * SECOND) == 30 * SECOND
    assert finished(traffic) == planned + 30 * SECOND


def test_a_breakdown_in_a_run_begins_where_it_ends(one):
    """It is shortened by what the robot would have waited there anyway: nothing here."""
    layout, traffic = one
    goal = layout.pod_waypoint.tolist()[0]
    traffic.command(0, [(Step.DRIVE, goal), (Step.LIFT, 0)])
    plan = traffic.plan(0)
    traffic.advance((plan[-1].start_us + plan[-1].end_us) // 2)
    until = traffic.hold(0, 30 * SECOND)
    assert until == plan[-1].end_us + 30 * SECOND
    lift_us = round(layout.robot_kinds[0].pod_transfer_s * SECOND)
    assert finished(traffic) == until + lift_us
    assert check(layout, traffic.trace(), until_us=traffic.now_us).ok


def test_at_half_speed_a_long_run_takes_longer(one):
    """At v the time of l metres is l / v + v / 2a + v / 2b, if top speed is reached."""
    layout, traffic = one
    kind = layout.robot_kinds[0]
    goal = layout.pod_waypoint.tolist()[0]
    traffic.command(0, [(Step.DRIVE, goal)])
    before = traffic.plan(0)
    assert traffic.slow_down(0, 1)
    for old, new in zip(before, traffic.plan(0), strict=True):
        metres = abs(layout.x_m[old.to_waypoint] - layout.x_m[old.from_waypoint])
        metres += abs(layout.y_m[old.to_waypoint] - layout.y_m[old.from_waypoint])
        for move, v in ((old, kind.top_speed_m_s), (new, kind.top_speed_m_s / 2)):
            extra = v / 2 / kind.acceleration_m_s2 + v / 2 / kind.deceleration_m_s2
            if metres >= extra * v:
                took = (move.end_us - move.start_us) / SECOND
                assert took == pytest.approx(metres / v + extra, abs=2e-6)
    assert traffic.plan(0)[-1].end_us > before[-1].end_us
    assert traffic.slow_down(0, 0)
    assert traffic.plan(0)[-1].end_us >= before[-1].end_us
