"""Late robots: the order in which waypoints are used stays, times move."""

from __future__ import annotations

import random

import pytest
from random_tasks import RandomTasks

from rmfs.layout import load
from rmfs.measure.checker import check
from rmfs.traffic import Step, Traffic

SECOND = 1_000_000


def stops(traffic, robot):
    """Where the robot will stop, in order."""
    return [move.to_waypoint for move in traffic.plan(robot)]


def run_with_delays(seed, layout="default", robots=24, until_s=900):
    """Random tasks; in every second one robot in a hundred is to go on up to 20 s later."""
    tasks = RandomTasks(load(layout, [(["robots"], robots)]), seed)
    draw = random.Random(seed)
    done = []
    for second in range(until_s):
        tasks.run(second)
        for robot in range(tasks.layout.robots):
            if draw.random() < 0.01:
                before = [stops(tasks.traffic, r) for r in range(tasks.layout.robots)]
                done.append(tasks.traffic.delay(robot, draw.randrange(20 * SECOND)))
                after = [stops(tasks.traffic, r) for r in range(tasks.layout.robots)]
                assert before == after
    return tasks, done


@pytest.mark.parametrize("seed", [1, 2])
def test_delayed_plans_are_safe(seed):
    """Motion not begun may be shifted by any time: nobody meets, everybody goes on."""
    tasks, done = run_with_delays(seed)
    report = check(tasks.layout, tasks.traffic.trace(), until_us=899 * SECOND)
    assert report.ok, report.summary()
    assert sum(done) / len(done) > 0.5
    assert len(tasks.visits) > 50


def test_delays_repeat():
    visits = [run_with_delays(3, until_s=300)[0].visits for _ in range(2)]
    assert visits[0] == visits[1]


@pytest.fixture
def two():
    """The default layout with two robots, and their traffic."""
    layout = load("default", [(["robots"], 2)])
    return layout, Traffic(layout, record_trace=True)


def test_nobody_is_delayed_by_a_robot_out_of_the_way(two):
    """The other robot's plan stays to the microsecond, and the late one's moves by the delay."""
    layout, traffic = two
    places = layout.pod_waypoint.tolist()
    traffic.command(0, [(Step.DRIVE, places[0])])
    traffic.advance(0)
    alone = traffic.plan(0)
    assert alone
    assert traffic.plan(1) == []
    assert traffic.delay(0, 7 * SECOND)
    late = traffic.plan(0)
    assert late[0].start_us - alone[0].start_us == 7 * SECOND
    assert late[-1].end_us - alone[-1].end_us == 7 * SECOND
    events = []
    while not events:
        events = traffic.advance(late[-1].end_us)
    assert events[0][0] == late[-1].end_us


