"""Checks that robots, empty and loaded, can reach the places of their tasks.

A loaded robot uses storage locations only at the two ends of its path; an empty one may pass
beneath stored pods.
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

TO_IT, FROM_IT = "no path leads to it", "no path leads away from it"


def connection(layout: Layout) -> Iterator[Violation]:
    """Yield violations: stuck robots, and places of tasks that cannot be reached or left.

    Places of tasks are storage locations, stations and elevators.
    """
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
        for labels in _outside(layout, fine):
            yield from grouped(IMPOSSIBLE, labels, message)
    stuck = np.flatnonzero(~leaves[layout.robot_waypoint])
    robots = [f"robot {r} ({at(layout, layout.robot_waypoint[r])})" for r in stuck]
    yield from grouped(IMPOSSIBLE, robots, "cannot reach the stations and storage locations")


def _outside(layout: Layout, fine: Mask) -> Iterator[list[str]]:
    """Yield the names of the storage locations, stations and elevators that are not fine."""
    yield [waypoint_label(layout, int(v)) for v in np.flatnonzero(layout.is_storage & ~fine)]
    yield [
        station_label(layout, number)
        for number, station in enumerate(layout.stations)
        if not fine[station.waypoint]
    ]
    yield [
        f"elevator {number} ({at(layout, waypoint)})"
        for number, elevator in enumerate(layout.elevators)
        for waypoint in elevator.waypoints
        if not fine[waypoint]
    ]


def _loaded(layout: Layout, lost: Mask) -> Iterator[Violation]:
    """Check the paths of pods: from every storage location to every station and back.

    Elevators need no separate check: where an empty robot reaches one, a loaded robot reaches it
    from the last storage location on that path, and pods that must ride are checked here.
    """
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
        yield from _pod_ways(layout, places & ~to_station[same], places, label, ("reach", "from"))
        yield from _pod_ways(layout, places & ~from_station[same], places, label, ("leave", "to"))


def _pod_ways(
    layout: Layout, bad: Mask, places: Mask, station: str, words: tuple[str, str]
) -> Iterator[Violation]:
    """Yield the storage locations in `bad`, or only the station if these are more than half."""
    verb, preposition = words
    if 2 * bad.sum() > places.sum():
        message = (
            f"a loaded robot can {verb} it {preposition} only {places.sum() - bad.sum()} of "
            f"{places.sum()} storage locations"
        )
        yield Violation(IMPOSSIBLE, station, message)
        return
    labels = (waypoint_label(layout, int(v)) for v in np.flatnonzero(bad))
    message = f"a loaded robot cannot {verb} {station} {preposition} it"
    yield from grouped(IMPOSSIBLE, labels, message)
