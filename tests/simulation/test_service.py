"""Times at the stations, worked out by hand.

Robot 0 starts at (0, 2); pod x stands at (x, 0); pick station 0 is at (0, 10), replenishment
station 1 at (5, 10). 1 m/s by Manhattan distance; lifting and setting down take 2 s each.
"""

from __future__ import annotations

from hand_made import HandMade


def test_units_follow_every_10_s_and_the_robot_leaves_3_s_after_the_last() -> None:
    """Robot to pod 0: 2 s, lift until 4 s, 10 m to the station: 14 s. Picks at 14, 24, 34.

    The station is done with them at 24, 34, 44; the robot leaves at 37. An order is complete when
    the station is done with its last unit: order 0 (one unit) at 24, order 1 (two units) at 44.
    """
    made = HandMade({"robots": 1})
    made.stock(0, s0=3)
    made.order(s0=1)
    made.order(s0=2)
    diary = made.run()
    assert diary.of("arrive", "unit", "complete", "leave") == [
        (14.0, "arrive", 0, 0),
        (14.0, "unit", 0, 0, False),
        (24.0, "complete", 0),
        (24.0, "unit", 1, 0, False),
        (34.0, "unit", 1, 0, False),
        (37.0, "leave", 0, 0),
        (44.0, "complete", 1),
    ]
    assert [(start, end) for start, _, _, end in diary.of("busy")] == [(14, 24), (24, 34), (34, 44)]


def test_the_change_of_pods_is_hidden_while_the_station_is_busy() -> None:
    """Robot 0 brings pod 0 (14 s); robot 1, at (1, 2), pod 1: 2 + 2 + 11 = 15 s, and queues.

    Robot 0 leaves at 17 s, robot 1 moves up in 4 s: 21 s. Its pick starts when the station is
    done with the first, at 24 s. With 8 s to move up it starts at 25 s.
    """
    for move_up_s, expected in [(4.0, 24.0), (8.0, 25.0)]:
        made = HandMade({"robots": 2}, move_up_s=move_up_s, ta={"replenishment_weight": 0})
        made.stock(0, s0=1)
        made.stock(1, s1=1)
        made.order(s0=1)
        made.order(s1=1)
        diary = made.run()
        assert [entry[0] for entry in diary.of("unit")] == [14.0, expected]


def test_a_robot_that_is_held_longer_than_the_station_sets_the_pace() -> None:
    """12 s per unit for the robot, 10 s for the station."""
    made = HandMade({"robots": 1, "unit_pick_s": 12.0})
    made.stock(0, s0=2)
    made.order(s0=2)
    diary = made.run()
    assert [entry[0] for entry in diary.of("unit", "leave", "complete")] == [14.0, 26.0, 36.0, 38.0]


def test_a_pod_goes_on_at_the_station_if_a_new_order_wants_it() -> None:
    """Last pick at 14 s; order 1 comes at 16 s, when no request is left to which it could be added.

    At 17 s the robot asks, goes on with the same pod, and picks when the station is done: 24 s.
    """
    made = HandMade({"robots": 1})
    made.stock(0, s0=2)
    made.order(s0=1)
    made.order(at_s=16.0, s0=1)
    diary = made.run()
    assert diary.of("unit", "pick", "leave") == [
        (0.0, "pick", 0, 0),
        (14.0, "unit", 0, 0, False),
        (17.0, "pick", 0, 0),
        (24.0, "unit", 1, 0, False),
        (27.0, "leave", 0, 0),
    ]


def test_a_bundle_keeps_station_and_robot() -> None:
    """Robot 0 to pod 0: 2 s, lift: 4 s, to (5, 10): 15 m, 19 s. Two bundles of 10 s: until 39 s."""
    made = HandMade({"robots": 1}, rps={"buffer_threshold": 0.0}, ta={"pick_weight": 0})
    made.bundle()
    made.bundle()
    diary = made.run()
    assert diary.of("arrive", "store", "leave") == [
        (19.0, "arrive", 1, 0),
        (19.0, "store", 0),
        (29.0, "store", 1),
        (39.0, "leave", 1, 0),
    ]


def test_the_pod_is_parked_and_the_robot_rests() -> None:
    """Robot leaves at 17 s for the nearest empty place, (0, 0), 10 m: 27 s, set down at 29 s.

    The place was left at 4 s, when the robot set off with its pod.
    """
    made = HandMade({"robots": 1})
    made.stock(0, s0=1)
    made.order(s0=1)
    diary = made.run()
    assert diary.of("park", "set down", "rest")[1:] == [
        (17.0, "park", 0, -1),
        (29.0, "set down", 0, 0),
        (29.0, "rest", 0, -1),
    ]
