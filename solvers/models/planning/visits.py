"""Steps from one draft to another: more visits, one visit, visits of an earlier plan."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.solvers.models.checks import require
from rmfs.solvers.models.planning.values import violations

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.solvers.models.planning.appeal import Appeal
    from rmfs.solvers.models.planning.data import Planning, Reals
    from rmfs.solvers.models.planning.filling import Draft, Filling
    from rmfs.solvers.models.planning.values import Plan

TRIED = 5
"""Pods that are tried for each visit."""


def extended(filling: Filling, appeal: Appeal, pods: Sequence[Sequence[int]]) -> Draft:
    """Add visits to those given as long as they pay; the station with the fewest units first."""
    data = filling.data
    draft = filling.draft(pods)
    done: set[int] = set()
    while True:
        stations = [
            station
            for station in range(data.stations)
            if station not in done and len(draft.pods[station]) < data.visits
        ]
        if not stations:
            return draft
        units = _units(filling, draft)
        station = min(stations, key=lambda s: (units[s], s))
        better = _best(filling, appeal, draft, station)
        better = better or _for_one_order(filling, appeal, draft, station)
        if better is None:
            done.add(station)
        else:
            draft = better


def with_visit(filling: Filling, draft: Draft, station: int, visit: int, pod: int) -> Draft:
    """Let a pod come in between the new visits of a draft."""
    pods = [list(one) for one in draft.pods]
    pods[station].insert(visit, pod)
    return filling.draft(pods)


def first_visits(
    data: Planning, start: Plan | None, pods: Sequence[Sequence[int]]
) -> Sequence[Sequence[int]]:
    """Return the visits of a start, or those of an earlier plan that are still possible.

    Raises
    ------
    ModelError
        If the start is not feasible.
    """
    if start is None:
        return _possible(data, pods)
    wrong = violations(data, start)
    require(not wrong, "start", "; ".join(wrong))
    return start.pods


def _possible(data: Planning, pods: Sequence[Sequence[int]]) -> list[list[int]]:
    """Leave out visits that cannot be made any more."""
    found: list[list[int]] = [[] for _ in range(data.stations)]
    seen: set[int] = set()
    for station, new in enumerate(pods):
        for pod in new:
            may_come = np.isfinite(data.cost[pod, station]) and pod not in seen
            if may_come and len(found[station]) < data.visits:
                found[station].append(pod)
                seen.add(pod)
    return found


def _best(filling: Filling, appeal: Appeal, draft: Draft, station: int) -> Draft | None:
    """Find the best next visit of a station; None if none pays."""
    scores = appeal.scores(draft, station)
    end, best = len(draft.pods[station]), draft
    for pod in np.argsort(-scores, kind="stable")[:TRIED].tolist():
        if np.isfinite(scores[pod]):
            trial = with_visit(filling, draft, station, end, pod)
            if trial.value > best.value:
                best = trial
    return None if best is draft else best


def _for_one_order(filling: Filling, appeal: Appeal, draft: Draft, station: int) -> Draft | None:
    """Let all the pods come that one order lacks; None if that pays for none of a few orders.

    An order of several pods that no other order brings is not begun otherwise: one more visit alone
    would serve nothing of it.
    """
    data, scores = filling.data, appeal.scores(draft, station)
    room = data.visits - len(draft.pods[station])
    waits = np.flatnonzero(np.array(draft.order_station, np.int64) < 0)
    count = np.bincount(data.line_order, minlength=data.orders)
    waits = waits[count[waits] > 1]
    for order in waits[np.argsort(-data.order_worth[waits], kind="stable")][:TRIED].tolist():
        pods = _lacking(data, draft, station, order, scores)
        if pods and len(pods) <= room:
            new = [list(one) for one in draft.pods]
            new[station] += pods
            trial = filling.draft(new)
            if trial.value > draft.value:
                return trial
    return None


def _lacking(data: Planning, draft: Draft, station: int, order: int, scores: Reals) -> list[int]:
    """Choose pods for the lines of an order that no visit of a station has; none if one lacks."""
    there = [*data.under_way[station], *draft.pods[station]]
    chosen: list[int] = []
    for line in np.flatnonzero(data.line_order == order).tolist():
        enough = data.stock[:, data.line_sku[line]] >= data.line_units[line]
        if enough[[*there, *chosen]].any():
            continue
        pods = np.flatnonzero(enough & np.isfinite(scores))
        if not len(pods):
            return []
        chosen.append(int(pods[scores[pods].argmax()]))
    return chosen


def _units(filling: Filling, draft: Draft) -> list[int]:
    """Count the units that each station would be given."""
    data = filling.data
    visit = np.array(draft.line_visit, np.int64)
    station = np.array(draft.order_station, np.int64)[data.line_order]
    served = visit >= 0
    counted: list[int] = np.bincount(
        station[served], data.line_units[served], data.stations
    ).tolist()
    return counted
