"""The best matching by linear assignment: a task is given a robot, or its own 'later'."""

from __future__ import annotations

import math
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from solvers.models.backends.assignment import Solver, assign
from solvers.models.solution import NO_LIMITS, Limits, Solution, Status
from solvers.models.tasks.matching.data import LEFT, Matching, objective


def solve(
    data: Matching,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: NDArray[np.int64] | None = None,
    solver: Solver = "scipy",
) -> Solution[NDArray[np.int64]]:
    """Find the robot of each task.

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
    The robot of each task, or `LEFT`, shape (T,); work in entries of the cost table.
    """
    begin = perf_counter()
    robots, tasks = data.travel_s.shape
    later = np.full((tasks, tasks), math.inf)
    np.fill_diagonal(later, data.leave_s)
    cost_s = np.hstack([data.travel_s.T, later])
    built = perf_counter()
    assigned = assign(cost_s, solver)
    wall_s, build_s = perf_counter() - begin, built - begin
    if assigned is None:
        work = float(cost_s.size)
        return Solution(None, math.inf, math.inf, Status.INFEASIBLE, solver, wall_s, build_s, work)
    robot = np.where(assigned.column < robots, assigned.column, LEFT)
    value = objective(data, robot)
    bound = min(assigned.bound, value)
    return Solution(robot, value, bound, Status.OPTIMAL, solver, wall_s, build_s, assigned.work)
