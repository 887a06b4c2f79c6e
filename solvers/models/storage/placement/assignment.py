"""The optimal placement by linear assignment."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.backends.assignment import Solver, solve_by_assignment
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution
from rmfs.solvers.models.storage.placement.data import Placement, objective


def solve(
    data: Placement,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: NDArray[np.int64] | None = None,
) -> Solution[NDArray[np.int64]]:
    """Find the optimal place of each pod by SciPy's shortest augmenting path algorithm."""
    return solve_by(data, "scipy")


def solve_by(data: Placement, solver: Solver) -> Solution[NDArray[np.int64]]:
    """Find the placement with the least robot time, using the given assignment solver.

    Parameters
    ----------
    data
        The problem.
    solver
        Name of the solver of assignment problems.

    Returns
    -------
    The place of each pod, shape (P,). Work is the number of cost table entries examined, both for
    the assignment and for its bound.
    """
    return solve_by_assignment(
        lambda: data.cost_s, lambda column: column, lambda place: objective(data, place), solver
    )
