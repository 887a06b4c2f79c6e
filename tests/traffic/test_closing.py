"""Closed waypoints and elevators out of service: plans are changed, everything goes on."""

from __future__ import annotations

import random

import numpy as np
import pytest
from random_tasks import RandomTasks

from rmfs.layout import load
from rmfs.measure.checker import check
from rmfs.traffic import EventKind, Piece, Step, Traffic

SECOND = 1_000_000


def passed(layout, from_waypoint, to_waypoint):
    """Waypoints of a straight run behind its first: all on the segment, nearest first."""
    x, y = layout.x_m, layout.y_m
    ax, ay = x[from_waypoint], y[from_waypoint]
    bx, by = x[to_waypoint] - ax, y[to_waypoint] - ay
    along = ((x - ax) * bx + (y - ay) * by) / (bx * bx + by * by)
    off = abs((x - ax) * by - (y - ay) * bx)
    same_tier = layout.tier == layout.tier[from_waypoint]
    found = np.flatnonzero((off < 1e-6) & (along > 1e-9) & (along <= 1 + 1e-9) & same_tier)
    return found[np.argsort(along[found])].tolist()


def entries(tasks, waypoints, start_us, end_us):
    """Robots whose runs begun in a stretch of time enter one of the waypoints from outside."""
    trace = tasks.traffic.trace()
    inside = set(waypoints)
    chosen = (trace["kind"] == Piece.RUN) & (trace["t0_us"] > start_us) & (trace["t0_us"] < end_us)
    return [
        int(trace["robot"][row])
        for row in np.flatnonzero(chosen)
        if trace["from_wp"][row] not in inside
        and inside & set(passed(tasks.layout, trace["from_wp"][row], trace["to_wp"][row]))
    ]


def proved(tasks, until_s):
    report = check(tasks.layout, tasks.traffic.trace(), until_us=round(until_s * SECOND))
    assert report.ok, report.summary()


def events_until(traffic, until_s):
    events = []
    while traffic.now_us < until_s * SECOND:
        events += traffic.advance(round(until_s * SECOND))
    return events


@pytest.fixture
def alone():
    layout = load("default", [(["robots"], 1)])
    return layout, Traffic(layout, record_trace=True)


def waypoints_planned(layout, traffic):
    return [
        w for move in traffic.plan(0) for w in passed(layout, move.from_waypoint, move.to_waypoint)
    ]


def test_another_way_is_found(alone):
    """One robot, one waypoint of its way closed: it gets there, later, around it."""
    layout, traffic = alone
    goal = int(layout.pod_waypoint[200])
    traffic.command(0, [(Step.DRIVE, goal)])
    traffic.advance(0)
    way = waypoints_planned(layout, traffic)
    arrival = traffic.plan(0)[-1].end_us
    corners = {move.to_waypoint for move in traffic.plan(0)}
    closed = next(w for w in way[5:] if not layout.is_storage[w] and w not in corners)
    assert traffic.close([closed]) == []
    assert closed not in waypoints_planned(layout, traffic)
    assert traffic.plan(0)[-1].end_us > arrival
    arrived = [event for event in events_until(traffic, 600) if event[1] == EventKind.ARRIVED]
    assert [event[3] for event in arrived] == [goal]
    assert traffic.cut_off() == ([], [])


def test_a_closed_goal_is_waited_for(alone):
    layout, traffic = alone
    goal = int(layout.pod_waypoint[200])
    assert traffic.close([goal]) == []
    traffic.command(0, [(Step.DRIVE, goal)])
    assert events_until(traffic, 100) == []
    assert traffic.blocked() == [0]
    assert traffic.cut_off().storage == [goal]
    traffic.reopen([goal])
    assert traffic.cut_off() == ([], [])
    assert [event[3] for event in events_until(traffic, 500) if event[1] == EventKind.ARRIVED] == [
        goal
    ]


def test_who_cannot_stop_drives_on(alone):
    """A waypoint of the run a robot is in the middle of is closed: the robot is named."""
    layout, traffic = alone
    traffic.command(0, [(Step.DRIVE, int(layout.pod_waypoint[200]))])
    first = traffic.plan(0)[0]
    traffic.advance(first.start_us + 1)
    assert traffic.close([first.to_waypoint]) == [0]
    assert traffic.plan(0)[0] == first


def test_unknown_waypoints_are_refused(alone):
    layout, traffic = alone
    with pytest.raises(ValueError, match="no waypoint"):
        traffic.close([0, layout.waypoints])
    assert traffic.cut_off() == ([], [])


