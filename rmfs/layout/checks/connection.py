"""Whether robots, empty and loaded, can get where their tasks will send them.

A loaded robot uses storage places only at the two ends of its way; an empty one may pass beneath
stored pods.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.layout.checks.reach import Reach, entered_from, leading_to
from rmfs.layout.checks.violation import (
    IMPOSSIBLE,
    Violation,
    at,
    grouped,
    station_label,
    waypoint_label,
)
from rmfs.layout.graph import edge_sources

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.layout.checks.reach import Mask
    from rmfs.layout.model import Layout

TO_IT, FROM_IT = "no way leads to it", "no way leads away from it"


def connection(layout: Layout) -> Iterator[Violation]:
    """Yield endpoints that cannot be reached or left."""
    lost = np.zeros(layout.waypoints, dtype=np.bool_)
    yield from _empty(layout, lost)
    yield from _loaded(layout, lost)


def _empty(layout: Layout, lost: Mask) -> Iterator[Violation]:
    """Compare every endpoint with the largest connected part; mark in `lost` what is outside."""
    reach = Reach(layout, np.ones(layout.waypoints, dtype=np.bool_))
    endpoints = layout.is_storage.copy()
    endpoints[[station.waypoint for station in layout.stations]] = True
    core = reach.largest(endpoints)
    reached, leaves = reach.forward(core), reach.backward(core)
    lost |= ~(reached & leaves)
    for fine, message in ((reached, TO_IT), (leaves, FROM_IT)):
        places = np.flatnonzero(layout.is_storage & ~fine)
        labels = [waypoint_label(layout, int(v)) for v in places]
        for number, station in enumerate(layout.stations):
            if not fine[station.waypoint]:
                labels.append(station_label(layout, number))
        for number, elevator in enumerate(layout.elevators):
            for waypoint in elevator.waypoints:
                if not fine[waypoint]:
                    labels.append(f"elevator {number} ({at(layout, waypoint)})")
        yield from grouped(IMPOSSIBLE, labels, message)
    stuck = np.flatnonzero(~leaves[layout.robot_waypoint])
    robots = [f"robot {r} ({at(layout, layout.robot_waypoint[r])})" for r in stuck]
    yield from grouped(IMPOSSIBLE, robots, "cannot reach the stations and storage places")


def _loaded(layout: Layout, lost: Mask) -> Iterator[Violation]:
    """Check the ways of pods: from every storage place to every station and back."""
    tails = edge_sources(layout)
    reach = Reach(layout, ~layout.is_storage)
    components = reach.components()
    places = layout.is_storage & ~lost
    to_station: dict[int, Mask] = {}
    from_station: dict[int, Mask] = {}
    for number, station in enumerate(layout.stations):
        head = station.waypoint
        if lost[head] or layout.is_storage[head]:
            continue
        same = int(components[head])
        if same not in to_station:
            only = np.zeros_like(lost)
            only[head] = True
            to_station[same] = leading_to(layout, tails, reach.backward(only))
            from_station[same] = entered_from(layout, tails, reach.forward(only))
        label = station_label(layout, number)
        yield from _pod_ways(
            layout, places, to_station[same], label, f"a loaded robot cannot reach {label} from it"
        )
        yield from _pod_ways(
            layout,
            places,
            from_station[same],
            label,
            f"a loaded robot from {label} cannot reach it",
        )
    yield from _lifts(layout, reach, lost)


def _pod_ways(
    layout: Layout, places: Mask, fine: Mask, station: str, message: str
) -> Iterator[Violation]:
    """Yield the storage places without a way, or the station if that is all of them."""
    bad = places & ~fine
    if places.any() and bad.sum() == places.sum():
        yield Violation(
            IMPOSSIBLE, station, "no pod can be carried between it and any storage place"
        )
        return
    labels = (waypoint_label(layout, int(v)) for v in np.flatnonzero(bad))
    yield from grouped(IMPOSSIBLE, labels, message)


def _lifts(layout: Layout, reach: Reach, lost: Mask) -> Iterator[Violation]:
    """Check that loaded robots can board and leave every elevator."""
    if not layout.elevators:
        return
    tails = edge_sources(layout)
    from_pods = reach.forward(entered_from(layout, tails, layout.is_storage))
    to_pods = reach.backward(leading_to(layout, tails, layout.is_storage))
    for number, elevator in enumerate(layout.elevators):
        for waypoint in elevator.waypoints:
            label = f"elevator {number} ({at(layout, waypoint)})"
            if lost[waypoint]:
                continue
            if not from_pods[waypoint]:
                yield Violation(IMPOSSIBLE, label, "no loaded robot can reach it")
            if not to_pods[waypoint]:
                yield Violation(IMPOSSIBLE, label, "no loaded robot can leave it")
