import numpy as np
import pytest

from rmfs.layout import load
from rmfs.traffic import EventKind, Step, Traffic, TripKind


@pytest.fixture
def layout():
    return load("default", [(["robots"], 4)])


def events_until(traffic, until_s):
    events = []
    while traffic.now_us < until_s * 1e6:
        events += traffic.advance(round(until_s * 1e6))
    return events


def test_a_whole_task(layout):
    """Fetch, lift, deliver, come back, set down: the events in their order."""
    traffic = Traffic(layout)
    place = int(layout.pod_waypoint[7])
    traffic.command(0, [(Step.DRIVE, place), (Step.LIFT, 7), (Step.STATION, 1)])
    kinds = [EventKind(kind) for _, kind, _, _ in events_until(traffic, 400)]
    assert kinds == [
        EventKind.ARRIVED,
        EventKind.LIFT_STARTED,
        EventKind.DEPARTED,
        EventKind.LIFTED,
        EventKind.AT_HEAD,
    ]
    traffic.command(0, [(Step.DRIVE, place), (Step.SET_DOWN, 7)])
    kinds = [EventKind(kind) for _, kind, _, _ in events_until(traffic, 800)]
    assert kinds == [
        EventKind.ARRIVED,
        EventKind.SET_DOWN_STARTED,
        EventKind.SET_DOWN,
        EventKind.IDLE,
    ]


def test_kinds_of_events_can_be_left_out(layout):
    place, ignored = int(layout.pod_waypoint[7]), 1 << EventKind.LIFTED | 1 << EventKind.ARRIVED
    program = [(Step.DRIVE, place), (Step.LIFT, 7), (Step.STATION, 1)]
    everything, some = Traffic(layout), Traffic(layout)
    for traffic in (everything, some):
        traffic.command(0, program)
    expected = [one for one in events_until(everything, 400) if not ignored >> one[1] & 1]
    found = []
    while some.now_us < 400e6:
        events = some.advance(400_000_000, ignored)
        assert events or some.now_us == 400_000_000
        found += events
    assert found == expected
    assert [kind for _, kind, _, _ in found].count(EventKind.LIFT_STARTED) == 1


def test_lifting_takes_its_time(layout):
    traffic = Traffic(layout)
    place = int(layout.pod_waypoint[3])
    traffic.command(0, [(Step.DRIVE, place), (Step.LIFT, 3)])
    times = {kind: time for time, kind, _, _ in events_until(traffic, 300)}
    transfer_us = round(layout.robot_kinds[0].pod_transfer_s * 1e6)
    assert times[EventKind.LIFTED] - times[EventKind.LIFT_STARTED] == transfer_us


def test_a_robot_on_its_way_can_be_sent_elsewhere(layout):
    """It stops where it next can and turns to its new goal."""
    traffic = Traffic(layout, record_trace=True)
    first, second = layout.pod_waypoint[[10, 200]].tolist()
    traffic.command(0, [(Step.DRIVE, first)])
    traffic.advance(5_000_000)
    traffic.command(0, [(Step.DRIVE, second)])
    arrived = [
        value for _, kind, _, value in events_until(traffic, 300) if kind == EventKind.ARRIVED
    ]
    assert arrived == [second]
    assert traffic.rest_waypoint(0) == second


def test_a_held_place_is_waited_for(layout):
    """Robot 1 wants the place beneath which robot 0 rests: it goes as soon as robot 0 leaves."""
    traffic = Traffic(layout)
    place, other = layout.pod_waypoint[[10, 200]].tolist()
    traffic.command(0, [(Step.DRIVE, place)])
    events_until(traffic, 200)
    traffic.command(1, [(Step.DRIVE, place)])
    events_until(traffic, 400)
    assert traffic.blocked() == [1]
    traffic.command(0, [(Step.DRIVE, other)])
    events_until(traffic, 700)
    assert traffic.blocked() == []
    assert traffic.rest_waypoint(1) == place


def test_no_command_while_lifting(layout):
    traffic = Traffic(layout)
    place = int(layout.pod_waypoint[3])
    traffic.command(0, [(Step.DRIVE, place), (Step.LIFT, 3)])
    while not any(kind == EventKind.LIFT_STARTED for _, kind, _, _ in traffic.advance(10**9)):
        pass
    with pytest.raises(ValueError, match="robot 0 is lifting"):
        traffic.command(0, [(Step.DRIVE, place)])


@pytest.mark.parametrize(
    ("program", "message"), [([(9, 0)], "unknown step 9"), ([(0, 10**6)], "no waypoint 1000000")]
)
def test_bad_commands(layout, program, message):
    with pytest.raises(ValueError, match=message):
        Traffic(layout).command(0, program)


def test_unhindered_times_are_met_without_traffic(layout):
    """One robot alone takes exactly the unhindered time to a pod."""
    traffic = Traffic(load("default", [(["robots"], 1)]))
    for pod in (5, 100, 300):
        traffic.command(0, [(Step.DRIVE, int(layout.pod_waypoint[pod]))])
        events_until(traffic, traffic.now_us / 1e6 + 300)
    trips = traffic.trips()
    taken = (trips["t1_us"] - trips["t0_us"]) / 1e6
    np.testing.assert_allclose(taken, trips["unhindered_s"], atol=1e-4)


def test_travel_times(layout):
    """Zero at home, more for loaded robots than for empty ones, which drive beneath pods."""
    traffic = Traffic(layout)
    place = int(layout.pod_waypoint[50])
    empty, loaded = (traffic.travel_times_to(place, loaded) for loaded in (False, True))
    assert empty[place] == loaded[place] == 0
    reached = np.isfinite(loaded)
    assert (loaded[reached] >= empty[reached] - 1e-9).all()
    assert reached[layout.is_storage].all()