@pytest.mark.parametrize(
    "planner", ["time-windows", "whca-v", "whca-n", "far", "bcp", "cbs", "pbs"]
)
def test_aisles_closed_at_random(planner, settings_of):
    """Every 40 s another waypoint is closed for 60 s: nobody enters it, nobody meets."""
    layout = load("default", [(["robots"], 16)])
    tasks = RandomTasks(layout, 3, planner=settings_of(planner))
    draw = random.Random(8)
    aisles = np.flatnonzero(~layout.is_storage & ~layout.is_queue).tolist()
    closings = []
    for second in range(20, 600, 40):
        tasks.run(second)
        waypoint = draw.choice(aisles)
        closings.append((waypoint, second, tasks.traffic.close([waypoint])))
        tasks.run(second + 20)
        if len(closings) > 1:
            tasks.traffic.reopen([closings[-2][0]])
    tasks.run(640)
    proved(tasks, 640)
    for waypoint, second, still in closings:
        entered = entries(tasks, [waypoint], second * SECOND, (second + 60) * SECOND)
        assert set(entered) <= set(still)
    assert len(tasks.visits) > 30


def test_an_elevator_out_of_service():
    """From 200 s on one elevator is closed: who is inside leaves, the others carry on."""
    layout = load("study-tiers", [(["robots"], 4)])
    tasks = RandomTasks(layout, 2).run(200)
    before = tasks.traffic.motion()["riding_s"].sum()
    elevator = layout.elevators[0].waypoints
    still = tasks.traffic.close(elevator)
    assert tasks.traffic.cut_off() == ([], [])
    tasks.run(700)
    proved(tasks, 700)
    assert set(entries(tasks, elevator, 200 * SECOND, 700 * SECOND)) <= set(still)
    assert not {tasks.traffic.robot_waypoint(r) for r in range(layout.robots)} & set(elevator)
    assert tasks.traffic.motion()["riding_s"].sum() > before
    late = [robot for time, robot in tasks.visits if time > 300]
    assert set(late) == set(range(layout.robots)), tasks.traffic.state_report()


def test_tiers_without_elevators_are_reported():
    layout = load("study-tiers", [(["robots"], 4)])
    traffic = Traffic(layout)
    traffic.close([w for elevator in layout.elevators for w in elevator.waypoints])
    lost = traffic.cut_off()
    home = {int(layout.tier[station.queue[0]]) for station in layout.stations}
    other = np.flatnonzero(layout.is_storage & ~np.isin(layout.tier, list(home)))
    assert lost.stations == []
    assert set(lost.storage) >= set(other.tolist())


def test_a_loaded_robot_steps_aside_to_places_without_a_pod():
    """A robot whose only way is closed waits with its pod at a free storage location."""
    layout = load("small", [(["robots"], 6)])
    tasks = RandomTasks(layout, seed=3)
    tasks.traffic.delay(3, 91_666)
    tasks.run(15)
    tasks.traffic.close([355])
    assert tasks.traffic.blocked() == [3]
    tasks.run(40)
    proved(tasks, 40)
    waits_at = tasks.traffic.robot_waypoint(3)
    others = [place for pod, place in enumerate(tasks.place) if pod != tasks.task[3][0]]
    assert layout.is_storage[waits_at] and waits_at not in others
    tasks.traffic.reopen([355])
    tasks.run(200)
    proved(tasks, 200)
    assert 3 in {robot for time, robot in tasks.visits if time > 40}


def test_pods_are_known_to_a_copy_through_bytes():
    layout = load("small", [(["robots"], 6)])
    tasks = RandomTasks(layout, seed=3)
    tasks.traffic.delay(3, 91_666)
    tasks.run(15)
    tasks.traffic = Traffic.from_bytes(layout, tasks.traffic.to_bytes())
    tasks.traffic.close([355])
    tasks.run(40)
    proved(tasks, 40)


@pytest.mark.parametrize("name", ["small", "default", "study-tiers"])
def test_what_is_cut_off_has_no_way(name):
    """Places to or from which the unhindered time of a loaded robot is infinite, and no others."""
    layout = load(name, [(["robots"], 2)])
    traffic = Traffic(layout)
    draw = random.Random(5)
    aisles = np.flatnonzero(~layout.is_storage).tolist()
    storage = np.flatnonzero(layout.is_storage)
    for count in (1, 20, layout.waypoints // 10):
        closed = draw.sample(aisles, count)
        traffic.close(closed)
        served, stations = np.ones(layout.waypoints, dtype=bool), []
        for number, station in enumerate(layout.stations):
            head = station.queue[0]
            ways = np.isfinite(traffic.travel_times_to(head, True))
            ways &= np.isfinite(traffic.travel_times_from(head, True))
            if head in closed or not ways[storage].any():
                stations.append(number)
            else:
                served &= ways
        assert traffic.cut_off() == (storage[~served[storage]].tolist(), stations)
        traffic.reopen(closed)
