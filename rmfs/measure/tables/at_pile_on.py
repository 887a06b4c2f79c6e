"""Maximum rate of a pick station at a given pile-on, provided that the next pod is always ready."""

from __future__ import annotations

from math import inf, pi, sqrt
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.layout.model import Layout, PickStation, RobotKind


def units_per_h(layout: Layout, station: PickStation, units_per_visit: float) -> float:
    """Return the maximum rate of a station at a given mean pile-on if the next pod is always ready.

    For each unit, the station is busy for a time T (`unit_transfer_s`), and the robot must stay for
    a time K (`unit_pick_s`). Each of the p units of a visit except the last therefore takes
    max(T, K). From the start of the last unit to the start of the next visit's first unit, at least
    max(T, K + c) passes: the robot leaves after K, and the next robot arrives at least a time c
    later (`change_s`). A visit and the change of robots after it thus take at least
    (p - 1) max(T, K) + max(T, K + c). This is linear in p, so its value at the mean pile-on is a
    lower bound on the mean time of a visit and a change.

    Parameters
    ----------
    units_per_visit
        Mean pile-on of the station; infinite if its pod never changes.

    Returns
    -------
    float
        Units per hour; infinite if neither handling nor changing pods takes time.
    """
    transfer_s, pick_s = station.unit_transfer_s, station.unit_pick_s
    slower_s = max(transfer_s, pick_s)
    extra_s = max(transfer_s, pick_s + change_s(layout, station.waypoint)) - slower_s
    per_unit_s = slower_s + extra_s / units_per_visit
    return 3600.0 / per_unit_s if per_unit_s > 0 else inf


def change_s(layout: Layout, waypoint: int) -> float:
    """Return the minimum time from one robot's departure to the next one's arrival, in s.

    The departing robot turns from the edge on which it arrived to the edge on which it leaves, and
    clears the waypoint when it reaches the end of that second edge. Only then may the next robot
    enter the edge on which it arrives. The result is the minimum over all choices of these three
    edges and over the kinds of robots. Robots are assumed to stop only at the waypoint itself, not
    at the other ends of these edges.
    """
    inward, outward = list(_edges_in(layout, waypoint)), list(_edges_out(layout, waypoint))
    if not inward or not outward:
        return 0.0
    kinds = layout.robot_kinds
    leave_s = min(
        _drive_s(length, kind.acceleration_m_s2, kind.top_speed_m_s) + _turn_s(came, heading, kind)
        for _, came in inward
        for length, heading in outward
        for kind in kinds
    )
    come_s = min(
        _drive_s(length, kind.deceleration_m_s2, kind.top_speed_m_s)
        for length, _ in inward
        for kind in kinds
    )
    return leave_s + come_s


def _drive_s(length_m: float, acceleration_m_s2: float, top_speed_m_s: float) -> float:
    """Return the time to accelerate from rest over a length, or, reversed, to brake to rest."""
    ramp_m = top_speed_m_s**2 / (2 * acceleration_m_s2)
    if length_m <= ramp_m:
        return sqrt(2 * length_m / acceleration_m_s2)
    return top_speed_m_s / acceleration_m_s2 + (length_m - ramp_m) / top_speed_m_s


def _turn_s(heading_in: float, heading_out: float, kind: RobotKind) -> float:
    angle = abs(heading_out - heading_in) % (2 * pi)
    return min(angle, 2 * pi - angle) / (2 * pi) * kind.full_turn_s


def _edges_out(layout: Layout, waypoint: int) -> Iterator[tuple[float, float]]:
    """Yield length and heading of the edges that leave a waypoint."""
    for end in layout.edge_target[layout.edge_start[waypoint] : layout.edge_start[waypoint + 1]]:
        yield _vector(layout, waypoint, int(end))


def _edges_in(layout: Layout, waypoint: int) -> Iterator[tuple[float, float]]:
    """Yield length and heading of the edges that lead to a waypoint."""
    for edge in np.flatnonzero(layout.edge_target == waypoint):
        start = int(np.searchsorted(layout.edge_start, edge, side="right")) - 1
        yield _vector(layout, start, waypoint)


def _vector(layout: Layout, start: int, end: int) -> tuple[float, float]:
    x_m = float(layout.x_m[end] - layout.x_m[start])
    y_m = float(layout.y_m[end] - layout.y_m[start])
    return float(np.hypot(x_m, y_m)), float(np.arctan2(y_m, x_m))
