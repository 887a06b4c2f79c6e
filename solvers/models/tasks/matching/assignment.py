"""Optimal matching by linear assignment: each task gets a robot or is left for later."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.backends.assignment import Solver, solve_by_assignment
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution
from rmfs.solvers.models.tasks.matching.data import LEFT, Matching, objective


def solve(
    data: Matching,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: NDArray[np.int64] | None = None,
) -> Solution[NDArray[np.int64]]:
    """Find the optimal matching by SciPy's shortest augmenting path algorithm.

    The values of the solution are the robot of each task, or `LEFT` if the task is left for later.
    """
    return solve_by(data, "scipy")


def solve_by(data: Matching, solver: Solver) -> Solution[NDArray[np.int64]]:
    """Find the optimal matching by the given assignment solver.

    Parameters
    ----------
    data
        The problem.
    solver
        Name of the solver of assignment problems.

    Returns
    -------
    The robot of each task, or `LEFT` if the task is left for later, shape (T,). Work is the number
    of cost table entries examined, both for the assignment and for its bound.
    """
    robots, tasks = data.travel_s.shape

    def table() -> NDArray[np.float64]:
        """Cost of each robot for each task, then the cost of leaving each task on a diagonal."""
        later = np.full((tasks, tasks), math.inf)
        np.fill_diagonal(later, data.leave_s)
        return np.hstack([data.travel_s.T, later])

    return solve_by_assignment(
        table,
        lambda column: np.where(column < robots, column, LEFT),
        lambda robot: objective(data, robot),
        solver,
    )