def test_motion_in_progress_ends_later_only_if_asked(two):
    layout, traffic = two
    traffic.command(0, [(Step.DRIVE, layout.pod_waypoint.tolist()[0])])
    first = traffic.plan(0)[0]
    traffic.advance((first.start_us + first.end_us) // 2)
    assert len(traffic.plan(0)) > 1
    assert traffic.delay(0, SECOND)
    assert traffic.plan(0)[0] == first
    assert traffic.delay(0, SECOND, begun=True)
    now = traffic.plan(0)[0]
    assert (now.start_us, now.end_us) == (first.start_us, first.end_us + SECOND)


@pytest.mark.parametrize(("seconds", "later"), [(None, 0), (31, 20 * SECOND), (47, 0)])
def test_a_delayed_trip_to_a_station_ends_where_its_queue_zone_begins(seconds, later):
    """Of a run delayed by 20 s, only what lies after the delay comes later."""
    layout = load("default", [(["robots"], 1)])
    traffic = Traffic(layout)
    place = int(layout.pod_waypoint[7])
    traffic.command(0, [(Step.DRIVE, place), (Step.LIFT, 7), (Step.STATION, 0)])
    heads = []
    while not heads:
        heads = [time for time, kind, _, _ in traffic.advance(traffic.now_us + SECOND) if kind == 5]
        if seconds is not None and traffic.now_us > seconds * SECOND:
            assert traffic.delay(0, 20 * SECOND, begun=True)
            seconds = None
    entered = int(traffic.trips()["t1_us"][-1])
    assert abs(entered - 45_866_667 - later) < 100
    assert abs(traffic.motion()["queueing_s"][0] - (heads[0] - entered) / SECOND) < 1e-6


def test_a_negative_delay_is_refused(two):
    with pytest.raises(ValueError, match="a delay of -1 us"):
        two[1].delay(0, -1)


def test_clearance_ends_before_a_waypoint_in_use():
    """In busy traffic some runs are not clear to their end, and then somebody is in between."""
    tasks = RandomTasks(load("default", [(["robots"], 48)]), 5)
    held_up = 0
    for second in range(0, 600, 5):
        tasks.run(second)
        for robot in range(48):
            moves = tasks.traffic.plan(robot)
            clear = tasks.traffic.clearance(robot)
            assert bool(clear) <= bool(moves)
            if moves and moves[0].start_us < tasks.traffic.now_us:
                held_up += moves[0].to_waypoint not in clear
    assert held_up > 20


def test_regrouping_from_everywhere():
    """All plans are given up again and again; work goes on, in the right places."""
    layout = load("default", [(["robots"], 16)])
    tasks = RandomTasks(layout, 7, record_trace=False)
    for second in range(0, 1200, 30):
        tasks.run(second)
        rests = []
        for robot in range(16):
            moves = tasks.traffic.plan(robot)
            here = moves[0] if moves and moves[0].start_us < tasks.traffic.now_us else None
            if here is not None:
                rests.append((here.to_waypoint, here.heading_rad, here.end_us))
            else:
                at = moves[0].from_waypoint if moves else tasks.traffic.rest_waypoint(robot)
                rests.append((at, 0.0, 0))
        if len({rest[0] for rest in rests}) == 16:
            tasks.traffic.regroup(rests)
    assert len(tasks.visits) > 60


def test_regrouping_refuses_two_robots_at_one_waypoint(two):
    _layout, traffic = two
    at = traffic.rest_waypoint(0)
    with pytest.raises(ValueError, match="robots 0 and 1 cannot both have"):
        traffic.regroup([(at, 0.0, 0), (at, 0.0, 0)])
    assert traffic.rest_waypoint(1) != at


def test_others_are_planned_around_a_robot_that_stands_still():
    """One robot stops on its way for an hour: the others do their tasks, and nobody meets it."""
    layout = load("default", [(["robots"], 12)])
    tasks = RandomTasks(layout, 2, record_trace=False).run(40)
    traffic = tasks.traffic
    stuck = next(
        robot
        for robot in range(12)
        if (moves := traffic.plan(robot))
        and moves[0].start_us < traffic.now_us
        and moves[0].to_waypoint not in layout.pick_stations[0].queue
    )
    assert traffic.delay(stuck, 3600 * SECOND, begun=True)
    rests = []
    for robot in range(12):
        moves = traffic.plan(robot)
        begun = [move for move in moves[:1] if move.start_us < traffic.now_us]
        if robot == stuck:
            rests.append(None)
        elif begun:
            reachable = [begun[0].from_waypoint, *traffic.clearance(robot)][-1]
            rests.append((reachable, begun[0].heading_rad, traffic.now_us + 5 * SECOND))
        else:
            at = moves[0].from_waypoint if moves else traffic.rest_waypoint(robot)
            rests.append((at, 0.0, 0))
    traffic.regroup(rests)
    tasks.run(640)
    assert not any(robot == stuck for _, robot in tasks.visits)
    assert {robot for _, robot in tasks.visits} >= set(range(12)) - {stuck}
