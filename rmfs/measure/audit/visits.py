"""Audit of visits: whether the right pod is at the station when units are picked or stored."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.measure.audit.report import Chapter
from rmfs.measure.audit.rows import Rows
from rmfs.measure.events import Happening
from rmfs.traffic import Piece

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

    from rmfs.layout.model import Layout

WHERE = "this robot and pod are not visiting this station at this time"


def check(layout: Layout, rows: Rows, motion: pd.DataFrame, end_us: int) -> Chapter:
    """Check that units are picked, and bundles stored, only while the pod visits the station.

    Also checks that visits to the same station do not overlap, and that robot and pod stand
    at the station throughout each visit.

    Parameters
    ----------
    motion
        The trace, sorted by robot and time.
    end_us
        End of the run, at which visits may still be in progress.
    """
    kinds = (Happening.VISIT_STARTED, Happening.VISIT_ENDED)
    visits = rows.of_kind(*kinds)
    faults = visits.lines(visits.station < 0, "the station is missing")
    visits = visits.taken(visits.station >= 0)
    order = np.lexsort((visits.number, visits.station))
    mine = visits.taken(order)
    starts = mine.kind == Happening.VISIT_STARTED
    same = np.append(False, mine.station[1:] == mine.station[:-1])
    again = np.append(False, starts[1:] == starts[:-1]) & same
    faults += mine.lines(again & starts, "the previous visit to this station has not ended")
    faults += mine.lines(~starts & (again | ~same), WHERE)
    pair = np.append(False, ~starts[1:] & starts[:-1]) & same
    other = np.append(False, (mine.robot[1:] != mine.robot[:-1]) | (mine.pod[1:] != mine.pod[:-1]))
    faults += mine.lines(pair & other, WHERE)
    faults += _at_work(rows, mine, starts)
    until = np.append(np.where(pair[1:], mine.time_us[1:], end_us), end_us)[: len(mine)]
    begun = np.flatnonzero(starts)
    faults += _standing(layout, mine.taken(begun), until[begun], motion)
    return Chapter("visits", f"{len(begun)} to {len(layout.stations)} stations", faults)


def _at_work(rows: Rows, visits: Rows, starts: NDArray[np.bool_]) -> list[str]:
    """Check that units are picked, and bundles stored, during a visit of this robot and pod."""
    done = rows.of_kind(Happening.UNIT_PICKED, Happening.BUNDLE_STORED)
    if not len(visits):
        return done.lines(np.ones(len(done), np.bool_), WHERE)
    width = int(rows.number[-1]) + 1 if len(rows) else 1
    # the last visit event of the same station before it
    before = (
        np.searchsorted(visits.station * width + visits.number, done.station * width + done.number)
        - 1
    )
    known = np.maximum(before, 0)
    right = (before >= 0) & (visits.station[known] == done.station) & starts[known]
    right &= (visits.robot[known] == done.robot) & (visits.pod[known] == done.pod)
    return done.lines(~right, WHERE)


def _standing(
    layout: Layout, visits: Rows, until_us: np.ndarray, motion: pd.DataFrame
) -> list[str]:
    """Check that the robot stands at the station during each visit, with the pod if any."""
    waypoints = np.array([station.waypoint for station in layout.stations], np.int64)
    robot, t0, t1 = (motion[name].to_numpy(np.int64) for name in ("robot", "t0_us", "t1_us"))
    place, kind, pod = (motion[name].to_numpy(np.int64) for name in ("from_wp", "kind", "pod"))
    width = int(max(t1.max(initial=0), visits.time_us.max(initial=0), until_us.max(initial=0))) + 2
    keys = robot * width + t0
    first = np.searchsorted(keys, visits.robot * width + visits.time_us, "right") - 1
    last = np.searchsorted(keys, visits.robot * width + until_us, "left") - 1
    wrong = np.zeros(len(visits), np.bool_)
    for row in range(len(visits)):
        span = slice(max(first[row], 0), max(last[row], first[row], 0) + 1)
        stands = (kind[span] == Piece.HOLD) & (place[span] == waypoints[visits.station[row]])
        with_pod = (pod[span] == visits.pod[row]) if visits.pod[row] >= 0 else True
        here = robot[span] == visits.robot[row]
        wrong[row] = not np.all(stands & with_pod & here)
    return visits.lines(
        wrong, "in the trace, the robot does not stand at the station with this pod all the time"
    )
