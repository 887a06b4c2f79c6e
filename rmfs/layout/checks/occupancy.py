"""Checks the positions of elements, and that there are enough storage locations.

The positions of pods and robots are those at the start of a run. Neither pods nor robots may
outnumber the storage locations.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.layout.checks.violation import (
    IMPOSSIBLE,
    NOT_WELL_FORMED,
    Violation,
    at,
    grouped,
    station_label,
    waypoint_label,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from rmfs.layout.model import Layout


def occupancy(layout: Layout) -> Iterator[Violation]:
    """Yield violations: elements in wrong positions, and too many pods or robots."""
    yield from _pods(layout)
    yield from _robots(layout)
    yield from _stations(layout)
    yield from _tiers(layout)


def _pods(layout: Layout) -> Iterator[Violation]:
    places = int(layout.is_storage.sum())
    if layout.pods > places:
        message = f"{layout.pods} pods, but only {places} storage locations"
        yield Violation(IMPOSSIBLE, "pods", message)
    outside = np.flatnonzero(~layout.is_storage[layout.pod_waypoint])
    labels = (f"pod {p} ({at(layout, layout.pod_waypoint[p])})" for p in outside)
    yield from grouped(IMPOSSIBLE, labels, "does not stand at a storage location")
    yield from _crowded(layout, layout.pod_waypoint, "pods")


def _robots(layout: Layout) -> Iterator[Violation]:
    places = int(layout.is_storage.sum())
    if layout.robots > places:
        message = (
            f"{layout.robots} robots, but only {places} storage locations to rest at (W2: a robot "
            "without a task must not stand in the way)"
        )
        yield Violation(NOT_WELL_FORMED, "robots", message)
    yield from _crowded(layout, layout.robot_waypoint, "robots")


def _crowded(layout: Layout, waypoints: NDArray[np.int32], what: str) -> Iterator[Violation]:
    """Yield the waypoints at which several pods, or several robots, stand."""
    taken, times = np.unique(waypoints, return_counts=True)
    for waypoint, count in zip(taken[times > 1], times[times > 1], strict=True):
        who = ", ".join(str(i) for i in np.flatnonzero(waypoints == waypoint))
        message = f"{count} {what} stand here at the start ({what} {who})"
        yield Violation(IMPOSSIBLE, waypoint_label(layout, int(waypoint)), message)


def _stations(layout: Layout) -> Iterator[Violation]:
    """Yield stations that share their place with something else."""
    first: dict[int, int] = {}
    for number, station in enumerate(layout.stations):
        label = station_label(layout, number)
        if layout.is_storage[station.waypoint]:
            yield Violation(NOT_WELL_FORMED, label, "stands at a storage location (W1)")
        if station.waypoint in first:
            other = station_label(layout, first[station.waypoint])
            yield Violation(IMPOSSIBLE, label, f"stands at the waypoint of {other}")
        first.setdefault(station.waypoint, number)
    lifts = {waypoint: e for e, lift in enumerate(layout.elevators) for waypoint in lift.waypoints}
    for waypoint in sorted(first.keys() & lifts.keys()):
        label = station_label(layout, first[waypoint])
        yield Violation(IMPOSSIBLE, label, f"stands in elevator {lifts[waypoint]}")


def _tiers(layout: Layout) -> Iterator[Violation]:
    length_m = np.array([tier.length_m for tier in layout.tiers])[layout.tier]
    width_m = np.array([tier.width_m for tier in layout.tiers])[layout.tier]
    inside = (layout.x_m >= 0) & (layout.x_m <= length_m)
    inside &= (layout.y_m >= 0) & (layout.y_m <= width_m)
    labels = (waypoint_label(layout, int(v)) for v in np.flatnonzero(~inside))
    yield from grouped(NOT_WELL_FORMED, labels, "lies outside its tier")
    for number, elevator in enumerate(layout.elevators):
        tiers = [int(layout.tier[waypoint]) for waypoint in elevator.waypoints]
        if len(set(tiers)) < len(tiers):
            message = f"boards twice on the same tier (tiers {tiers})"
            yield Violation(IMPOSSIBLE, f"elevator {number}", message)
