"""Pods one after another: whose coming visits weigh most chooses first."""

from __future__ import annotations

import math
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, Status
from rmfs.solvers.models.storage.placement.data import Placement, objective


def solve(
    data: Placement,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: NDArray[np.int64] | None = None,
) -> Solution[NDArray[np.int64]]:
    """Let each pod take the cheapest place left, most visited pods first.

    The bound lets every pod have its cheapest place, also one that others have.

    Parameters
    ----------
    data
        The problem.
    limits, seed, start
        Not needed.

    Returns
    -------
    The place of each pod, shape (P,); ties go to the lowest index. Status LIMIT if a pod is left
    without a place, as the rule does not take back what it gave; INFEASIBLE if none is allowed.
    """
    begin = perf_counter()
    cost_s = data.cost_s
    bound = float(cost_s.min(axis=1, initial=math.inf).sum())
    place = np.full(len(cost_s), -1, np.int64)
    free = cost_s.copy()
    for pod in np.argsort(-data.visits, kind="stable").tolist():
        best = int(free[pod].argmin()) if free.shape[1] else -1
        if best < 0 or math.isinf(free[pod, best]):
            status = Status.LIMIT if math.isfinite(bound) else Status.INFEASIBLE
            wall_s = perf_counter() - begin
            return Solution(None, math.inf, bound, status, "rule", wall_s, 0.0, float(free.size))
        place[pod] = best
        free[:, best] = math.inf
    value = objective(data, place)
    return Solution(
        place,
        value,
        min(bound, value),
        Status.FEASIBLE,
        "rule",
        perf_counter() - begin,
        0.0,
        float(cost_s.size),
    )
