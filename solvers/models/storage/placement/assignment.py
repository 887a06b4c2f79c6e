"""The best placement by linear assignment."""

from __future__ import annotations

import math
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from solvers.models.backends.assignment import Solver, assign
from solvers.models.solution import NO_LIMITS, Limits, Solution, Status
from solvers.models.storage.placement.data import Placement, objective


def solve(
    data: Placement,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: NDArray[np.int64] | None = None,
    solver: Solver = "scipy",
) -> Solution[NDArray[np.int64]]:
    """Find the cheapest place of every pod.

    Parameters
    ----------
    data
        The problem.
    limits, seed, start
        Not needed: the algorithm is polynomial, deterministic and starts from nothing.
    solver
        Who solves it. Default: SciPy.

    Returns
    -------
    The place of each pod, shape (P,); work in entries of the cost table.
    """
    begin = perf_counter()
    cost_s = data.cost_s
    built = perf_counter()
    assigned = assign(cost_s, solver)
    wall_s, build_s = perf_counter() - begin, built - begin
    if assigned is None:
        return Solution(
            None, math.inf, math.inf, Status.INFEASIBLE, solver, wall_s, build_s, cost_s.size
        )
    value = objective(data, assigned.column)
    return Solution(
        assigned.column,
        value,
        min(assigned.bound, value),
        Status.OPTIMAL,
        solver,
        wall_s,
        build_s,
        assigned.work,
    )
