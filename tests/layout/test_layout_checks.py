"""Who stands where, and what is done with layouts that are broken."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from broken_layouts import (
    IMPOSSIBLE,
    NOT_WELL_FORMED,
    assert_found,
    moved,
    pick,
    placed,
    places,
    road,
    small,
    two_tiers,
    without,
)
from layout_reference import INSTANCES, needs_reference

from rmfs.errors import LayoutError
from rmfs.layout import check, load, refuse
from rmfs.layout.model import Elevator


def test_sound_layouts_have_no_violations():
    assert check(small()) == []
    assert check(two_tiers()) == []
    refuse(small(), "small")


def test_more_pods_than_places():
    layout = small()
    many = np.resize(places(layout), layout.is_storage.sum() + 1).astype(np.int32)
    broken = replace(layout, pod_waypoint=many, pod_capacity=np.ones(len(many)))
    assert_found(broken, IMPOSSIBLE, "pods", "37 pods, but only 36 storage locations")


def test_pod_outside_storage():
    layout = small()
    broken = replace(layout, pod_waypoint=placed(layout.pod_waypoint, 3, road(layout)[0]))
    assert_found(broken, IMPOSSIBLE, "pod 3", "does not stand at a storage location")


def test_two_pods_at_one_place():
    layout = small()
    broken = replace(layout, pod_waypoint=placed(layout.pod_waypoint, 3, layout.pod_waypoint[5]))
    where = f"storage location {layout.pod_waypoint[5]} "
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
    assert_found(broken, NOT_WELL_FORMED, "robots", "only 36 storage locations to rest at (W2")


def test_station_at_a_storage_place():
    layout = small()
    broken = pick(layout, waypoint=int(places(layout)[0]))
    assert_found(broken, NOT_WELL_FORMED, "pick station 0", "stands at a storage location")


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
    assert "31 more elements" in [v.element for v in violations]


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
@pytest.mark.benchmark
def test_checking_a_large_layout(benchmark):
    layout = load(INSTANCES / "pp/3-12-12-96-1650.xinst")
    assert benchmark(check, layout) == []
