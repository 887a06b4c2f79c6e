"""Initial plans: a given feasible plan, or the visits of an earlier plan."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.solvers.models.checks import require
from rmfs.solvers.models.planning.values import violations

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.solvers.models.planning.data import Planning
    from rmfs.solvers.models.planning.values import Plan


def first_visits(
    data: Planning, start: Plan | None, pods: Sequence[Sequence[int]]
) -> list[list[int]]:
    """Return the pods of the new visits of `start`, one list per station.

    If `start` is None, return the pods of an earlier plan (`pods`) whose visits are still possible.

    Raises
    ------
    ModelError
        If the start is not feasible.
    """
    if start is None:
        return _possible(data, pods)
    wrong = violations(data, start)
    require(not wrong, "start", "; ".join(wrong))
    return [list(new) for new in start.pods]


def _possible(data: Planning, pods: Sequence[Sequence[int]]) -> list[list[int]]:
    """Return the pods, without those whose visits are no longer possible."""
    found: list[list[int]] = [[] for _ in range(data.stations)]
    seen: set[int] = set()
    for station, new in enumerate(pods):
        for pod in new:
            may_come = np.isfinite(data.cost[pod, station]) and pod not in seen
            if may_come and len(found[station]) < data.visits:
                found[station].append(pod)
                seen.add(pod)
    return found
