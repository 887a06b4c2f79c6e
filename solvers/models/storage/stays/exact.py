"""The interval model as an integer programme, by CP-SAT or by HiGHS."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.backends import cp_sat, highs
from rmfs.solvers.models.backends.backend import Backend, solve_by
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution
from rmfs.solvers.models.storage.stays.data import Stays, objective, violations
from rmfs.solvers.models.storage.stays.program import formulate


def solve_by_cp_sat(
    data: Stays,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: NDArray[np.int64] | None = None,
) -> Solution[NDArray[np.int64]]:
    """Find the zone of each stay by constraint programming.

    Parameters
    ----------
    data
        The problem.
    limits
        `deterministic_s` and `gap`. Default: to optimality.
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
    return _solve(cp_sat.solve, data, limits, seed, start, whole=True)


def solve_by_highs(
    data: Stays,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: NDArray[np.int64] | None = None,
) -> Solution[NDArray[np.int64]]:
    """Do the same as `solve_by_cp_sat` by branch and bound, limited by `nodes` and `gap`."""
    return _solve(highs.solve, data, limits, seed, start, whole=False)


def _solve(
    backend: Backend,
    data: Stays,
    limits: Limits,
    seed: int,
    start: NDArray[np.int64] | None,
    *,
    whole: bool,
) -> Solution[NDArray[np.int64]]:
    return solve_by(
        backend,
        lambda: formulate(data, whole=whole),
        limits,
        seed=seed,
        start=start,
        objective=lambda values: objective(data, values),
        violations=lambda values: violations(data, values),
    )
