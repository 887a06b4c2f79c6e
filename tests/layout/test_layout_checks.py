"""Every kind of violation, each in a layout broken by hand."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
import pytest
from layout_reference import INSTANCES, needs_reference

from rmfs.errors import LayoutError
from rmfs.layout import LayoutParameters, check, generate, load, refuse
from rmfs.layout.graph import compressed, edge_sources
from rmfs.layout.model import Elevator

IMPOSSIBLE, NOT_WELL_FORMED = "impossible", "not well-formed"


def small(**more):
    return generate(
        LayoutParameters(
            **{
                "horizontal_aisles": 2,
                "vertical_aisles": 2,
                "block_length": 2,
                "hall_width": 2,
                "buffer_width": 2,
                "robots": 4,
                "pick_stations": {"east": 1},
                "replenishment_stations": {"west": 1},
                **more,
            }
        )
    )


def two_tiers():
    return small(tiers=2, elevators={"north": 1})


def edges(layout):
    return list(zip(edge_sources(layout).tolist(), layout.edge_target.tolist(), strict=True))


def with_edges(layout, changed):
    start, target = compressed(layout.waypoints, changed)
    return replace(layout, edge_start=start, edge_target=target)


def without(layout, unwanted):
    """Remove the edges (tail, head) for which `unwanted` is true."""
    return with_edges(layout, [edge for edge in edges(layout) if not unwanted(*edge)])


def moved(layout, waypoint, x_m, y_m):
    x, y = layout.x_m.copy(), layout.y_m.copy()
    x[waypoint], y[waypoint] = x_m, y_m
    return replace(layout, x_m=x, y_m=y)


def placed(values, index, value):
    copy = values.copy()
    copy[index] = value
    return copy


def marked(mask, *waypoints):
    copy = mask.copy()
    copy[list(waypoints)] = True
    return copy


def pick(layout, **changes):
    """Change the first pick station."""
    first, *others = layout.pick_stations
    return replace(layout, pick_stations=(replace(first, **changes), *others))


def road(layout):
    return np.flatnonzero(~layout.is_storage & ~layout.is_queue)


def places(layout):
    return np.flatnonzero(layout.is_storage)


def assert_found(layout, severity, element, message):
    found = [
        v
        for v in check(layout)
        if v.severity == severity and element in v.element and message in v.message
    ]
    assert found, [str(v) for v in check(layout)]


def inner_place(layout):
    """Return a storage place and the storage places and road waypoints next to it."""
    place = int(places(layout)[0])
    around = {b for a, b in edges(layout) if a == place}
    return place, {v for v in around if layout.is_storage[v]}, around


def test_sound_layouts_have_no_violations():
    assert check(small()) == []
    assert check(two_tiers()) == []
    refuse(small(), "small")


# --- who stands where ----------------------------------------------------------------------------


def test_more_pods_than_places():
    layout = small()
    many = np.resize(places(layout), layout.is_storage.sum() + 1).astype(np.int32)
    broken = replace(layout, pod_waypoint=many, pod_capacity=np.ones(len(many)))
    assert_found(broken, IMPOSSIBLE, "pods", "37 pods, but only 36 storage places")


def test_pod_outside_storage():
    layout = small()
    broken = replace(layout, pod_waypoint=placed(layout.pod_waypoint, 3, road(layout)[0]))
    assert_found(broken, IMPOSSIBLE, "pod 3", "does not stand at a storage place")


def test_two_pods_at_one_place():
    layout = small()
    broken = replace(layout, pod_waypoint=placed(layout.pod_waypoint, 3, layout.pod_waypoint[5]))
    where = f"storage place {layout.pod_waypoint[5]} "
    assert_found(broken, IMPOSSIBLE, where, "2 pods stand here at the start (pods 3, 5)")


def test_two_robots_at_one_waypoint():
    layout = small()
    broken = replace(
        layout, robot_waypoint=placed(layout.robot_waypoint, 0, layout.robot_waypoint[1])
    )
    assert_found(broken, IMPOSSIBLE, f"waypoint {layout.robot_waypoint[1]}", "robots 0, 1")


def test_more_robots_than_resting_places():
    layout = small()
    many = road(layout)[:37].astype(np.int32)
    broken = replace(
        layout,
        robot_waypoint=many,
        robot_heading_rad=np.zeros(37),
        robot_kind=np.zeros(37, dtype=np.int16),
    )
    assert_found(broken, NOT_WELL_FORMED, "robots", "only 36 storage places to rest at (W2")


def test_station_at_a_storage_place():
    layout = small()
    broken = pick(layout, waypoint=int(places(layout)[0]))
    assert_found(broken, NOT_WELL_FORMED, "pick station 0", "stands at a storage place")


def test_two_stations_at_one_waypoint():
    layout = small()
    taken = layout.pick_stations[0].waypoint
    first = replace(layout.replenishment_stations[0], waypoint=taken)
    broken = replace(layout, replenishment_stations=(first,))
    assert_found(broken, IMPOSSIBLE, "replenishment station 0", "waypoint of pick station 0")


def test_station_in_an_elevator():
    layout = two_tiers()
    broken = pick(layout, waypoint=layout.elevators[0].waypoints[0])
    assert_found(broken, IMPOSSIBLE, "pick station 0", "stands in elevator 0")


def test_waypoint_outside_its_tier():
    broken = moved(small(), 5, 1000.0, 1000.0)
    assert_found(broken, NOT_WELL_FORMED, "5 (x 1000 m", "lies outside its tier")


def test_elevator_with_two_stops_on_a_tier():
    layout = two_tiers()
    first = layout.elevators[0]
    again = (first.waypoints[0], first.queues[first.waypoints[0]][1])
    broken = replace(
        layout,
        elevators=(Elevator(again, {again: 10.0, again[::-1]: 10.0}, {v: (v,) for v in again}),),
    )
    assert_found(broken, IMPOSSIBLE, "elevator 0", "boards twice on the same tier")


# --- reaching and leaving ------------------------------------------------------------------------


def test_storage_place_nobody_reaches():
    layout = small()
    place, _, _ = inner_place(layout)
    broken = without(layout, lambda _, head: head == place)
    assert_found(broken, IMPOSSIBLE, f"storage place {place} ", "no way leads to it")


def test_storage_place_nobody_leaves():
    layout = small()
    place, _, _ = inner_place(layout)
    broken = without(layout, lambda tail, _: tail == place)
    assert_found(broken, IMPOSSIBLE, f"storage place {place} ", "no way leads away from it")


def test_station_nobody_reaches():
    layout = small()
    station = layout.pick_stations[0].waypoint
    broken = without(layout, lambda _, head: head == station)
    assert_found(broken, IMPOSSIBLE, "pick station 0", "no way leads to it")


def test_station_nobody_leaves():
    layout = small()
    station = layout.replenishment_stations[0].waypoint
    broken = without(layout, lambda tail, _: tail == station)
    assert_found(broken, IMPOSSIBLE, "replenishment station 0", "no way leads away from it")


def test_elevator_nobody_reaches():
    layout = two_tiers()
    shaft = layout.elevators[0].waypoints
    broken = without(layout, lambda _, head: head == shaft[0])
    lonely = replace(broken.elevators[0], travel_s={(shaft[0], shaft[1]): 10.0})
    broken = replace(broken, elevators=(lonely,))
    assert_found(broken, IMPOSSIBLE, "elevator 0", "no way leads to it")


def test_tiers_without_rides():
    layout = two_tiers()
    broken = replace(layout, elevators=(replace(layout.elevators[0], travel_s={}),))
    assert_found(broken, IMPOSSIBLE, "tier 1", "no way leads to it")


def test_robot_that_cannot_reach_anything():
    layout = small()
    prison = int(layout.robot_waypoint[2])
    broken = without(layout, lambda tail, _: tail == prison)
    assert_found(broken, IMPOSSIBLE, "robot 2", "cannot reach the stations and storage places")


def test_place_reached_beneath_pods_only():
    """An empty robot gets there, a loaded one does not."""
    layout = small()
    place, inner, _ = inner_place(layout)
    broken = without(layout, lambda tail, head: head == place and tail not in inner)
    assert_found(broken, IMPOSSIBLE, f"storage place {place} ", "cannot leave pick station 0")
    broken = without(layout, lambda tail, head: tail == place and head not in inner)
    assert_found(broken, IMPOSSIBLE, f"storage place {place} ", "cannot reach pick station 0")


def test_station_behind_storage_is_out_of_reach_for_pods():
    layout = small()
    wall = layout.pick_stations[0].queue[2]
    broken = replace(layout, is_storage=marked(layout.is_storage, wall))
    # close the short ways past the wall
    queue = layout.pick_stations[0].queue
    broken = without(broken, lambda tail, head: head in queue[:2] and tail not in queue[:3])
    assert_found(broken, IMPOSSIBLE, "pick station 0", "reach it from only 1 of 37")


# --- bodies --------------------------------------------------------------------------------------


def test_waypoints_too_near():
    layout = small()
    a, b = road(layout)[:2]
    broken = moved(layout, a, layout.x_m[b], layout.y_m[b] + 0.1)
    assert_found(broken, IMPOSSIBLE, f"waypoint {a} ", "0.1 m apart at the nearest")


def test_waypoints_at_one_place():
    layout = small()
    a, b, c = road(layout)[:3]
    broken = moved(layout, a, layout.x_m[c], layout.y_m[c])
    broken = moved(broken, b, layout.x_m[c], layout.y_m[c])
    assert_found(broken, IMPOSSIBLE, f"waypoint {a} ", "0 m apart at the nearest")


def test_pods_wider_than_the_grid():
    layout = replace(small(), pod_radius_m=0.51)
    assert_found(layout, IMPOSSIBLE, "waypoint", "less than the two radii that pass there (1.02 m)")


def test_empty_warehouse_needs_room_for_robots_only():
    layout = replace(
        small(),
        pod_radius_m=0.6,
        pod_waypoint=np.array([], dtype=np.int32),
        pod_capacity=np.array([]),
    )
    assert check(layout) == []


def test_crossing_edges():
    layout = small()
    a = int(road(layout)[0])
    at = {(x, y): v for v, (x, y) in enumerate(zip(layout.x_m, layout.y_m, strict=True))}
    x, y = layout.x_m[a], layout.y_m[a]
    corner, below = at[x + 1, y + 1], at[x, y + 1]
    broken = with_edges(layout, [*edges(layout), (a, corner), (below, at[x + 1, y])])
    assert_found(broken, IMPOSSIBLE, f"edges {a}-{corner} and", "0 m apart at the nearest")


def test_edge_past_a_waypoint():
    layout = small()
    a = int(road(layout)[0])
    at = {(x, y): v for v, (x, y) in enumerate(zip(layout.x_m, layout.y_m, strict=True))}
    x, y = layout.x_m[a], layout.y_m[a]
    far = at[x + 2, y]
    broken = with_edges(layout, [*edges(layout), (a, far)])
    assert_found(broken, IMPOSSIBLE, f"waypoint {at[x + 1, y]} ", "0 m apart at the nearest")


def test_one_long_edge_is_compared_with_all_others():
    layout = small()
    first, last = 0, layout.waypoints - 1
    broken = with_edges(layout, [*edges(layout), (first, last)])
    assert_found(broken, IMPOSSIBLE, f"edge {first}-{last}", "apart at the nearest")


def test_tiers_do_not_touch_each_other():
    layout = two_tiers()
    assert not [v for v in check(layout) if "apart" in v.message]


# --- queues (W3) ---------------------------------------------------------------------------------


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


# --- ways (W1) -----------------------------------------------------------------------------------


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
    assert_found(broken, NOT_WELL_FORMED, f"storage place {place} ", "no aisle leads to it")
    broken = without(layout, lambda tail, head: tail == place and head not in inner)
    assert_found(broken, NOT_WELL_FORMED, f"storage place {place} ", "leads to no aisle")


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


# --- refusing ------------------------------------------------------------------------------------


def test_not_well_formed_layouts_are_refused_unless_allowed():
    layout = small()
    entrance = layout.pick_stations[0].queue[-1]
    broken = without(layout, lambda _, head: head == entrance)
    with pytest.raises(LayoutError, match=r"small: not well-formed: pick station 0 .*W1") as error:
        refuse(broken, "small")
    assert error.value.problems
    refuse(broken, "small", allow_not_well_formed=True)


def test_impossible_layouts_are_always_refused():
    layout = small()
    broken = without(layout, lambda _, head: head == layout.pick_stations[0].waypoint)
    with pytest.raises(LayoutError, match="impossible: pick station 0"):
        refuse(broken, "small", allow_not_well_formed=True)


def test_impossible_comes_first_and_many_alike_are_counted():
    layout = small()
    broken = without(layout, lambda _, head: bool(layout.is_storage[head]))
    violations = check(broken)
    severities = [v.severity for v in violations]
    assert severities == sorted(severities)
    assert "31 further elements" in [v.element for v in violations]


# --- the reference's instances -------------------------------------------------------------------


@needs_reference
@pytest.mark.parametrize(
    "name",
    [
        "core/1-3-3-15-64.xinst",
        "core/jenkinsinstance1.xinst",
        "demonstrator/fair-2016-4bot.xinst",
        "demonstrator/office-4bot.xinst",
        "pp/1-4-4-32-550.xinst",
        "pp/1-12-20-128-1965.xinst",
        "pp/3-12-12-96-1650.xinst",
    ],
)
def test_shipped_instances_are_well_formed(name):
    assert check(load(INSTANCES / name)) == []


@needs_reference
def test_desk_is_not_well_formed():
    messages = [str(v) for v in check(load(INSTANCES / "demonstrator/desk.xinst"))]
    assert all(message.startswith(NOT_WELL_FORMED) for message in messages)
    assert any("pick station 0" in message for message in messages)


@needs_reference
def test_two_directional_reference_layout_has_a_closed_entrance():
    found = check(load(INSTANCES / "generated/d-two-directional.xinst"))
    assert [v.severity for v in found] == [NOT_WELL_FORMED]
    assert "no aisle leads to the entrance of its queue" in found[0].message


@needs_reference
def test_check_of_a_large_layout_takes_well_under_a_second():
    layout = load(INSTANCES / "pp/3-12-12-96-1650.xinst")
    start = time.perf_counter()
    check(layout)
    assert time.perf_counter() - start < 1.0