def test_resetting_statistics(layout):
    traffic = Traffic(layout)
    traffic.command(0, [(Step.DRIVE, int(layout.pod_waypoint[50]))])
    traffic.advance(4_000_000)
    before = traffic.motion()["distance_m"][0]
    traffic.reset_statistics()
    assert before > 0
    assert traffic.counters()["plans"] == 0
    assert traffic.motion()["idle_s"].sum() == 0


def test_a_trip_begins_when_its_robot_is_told_even_without_a_way(layout):
    """Robot 1 is told at 200 s and finds no way before 400 s: the wait is part of its trip."""
    traffic = Traffic(layout)
    place, other = layout.pod_waypoint[[10, 200]].tolist()
    traffic.command(0, [(Step.DRIVE, place)])
    events_until(traffic, 200)
    traffic.command(1, [(Step.DRIVE, place)])
    events_until(traffic, 400)
    traffic.command(0, [(Step.DRIVE, other)])
    events_until(traffic, 700)
    trips = traffic.trips()
    own = trips["robot"] == 1
    assert trips["t0_us"][own].tolist() == [200_000_000]
    assert trips["from_wp"][own].tolist() == [layout.robot_waypoint[1]]
    assert trips["t1_us"][own][0] > 400_000_000
    assert trips["distance_m"][own][0] == traffic.motion()["distance_m"][1]


def test_a_trip_to_a_full_queue_begins_with_the_lifted_pod():
    """Of four robots, the last finds no place in a queue of three and waits beneath its pod."""
    sizes = [(["robots"], 4), (["buffer_width"], 2), (["entry_exit_distance"], 1)]
    layout = load("default", sizes)
    assert len(layout.stations[0].queue) == 3
    traffic = Traffic(layout)
    lifted = {}
    for robot in range(4):
        place = int(layout.pod_waypoint[robot])
        program = [(Step.DRIVE, place), (Step.LIFT, robot), (Step.STATION, 0)]
        traffic.command(robot, program)
    for until_s in (400, 700, 1000, 1300):
        for time, kind, robot, _ in events_until(traffic, until_s):
            if kind == EventKind.LIFTED:
                lifted[robot] = time
            if kind == EventKind.AT_HEAD:
                head = robot
        traffic.command(head, [(Step.DRIVE, int(layout.pod_waypoint[head]))])
    trips = traffic.trips()
    to_station = trips["kind"] == TripKind.TO_STATION
    begun = dict(zip(trips["robot"][to_station].tolist(), trips["t0_us"][to_station], strict=True))
    assert begun == lifted
    assert (trips["t1_us"] - trips["t0_us"])[to_station].max() > 250_000_000


def test_the_distance_of_a_trip_begins_where_the_trip_begins(layout):
    """A robot sent elsewhere first drives on to its next stop: that is no part of the trip."""
    layout = load("default", [(["robots"], 1)])
    traffic = Traffic(layout)
    first, second = layout.pod_waypoint[[10, 200]].tolist()
    traffic.command(0, [(Step.DRIVE, first)])
    traffic.advance(1_000_000)
    stop = traffic.plan(0)[0].to_waypoint
    traffic.command(0, [(Step.DRIVE, second)])
    events_until(traffic, 300)
    trips = traffic.trips()
    begin = int(layout.robot_waypoint[0])
    before_m = np.hypot(layout.x_m[stop] - layout.x_m[begin], layout.y_m[stop] - layout.y_m[begin])
    assert trips["from_wp"].tolist() == [stop]
    assert before_m > 0
    driven_m = traffic.motion()["distance_m"][0]
    assert trips["distance_m"][0] == pytest.approx(driven_m - before_m)


def test_time_in_a_queue_is_kept_if_the_robot_is_sent_elsewhere(layout):
    """The second robot in a queue is told to leave: its queueing time ends, but stays counted."""
    traffic = Traffic(layout)
    for robot in (0, 1):
        place = int(layout.pod_waypoint[robot])
        program = [(Step.DRIVE, place), (Step.LIFT, robot), (Step.STATION, 0)]
        traffic.command(robot, program)
    events_until(traffic, 300)
    before = traffic.motion()["queueing_s"]
    waiting = int(np.argmax(before))
    assert before[waiting] > 100
    traffic.command(waiting, [(Step.DRIVE, int(layout.pod_waypoint[waiting]))])
    assert traffic.motion()["queueing_s"].tolist() == before.tolist()
    events_until(traffic, 310)
    assert traffic.motion()["queueing_s"].tolist() == before.tolist()


def test_a_robot_asks_for_its_plan_when_it_begins_to_lift(layout):
    """Also if the planner begins in the very moment at which the pod is lifted."""
    place = int(layout.pod_waypoint[7])
    program = [(Step.DRIVE, place), (Step.LIFT, 7), (Step.STATION, 1)]
    plain = Traffic(layout)
    plain.command(0, program)
    times = {kind: time for time, kind, _, _ in events_until(plain, 400)}
    traffic = Traffic(layout)
    traffic.set_pace("fixed", period_us=times[EventKind.LIFTED])
    traffic.command(0, program)
    events_until(traffic, 400)
    plans = traffic.plans()
    assert plans["begun_us"].tolist() == [0, times[EventKind.LIFTED]]
    assert plans["asked_us"].tolist() == [0, times[EventKind.LIFT_STARTED]]
