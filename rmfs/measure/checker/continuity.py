"""Checks of single robots: gaps, jumps, kinematic limits, and motion along edges."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .motion import lengths, profile
from .report import Finding, FindingKind
from .trace import MICROSECONDS, Kinematics, Motion, Trace

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.layout.model import Layout

    Floats = NDArray[np.float64]
    Mask = NDArray[np.bool_]

ROUNDING_S = 2e-6
"""Tolerance of durations, in s, as start and end are rounded to microseconds."""

SAME_SPEED_M_S = 1e-9
"""Tolerance of speeds, in m/s, as a reduced top speed is a product and therefore rounded."""

ANGLE_RAD = 1e-5
"""Tolerance of headings, in rad; over 100 m it causes a deviation of less than 1 mm."""


def check(layout: Layout, trace: Trace, limits: Kinematics, until_us: int) -> list[Finding]:
    """Check every robot's trace separately.

    Parameters
    ----------
    until_us
        End of the trace in microseconds; a motion that is in progress at the end may be recorded in
        full or cut off there.
    """
    return [
        *_presence(layout, trace, until_us),
        *_gaps(trace),
        *_jumps(layout, trace),
        *_headings(layout, trace),
        *_durations(layout, trace, limits, until_us),
        *_edges(layout, trace),
        *_rides(layout, trace),
    ]


def _findings(
    kind: FindingKind, trace: Trace, wrong: Mask, amount: Floats, *, end: bool = False
) -> list[Finding]:
    """Return one finding per marked row, at the row's start (or end)."""
    time_us = trace.t1_us if end else trace.t0_us
    return [
        Finding(
            kind,
            float(time_us[row]) / MICROSECONDS,
            (int(trace.robot[row]),),
            int(trace.to_wp[row] if end else trace.from_wp[row]),
            float(amount[row]),
        )
        for row in np.flatnonzero(wrong)
    ]


def _presence(layout: Layout, trace: Trace, until_us: int) -> list[Finding]:
    """Check that rows cover every robot from the common start to the common end."""
    begin_us = int(trace.t0_us.min(initial=until_us))
    absent = np.setdiff1d(np.arange(layout.robots), trace.robot)
    span = (until_us - begin_us) / MICROSECONDS
    found = [
        Finding(FindingKind.GAP, begin_us / MICROSECONDS, (int(robot),), -1, span)
        for robot in absent
    ]
    first = np.append(True, ~trace.follows)[: len(trace)]
    late = (trace.t0_us - begin_us) / MICROSECONDS
    short = (until_us - trace.t1_us) / MICROSECONDS
    found += _findings(FindingKind.GAP, trace, first & (late > 0), late)
    found += _findings(FindingKind.GAP, trace, trace.is_last & (short > 0), short, end=True)
    return found


def _gaps(trace: Trace) -> list[Finding]:
    """Check that each row has a positive duration and starts when the previous one ends."""
    missing = np.zeros(len(trace))
    missing[:-1] = (trace.t0_us[1:] - trace.t1_us[:-1]) / MICROSECONDS
    wrong = ~trace.is_last & (missing != 0)
    lasting = (trace.t1_us - trace.t0_us) / MICROSECONDS
    return [
        *_findings(FindingKind.GAP, trace, wrong, missing, end=True),
        *_findings(FindingKind.GAP, trace, lasting < 0, lasting),
    ]


def _jumps(layout: Layout, trace: Trace) -> list[Finding]:
    """Check that each row starts where the robot's previous row ends.

    The first row of a robot must start at its initial waypoint in the layout. Robots that do not
    drive must remain at their waypoints.
    """
    before = np.asarray(layout.robot_waypoint)[trace.robot].astype(np.int64)
    before[1:][trace.follows] = trace.to_wp[:-1][trace.follows]
    moved = np.hypot(
        layout.x_m[trace.from_wp] - layout.x_m[before],
        layout.y_m[trace.from_wp] - layout.y_m[before],
    )
    standing = ~trace.is_kind(Motion.RUN, Motion.LIFT_RIDE, Motion.GUIDED)
    drifted = standing & (trace.from_wp != trace.to_wp)
    return [
        *_findings(FindingKind.JUMP, trace, before != trace.from_wp, moved),
        *_findings(FindingKind.JUMP, trace, drifted, lengths(layout, trace)),
    ]


def _headings(layout: Layout, trace: Trace) -> list[Finding]:
    """Check that headings change only in turns, and that robots drive in the direction they head.

    A guided robot either drives from one waypoint to another or turns at a waypoint.
    """
    before = np.asarray(layout.robot_heading_rad, np.float64)[trace.robot]
    before[1:][trace.follows] = trace.heading1_rad[:-1][trace.follows]
    broken = _angle(before, trace.heading0_rad)
    may_turn = (trace.kind == Motion.TURN) | (trace.is_guided & (trace.from_wp == trace.to_wp))
    turned = np.where(may_turn, 0.0, _angle(trace.heading0_rad, trace.heading1_rad))
    way = np.arctan2(
        layout.y_m[trace.to_wp] - layout.y_m[trace.from_wp],
        layout.x_m[trace.to_wp] - layout.x_m[trace.from_wp],
    )
    drives = (trace.kind == Motion.RUN) | (trace.is_guided & (trace.from_wp != trace.to_wp))
    astray = np.where(drives, _angle(way, trace.heading0_rad), 0.0)
    return [
        finding
        for off in (broken, turned, astray)
        for finding in _findings(FindingKind.HEADING, trace, off > ANGLE_RAD, off)
    ]


