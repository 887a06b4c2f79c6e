"""The start rule: one visit after the other, each the best of the few pods that look best."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.solvers.models.planning.appeal import Appeal
    from rmfs.solvers.models.planning.filling import Draft, Filling

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
        if better is None:
            done.add(station)
        else:
            draft = better


def with_visit(filling: Filling, draft: Draft, station: int, visit: int, pod: int) -> Draft:
    """Let a pod come in between the new visits of a draft."""
    pods = [list(one) for one in draft.pods]
    pods[station].insert(visit, pod)
    return filling.draft(pods)


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
