"""Replenishment by CP-SAT, limited by deterministic time."""

from __future__ import annotations

from solvers.models.backends import cp_sat
from solvers.models.replenishment.backend import solve_by
from solvers.models.replenishment.data import Replenishment, Stocking
from solvers.models.solution import NO_LIMITS, Limits, Solution


def solve(
    data: Replenishment,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Stocking | None = None,
) -> Solution[Stocking]:
    """Choose pods and stations for bundles by constraint programming.

    Parameters
    ----------
    data
        The problem.
    limits
        `deterministic_s` and `gap`. Default: to optimality.
    seed
        Seed of the solver. Default 0.
    start
        A feasible stocking to start from. Default: none.

    Returns
    -------
    Where bundles and pods go.

    Raises
    ------
    ModelError
        If the start is not feasible.
    """
    return solve_by(cp_sat.solve, data, limits, seed, start, whole=True)