def _angle(one: Floats, other: Floats) -> Floats:
    """Return the angle between two headings, 0 to pi."""
    return np.abs((one - other + np.pi) % (2 * np.pi) - np.pi)


def _durations(layout: Layout, trace: Trace, limits: Kinematics, until_us: int) -> list[Finding]:
    """Check that motions take the time that the robot or elevator needs.

    A straight run must follow the fastest speed profile. If it takes less time, it must have
    exceeded a limit of speed or acceleration; if it takes more time, it followed another profile.
    The duration of guided motion is not checked, because robots outside the simulation determine
    it.
    """
    needed = np.full(len(trace), np.nan)
    is_run, is_turn = trace.kind == Motion.RUN, trace.kind == Motion.TURN
    needed[is_run] = profile(lengths(layout, trace), limits).duration_s[is_run]
    turn = _angle(trace.heading0_rad, trace.heading1_rad) / (2 * np.pi) * limits.full_turn_s
    needed[is_turn] = turn[is_turn]
    transfer = trace.is_kind(Motion.LIFT, Motion.SET_DOWN)
    needed[transfer] = limits.pod_transfer_s[transfer]
    travel = _travel(layout)
    for row in np.flatnonzero(trace.kind == Motion.LIFT_RIDE):
        pair = (int(trace.from_wp[row]), int(trace.to_wp[row]))
        needed[row] = travel.get(pair, np.nan)
    off = (trace.t1_us - trace.t0_us) / MICROSECONDS - needed
    cut = trace.is_last & (trace.t1_us >= until_us)
    wrong = (np.abs(off) > ROUNDING_S) & ~(cut & (off < 0))
    return _findings(FindingKind.DURATION, trace, wrong, off)


def speeds(trace: Trace, limits: Kinematics) -> list[Finding]:
    """If the trace states the top speeds of straight runs, check that they equal the limits."""
    if trace.top_speed_m_s is None:
        return []
    off = np.where(trace.kind == Motion.RUN, trace.top_speed_m_s - limits.top_speed_m_s, 0.0)
    return _findings(FindingKind.SPEED, trace, np.abs(off) > SAME_SPEED_M_S, off)


def _travel(layout: Layout) -> dict[tuple[int, int], float]:
    return {pair: time for one in layout.elevators for pair, time in one.travel_s.items()}


def _rides(layout: Layout, trace: Trace) -> list[Finding]:
    """Check that rides connect waypoints of the same elevator."""
    pairs = _travel(layout)
    wrong = np.zeros(len(trace), np.bool_)
    for row in np.flatnonzero(trace.kind == Motion.LIFT_RIDE):
        wrong[row] = (int(trace.from_wp[row]), int(trace.to_wp[row])) not in pairs
    return _findings(FindingKind.ELEVATOR_PAIR, trace, wrong, trace.to_wp.astype(np.float64))


def _edges(layout: Layout, trace: Trace) -> list[Finding]:
    """Check that every drive follows a straight chain of edges, in the direction of the edges."""
    is_run = (trace.kind == Motion.RUN) | (trace.is_guided & (trace.from_wp != trace.to_wp))
    ways, way_of = np.unique(
        np.stack([trace.from_wp[is_run], trace.to_wp[is_run]]), axis=1, return_inverse=True
    )
    wrong = np.zeros(len(trace), np.bool_)
    wrong[is_run] = ~_drivable(layout, ways[0], ways[1])[way_of.reshape(-1)]
    return _findings(FindingKind.EDGE, trace, wrong, lengths(layout, trace))


def _drivable(layout: Layout, origin: NDArray[np.int64], target: NDArray[np.int64]) -> Mask:
    """Whether a straight chain of edges leads from each origin to its target.

    All paths advance together, one edge per round: every edge that keeps the direction and does not
    overshoot is followed.
    """
    start = np.asarray(layout.edge_start, np.int64)
    reached = np.zeros(len(origin), np.bool_)
    way, here = np.arange(len(origin)), origin
    while len(way):
        degree = start[here + 1] - start[here]
        way = np.repeat(way, degree)
        offset = np.arange(len(way)) - np.repeat(np.cumsum(degree) - degree, degree)
        nearer = np.asarray(layout.edge_target, np.int64)[np.repeat(start[here], degree) + offset]
        keep = ~reached[way] & _on_the_way(layout, np.repeat(here, degree), nearer, target[way])
        way, here = way[keep], nearer[keep]
        reached[way[here == target[way]]] = True
        going = ~reached[way]
        way, here = way[going], here[going]
    return reached


def _on_the_way(
    layout: Layout, here: NDArray[np.int64], there: NDArray[np.int64], goal: NDArray[np.int64]
) -> Mask:
    """Whether `there` lies on the straight line from `here` to `goal`, on the same tier."""
    x, y, tier = layout.x_m, layout.y_m, layout.tier
    ex, ey = x[there] - x[here], y[there] - y[here]
    gx, gy = x[goal] - x[here], y[goal] - y[here]
    aside = np.abs(ex * gy - ey * gx)
    ahead = ex * gx + ey * gy
    distance = np.hypot(gx, gy)
    # a sideways deviation of 1e-9 m at the goal is rounding of coordinates
    straight = aside <= 1e-9 * np.maximum(np.hypot(ex, ey), 1e-12)
    within = (ahead > 0) & (ahead <= distance**2 * (1 + 1e-9))
    same = (tier[there] == tier[here]) & (tier[goal] == tier[here])
    result: Mask = straight & within & same
    return result
