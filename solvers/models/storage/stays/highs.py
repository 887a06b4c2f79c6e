"""The interval model by HiGHS, limited by nodes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from solvers.models.backends import highs
from solvers.models.backends.backend import solve_by
from solvers.models.solution import NO_LIMITS, Limits, Solution
from solvers.models.storage.stays.data import Stays, objective, violations
from solvers.models.storage.stays.program import formulate


def solve(
    data: Stays,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: NDArray[np.int64] | None = None,
) -> Solution[NDArray[np.int64]]:
    """Find the zone of each stay by branch and bound.

    Parameters
    ----------
    data
        The problem.
    limits
        `nodes` and `gap`. Default: to optimality.
    seed
        Seed of the solver. Default 0.
    start
        A feasible choice of zones to start from, shape (S,). Default: none.

    Returns
    -------
    The zone of each stay, shape (S,).

    Raises
    ------
    ModelError
        If the start is not feasible.
    """
    return solve_by(
        highs.solve,
        lambda: formulate(data, whole=False),
        limits,
        seed=seed,
        start=start,
        objective=lambda values: objective(data, values),
        violations=lambda values: violations(data, values),
    )
