"""Checks that queue places, and elevators with all their waypoints, hold at most one robot each."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .report import Finding, FindingKind
from .trace import MICROSECONDS, Motion, Trace

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.layout.model import Layout

    Index = NDArray[np.int64]


def check(layout: Layout, trace: Trace) -> list[Finding]:
    """Find robots that stand on the same queue place or use the same elevator at the same time."""
    standing = ~trace.is_kind(Motion.RUN, Motion.LIFT_RIDE) & (trace.from_wp == trace.to_wp)
    queue_place = np.where(layout.is_queue, np.arange(layout.waypoints), -1)
    elevator = np.full(layout.waypoints, -1)
    for number, one in enumerate(layout.elevators):
        elevator[list(one.waypoints)] = number
    # a robot on an elevator's waypoint occupies it: the cabin cannot be elsewhere
    in_elevator = standing | (trace.kind == Motion.LIFT_RIDE)
    return [
        *_shared(
            trace,
            np.where(standing, queue_place[trace.from_wp], -1),
            FindingKind.QUEUE_PLACE_SHARED,
        ),
        *_shared(
            trace,
            np.where(in_elevator, elevator[trace.from_wp], -1),
            FindingKind.ELEVATOR_SHARED,
        ),
    ]


def _shared(trace: Trace, resource: Index, kind: FindingKind) -> list[Finding]:
    """Find rows of different robots that hold the same resource at the same time.

    Rows that take no time are left out. Of the others, only neighbours in the order of start times
    are compared: if any two rows overlap, so do two neighbours. Every shared use is therefore
    found, but not every pair of robots involved.

    Parameters
    ----------
    resource
        Number of the resource that each row holds, or -1 for none; shape (K,).
    """
    rows = np.flatnonzero((resource >= 0) & (trace.t1_us > trace.t0_us))
    rows = rows[np.lexsort((trace.t0_us[rows], resource[rows]))]
    one, other = rows[:-1], rows[1:]
    overlap_us = np.minimum(trace.t1_us[one], trace.t1_us[other]) - trace.t0_us[other]
    shared = (
        (resource[one] == resource[other])
        & (trace.robot[one] != trace.robot[other])
        & (overlap_us > 0)
    )
    return [
        Finding(
            kind,
            float(trace.t0_us[other[k]]) / MICROSECONDS,
            tuple(sorted((int(trace.robot[one[k]]), int(trace.robot[other[k]])))),
            int(trace.from_wp[other[k]]),
            float(overlap_us[k]) / MICROSECONDS,
        )
        for k in np.flatnonzero(shared)
    ]
