"""Queues (W3), each in a layout broken by hand."""

from __future__ import annotations

from dataclasses import replace

from broken_layouts import NOT_WELL_FORMED, assert_found, marked, pick, placed, small

from rmfs.layout import check


def test_queue_that_does_not_begin_at_the_station():
    layout = small()
    queue = layout.pick_stations[0].queue
    broken = pick(layout, queue=queue[1:])
    assert_found(broken, NOT_WELL_FORMED, "pick station 0", "its queue begins at queue place")


def test_queue_with_a_place_twice():
    layout = small()
    queue = layout.pick_stations[0].queue
    broken = pick(layout, queue=(*queue, queue[3]))
    assert_found(broken, NOT_WELL_FORMED, "pick station 0", f"lists queue place {queue[3]} ")


def test_queue_with_a_gap():
    layout = small()
    queue = layout.pick_stations[0].queue
    broken = pick(layout, queue=(*queue[:2], *queue[3:]))
    assert_found(
        broken, NOT_WELL_FORMED, "pick station 0", f"queue place 2 (waypoint {queue[3]}) does not"
    )


def test_queue_through_a_storage_place():
    layout = small()
    place = layout.pick_stations[0].queue[-1]
    broken = replace(layout, is_storage=marked(layout.is_storage, place))
    assert_found(broken, NOT_WELL_FORMED, "pick station 0", "is part of its queue (W1)")


def test_queue_shared_by_two_stations():
    layout = small()
    shared = layout.replenishment_stations[0].queue[-1]
    broken = pick(layout, queue=(*layout.pick_stations[0].queue, shared))
    assert_found(broken, NOT_WELL_FORMED, "replenishment station 0", "shares queue place")


def test_queue_of_one_place_is_enough_for_one_robot_only():
    layout = small()
    station = layout.pick_stations[0]
    alone = pick(layout, queue=(station.waypoint,))
    alone = replace(alone, is_queue=placed(layout.is_queue, list(station.queue[1:]), False))
    assert_found(alone, NOT_WELL_FORMED, "pick station 0", "its queue is too short")
    one_robot = replace(
        alone,
        robot_waypoint=alone.robot_waypoint[:1],
        robot_heading_rad=alone.robot_heading_rad[:1],
        robot_kind=alone.robot_kind[:1],
    )
    assert check(one_robot) == []
