"""Checks that no two robots on a tier collide."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .distance import meets
from .episodes import worst
from .report import Finding, FindingKind
from .sweep import close_pairs

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.layout.model import Layout

    from .motion import Pieces
    from .trace import Kinematics, Trace

    Floats = NDArray[np.float64]
    Index = NDArray[np.int64]

TOLERANCE_M = 1e-6
"""Largest overlap that counts as a rounding error, in m."""


def radii(layout: Layout, trace: Trace, limits: Kinematics) -> Floats:
    """Return the radius in m of the robot in each row or, if larger, of the pod that it carries."""
    loaded = np.maximum(limits.radius_m, layout.pod_radius_m)
    return np.where(trace.pod >= 0, loaded, limits.radius_m)


def check(
    layout: Layout, trace: Trace, limits: Kinematics, pieces: Pieces
) -> tuple[list[Finding], int]:
    """Find every collision of two robots.

    Returns
    -------
    tuple
        One finding per collision, at its worst moment, and the number of pairs of pieces that were
        examined because they are close in time and space.
    """
    radius = radii(layout, trace, limits)[pieces.row]
    robot = trace.robot[pieces.row]
    tier = np.asarray(layout.tier, np.int64)[trace.from_wp[pieces.row]]
    nothing = np.zeros(0, np.int64)
    hits: list[tuple[Index, Index]] = [(nothing, nothing)]
    examined = 0
    for one, other in close_pairs(pieces, radius, tier, robot):
        limit = (radius[one] + radius[other] - TOLERANCE_M) ** 2
        hit, *_ = meets(pieces.take(one), pieces.take(other), limit)
        examined += len(one)
        hits.append((one[hit], other[hit]))
    one, other = (np.concatenate(side) for side in zip(*hits, strict=True))
    return _collisions(layout, trace, pieces, radius, one, other), examined


def _collisions(
    layout: Layout, trace: Trace, pieces: Pieces, radius: Floats, one: Index, other: Index
) -> list[Finding]:
    """Turn overlapping pairs of pieces into one finding per pair of robots and event."""
    robot = trace.robot[pieces.row]
    swap = robot[one] > robot[other]
    one, other = np.where(swap, other, one), np.where(swap, one, other)
    a, b = pieces.take(one), pieces.take(other)
    _, moment, squared = meets(a, b, np.full(len(one), np.inf))
    begin, end = np.maximum(a.t0_s, b.t0_s), np.minimum(a.t1_s, b.t1_s)
    depth = radius[one] + radius[other] - np.sqrt(np.maximum(squared, 0.0))
    return [
        Finding(
            FindingKind.ROBOTS_OVERLAP,
            float(moment[k]),
            (int(robot[one[k]]), int(robot[other[k]])),
            _nearest(layout, trace, pieces.take(one[k : k + 1]), float(moment[k])),
            float(depth[k]),
        )
        for k in worst((robot[one], robot[other]), begin, end, depth)
    ]


def _nearest(layout: Layout, trace: Trace, piece: Pieces, time_s: float) -> int:
    """Return the waypoint nearest to the position of a single piece at a given time."""
    x, y = piece.at(np.array([time_s]))
    tier = layout.tier[trace.from_wp[piece.row[0]]]
    away = np.hypot(layout.x_m - x[0], layout.y_m - y[0])
    return int(np.argmin(np.where(layout.tier == tier, away, np.inf)))
