"""Pods choose places in turn, those with the most expected visits first."""

from __future__ import annotations

import math
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, solution_of_rule
from rmfs.solvers.models.storage.placement.data import Placement, objective


def solve(
    data: Placement,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: NDArray[np.int64] | None = None,
) -> Solution[NDArray[np.int64]]:
    """Give each pod the cheapest remaining place, in descending order of expected visits.

    The bound is computed as if any number of pods could share a place.

    Returns
    -------
    The place of each pod, shape (P,); ties go to the lowest index. The status is INFEASIBLE if no
    place is allowed for some pod, and LIMIT if a pod is left without a place for another reason. In
    the latter case, a feasible placement may exist, because the rule never revises a choice.
    """
    begin = perf_counter()
    cost_s = data.cost_s
    bound = float(cost_s.min(axis=1, initial=math.inf).sum())
    return solution_of_rule(
        _places(data, cost_s.copy()),
        lambda place: objective(data, place),
        bound=bound,
        work=float(cost_s.size),
        began=begin,
    )


def _places(data: Placement, free: NDArray[np.float64]) -> NDArray[np.int64] | None:
    """Give pods places; return None if one finds none. The table `free` is overwritten."""
    place = np.full(len(free), -1, np.int64)
    for pod in np.argsort(-data.visits, kind="stable").tolist():
        best = int(free[pod].argmin()) if free.shape[1] else -1
        if best < 0 or math.isinf(free[pod, best]):
            return None
        place[pod] = best
        free[:, best] = math.inf
    return place
