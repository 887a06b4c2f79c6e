"""Checks that pods are lifted where they stand, share no place, and are not hit by carried pods."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .distance import meets
from .episodes import worst
from .motion import Pieces
from .report import Finding, FindingKind
from .separation import TOLERANCE_M
from .trace import MICROSECONDS, Motion, Trace

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.layout.model import Layout

    Floats = NDArray[np.float64]
    Index = NDArray[np.int64]

WAYS_AT_ONCE = 256
"""Number of paths compared with all places at a time; limits memory."""


@dataclass(frozen=True, slots=True)
class Stays:
    """Stays of pods at places (waypoints), sorted by place; all arrays have shape (S,)."""

    pod: Index
    place: Index
    t0_s: Floats
    t1_s: Floats


def check(layout: Layout, trace: Trace, pieces: Pieces) -> list[Finding]:
    """Find every faulty handling of a pod, and every collision of a carried and a stored pod."""
    stays, found = ledger(layout, trace)
    return [*_carrying(trace), *found, *_crossings(layout, trace, pieces, stays)]


def _carrying(trace: Trace) -> list[Finding]:
    """Check that the pod on a robot changes only by lifting and setting down."""
    before = np.full(len(trace), -1, np.int64)
    kept = trace.follows & (trace.kind[:-1] != Motion.SET_DOWN)
    before[1:][kept] = trace.pod[:-1][kept]
    is_lift = trace.kind == Motion.LIFT
    handled = trace.is_kind(Motion.LIFT, Motion.SET_DOWN)
    wrong = np.where(is_lift, before != -1, before != trace.pod) | (handled & (trace.pod < 0))
    return [
        Finding(
            FindingKind.POD_HANDLING,
            float(trace.t0_us[row]) / MICROSECONDS,
            (int(trace.robot[row]),),
            int(trace.from_wp[row]),
            float(max(trace.pod[row], before[row])),
        )
        for row in np.flatnonzero(wrong)
    ]


def ledger(layout: Layout, trace: Trace) -> tuple[Stays, list[Finding]]:
    """Track where every pod is: at a place, or on a robot.

    A pod counts as stored until a robot starts to lift it, and again as soon as it is set down.

    Returns
    -------
    tuple
        The stays of pods at places, and a finding for each impossible lifting or setting down.
    """
    begin_s = float(trace.t0_us.min() if len(trace) else 0) / MICROSECONDS
    place = [int(waypoint) for waypoint in layout.pod_waypoint]
    since = [begin_s] * layout.pods
    carrier = [-1] * layout.pods
    standing = {waypoint: pod for pod, waypoint in enumerate(place)}
    stays: list[tuple[int, int, float, float]] = []
    found: list[Finding] = []
    for time_us, kind, robot, pod, waypoint in _handlings(trace):
        time_s = time_us / MICROSECONDS
        legal = True
        if kind == Motion.LIFT:
            legal = carrier[pod] < 0 and place[pod] == waypoint
            if carrier[pod] < 0:
                stays.append((pod, place[pod], since[pod], time_s))
                standing.pop(place[pod], None)
            carrier[pod] = robot
        else:
            legal = carrier[pod] == robot
            if waypoint in standing or not layout.is_storage[waypoint]:
                found.append(Finding(FindingKind.POD_PLACE, time_s, (robot,), waypoint, float(pod)))
            carrier[pod], place[pod], since[pod] = -1, waypoint, time_s
            standing[waypoint] = pod
        if not legal:
            found.append(Finding(FindingKind.POD_HANDLING, time_s, (robot,), waypoint, float(pod)))
    end_s = float(trace.t1_us.max(initial=0)) / MICROSECONDS
    stays += [
        (pod, place[pod], since[pod], end_s) for pod in range(layout.pods) if carrier[pod] < 0
    ]
    return _sorted(stays), found


def _handlings(trace: Trace) -> list[tuple[int, int, int, int, int]]:
    """Return every lifting and setting down, by time: (time, kind, robot, pod, waypoint)."""
    lifts = np.flatnonzero((trace.kind == Motion.LIFT) & (trace.pod >= 0))
    downs = np.flatnonzero((trace.kind == Motion.SET_DOWN) & (trace.pod >= 0))
    rows = np.concatenate([lifts, downs])
    time = np.concatenate([trace.t0_us[lifts], trace.t1_us[downs]])
    # at equal times, ends come before starts: a pod may be lifted as soon as it stands
    order = np.lexsort((trace.robot[rows], trace.kind[rows] == Motion.LIFT, time))
    columns = (time, trace.kind[rows], trace.robot[rows], trace.pod[rows], trace.from_wp[rows])
    t, k, r, p, w = (column[order].tolist() for column in columns)
    return list(zip(t, k, r, p, w, strict=True))


def _sorted(stays: list[tuple[int, int, float, float]]) -> Stays:
    table = np.array(sorted(stays, key=lambda stay: (stay[1], stay[2])), np.float64).reshape(-1, 4)
    return Stays(
        table[:, 0].astype(np.int64), table[:, 1].astype(np.int64), table[:, 2], table[:, 3]
    )


def _crossings(layout: Layout, trace: Trace, pieces: Pieces, stays: Stays) -> list[Finding]:
    """Check that the discs of carried and stored pods do not overlap."""
    row, stay = _meetings(layout, trace, stays)
    # every piece of the row against the stay
    first = np.searchsorted(pieces.row, row, side="left")
    count = np.searchsorted(pieces.row, row, side="right") - first
    piece = np.repeat(first, count) + _within(count)
    stay = np.repeat(stay, count)
    together = (pieces.t0_s[piece] < stays.t1_s[stay]) & (stays.t0_s[stay] < pieces.t1_s[piece])
    moving, still = pieces.take(piece[together]), _standing(layout, stays, stay[together])
    begin, end = np.maximum(moving.t0_s, still.t0_s), np.minimum(moving.t1_s, still.t1_s)
    reach = 2 * layout.pod_radius_m
    hit, moment, squared = meets(moving, still, np.full(len(moving), (reach - TOLERANCE_M) ** 2))
    moment, depth = moment[hit], reach - np.sqrt(np.maximum(squared[hit], 0.0))
    who = trace.robot[moving.row[hit]], stays.pod[stay[together][hit]]
    place = stays.place[stay[together][hit]]
    return [
        Finding(
            FindingKind.POD_CROSSED,
            float(moment[k]),
            (int(who[0][k]),),
            int(place[k]),
            float(depth[k]),
        )
        for k in worst(who, begin[hit], end[hit], depth)
    ]


def _meetings(layout: Layout, trace: Trace, stays: Stays) -> tuple[Index, Index]:
    """Return pairs of a row with a carried pod and a stay of another pod nearby at that time."""
    rows = np.flatnonzero((trace.pod >= 0) & (trace.kind != Motion.LIFT_RIDE))
    ways, way_of = np.unique(
        np.stack([trace.from_wp[rows], trace.to_wp[rows]]), axis=1, return_inverse=True
    )
    way, place = _touched(layout, ways[0], ways[1], np.unique(stays.place))
    # places touched by each row's way, then the stays at each place
    first = np.searchsorted(way, way_of.reshape(-1), side="left")
    count = np.searchsorted(way, way_of.reshape(-1), side="right") - first
    row = np.repeat(rows, count)
    near = place[np.repeat(first, count) + _within(count)]
    first = np.searchsorted(stays.place, near, side="left")
    count = np.searchsorted(stays.place, near, side="right") - first
    row = np.repeat(row, count)
    stay = np.repeat(first, count) + _within(count)
    shares = (trace.t0_us[row] / MICROSECONDS < stays.t1_s[stay]) & (
        stays.t0_s[stay] < trace.t1_us[row] / MICROSECONDS
    )
    other = trace.pod[row] != stays.pod[stay]
    return row[shares & other], stay[shares & other]


def _within(count: Index) -> Index:
    """Return 0, 1, ... count[0] - 1, 0, 1, ... count[1] - 1, and so on."""
    result: Index = np.arange(int(count.sum())) - np.repeat(np.cumsum(count) - count, count)
    return result


def _touched(layout: Layout, origin: Index, target: Index, places: Index) -> tuple[Index, Index]:
    """Return pairs (way, place) for which a pod carried along the straight way would touch a pod.

    The other pod is stored at the place.
    """
    px, py = layout.x_m[places], layout.y_m[places]
    tier = np.asarray(layout.tier)
    found: list[tuple[Index, Index]] = []
    for begin in range(0, len(origin), WAYS_AT_ONCE):
        some = slice(begin, begin + WAYS_AT_ONCE)
        ax, ay = layout.x_m[origin[some], None], layout.y_m[origin[some], None]
        dx, dy = layout.x_m[target[some], None] - ax, layout.y_m[target[some], None] - ay
        square = np.maximum(dx**2 + dy**2, 1e-30)
        along = np.clip(((px - ax) * dx + (py - ay) * dy) / square, 0.0, 1.0)
        away = np.hypot(ax + along * dx - px, ay + along * dy - py)
        near = (away < 2 * layout.pod_radius_m) & (tier[origin[some], None] == tier[places])
        way, index = np.nonzero(near)
        found.append((way + begin, places[index]))
    if not found:
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    return np.concatenate([one for one, _ in found]), np.concatenate([two for _, two in found])


def _standing(layout: Layout, stays: Stays, stay: Index) -> Pieces:
    """Return stays as pieces that do not move."""
    place, zero = stays.place[stay], np.zeros(len(stay))
    return Pieces(
        *(np.full(len(stay), -1), stays.t0_s[stay], stays.t1_s[stay]),
        *(layout.x_m[place], layout.y_m[place], zero, zero, zero, zero),
        np.zeros(len(stay), np.bool_),
    )
