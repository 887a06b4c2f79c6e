"""Reaching and leaving places, and ways without end (W1), each in a layout broken by hand."""

from __future__ import annotations

from dataclasses import replace

from broken_layouts import (
    IMPOSSIBLE,
    NOT_WELL_FORMED,
    assert_found,
    edges,
    inner_place,
    marked,
    road,
    small,
    two_tiers,
    with_edges,
    without,
)

from rmfs.layout import check


def test_storage_place_nobody_reaches():
    layout = small()
    place, _, _ = inner_place(layout)
    broken = without(layout, lambda _, head: head == place)
    assert_found(broken, IMPOSSIBLE, f"storage location {place} ", "no path leads to it")


def test_storage_place_nobody_leaves():
    layout = small()
    place, _, _ = inner_place(layout)
    broken = without(layout, lambda tail, _: tail == place)
    assert_found(broken, IMPOSSIBLE, f"storage location {place} ", "no path leads away from it")


def test_station_nobody_reaches():
    layout = small()
    station = layout.pick_stations[0].waypoint
    broken = without(layout, lambda _, head: head == station)
    assert_found(broken, IMPOSSIBLE, "pick station 0", "no path leads to it")


def test_station_nobody_leaves():
    layout = small()
    station = layout.replenishment_stations[0].waypoint
    broken = without(layout, lambda tail, _: tail == station)
    assert_found(broken, IMPOSSIBLE, "replenishment station 0", "no path leads away from it")


def test_elevator_nobody_reaches():
    layout = two_tiers()
    shaft = layout.elevators[0].waypoints
    broken = without(layout, lambda _, head: head == shaft[0])
    lonely = replace(broken.elevators[0], travel_s={(shaft[0], shaft[1]): 10.0})
    broken = replace(broken, elevators=(lonely,))
    assert_found(broken, IMPOSSIBLE, "elevator 0", "no path leads to it")


def test_tiers_without_rides():
    layout = two_tiers()
    broken = replace(layout, elevators=(replace(layout.elevators[0], travel_s={}),))
    assert_found(broken, IMPOSSIBLE, "tier 1", "no path leads to it")


def test_robot_that_cannot_reach_anything():
    layout = small()
    prison = int(layout.robot_waypoint[2])
    broken = without(layout, lambda tail, _: tail == prison)
    assert_found(broken, IMPOSSIBLE, "robot 2", "cannot reach the stations and storage locations")


def test_place_reached_beneath_pods_only():
    """An empty robot gets there, a loaded one does not."""
    layout = small()
    place, inner, _ = inner_place(layout)
    broken = without(layout, lambda tail, head: head == place and tail not in inner)
    assert_found(broken, IMPOSSIBLE, f"storage location {place} ", "cannot leave pick station 0")
    broken = without(layout, lambda tail, head: tail == place and head not in inner)
    assert_found(broken, IMPOSSIBLE, f"storage location {place} ", "cannot reach pick station 0")


def test_station_behind_storage_is_out_of_reach_for_pods():
    layout = small()
    wall = layout.pick_stations[0].queue[2]
    broken = replace(layout, is_storage=marked(layout.is_storage, wall))
    # close the short ways past the wall
    queue = layout.pick_stations[0].queue
    broken = without(broken, lambda tail, head: head in queue[:2] and tail not in queue[:3])
    assert_found(broken, IMPOSSIBLE, "pick station 0", "reach it from only 1 of 37")


def test_aisle_without_way_out():
    layout = small()
    free = [v for v in road(layout) if v not in layout.robot_waypoint]
    trap = int(free[0])
    broken = without(layout, lambda tail, _: tail == trap)
    assert_found(broken, NOT_WELL_FORMED, f"waypoint {trap} ", "not strongly connected")


def test_aisle_without_way_in():
    layout = small()
    lonely = int(road(layout)[0])
    broken = without(layout, lambda _, head: head == lonely)
    assert_found(broken, NOT_WELL_FORMED, f"waypoint {lonely} ", "not strongly connected")


def test_place_behind_another_place():
    layout = small()
    place, inner, _ = inner_place(layout)
    broken = without(layout, lambda tail, head: head == place and tail not in inner)
    assert_found(
        broken, NOT_WELL_FORMED, f"storage location {place} ", "cannot be reached from the aisles"
    )
    broken = without(layout, lambda tail, head: tail == place and head not in inner)
    assert_found(
        broken,
        NOT_WELL_FORMED,
        f"storage location {place} ",
        "the aisles cannot be reached from it",
    )


def test_queue_with_a_closed_entrance():
    layout = small()
    entrance = layout.pick_stations[0].queue[-1]
    broken = without(layout, lambda _, head: head == entrance)
    assert_found(broken, NOT_WELL_FORMED, "pick station 0", "no aisle leads to the entrance")


def test_head_that_leaves_through_its_own_queue():
    layout = small()
    queue = layout.pick_stations[0].queue
    broken = without(layout, lambda tail, _: tail == queue[0])
    broken = with_edges(broken, [*edges(broken), (queue[0], queue[1])])
    assert_found(broken, NOT_WELL_FORMED, "pick station 0", "without passing its own queue")


def test_a_charger_nobody_reaches():
    layout = small(other_stations={"charger": {"kind": "charger", "north": 1}})
    assert check(layout) == []
    charger = layout.other_stations[0]
    own = {charger.waypoint, *charger.queue}
    broken = without(layout, lambda tail, head: head in own and tail not in own)
    assert_found(broken, IMPOSSIBLE, "charger station 0", "no path leads to it")
