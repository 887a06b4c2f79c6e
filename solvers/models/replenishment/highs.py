"""Replenishment by HiGHS, limited by nodes."""

from __future__ import annotations

from solvers.models.backends import highs
from solvers.models.backends.backend import solve_by, with_relaxed_bound
from solvers.models.replenishment.data import Replenishment, Stocking, objective, violations
from solvers.models.replenishment.program import formulate
from solvers.models.solution import NO_LIMITS, Limits, Solution


def solve(
    data: Replenishment,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Stocking | None = None,
) -> Solution[Stocking]:
    """Choose pods and stations for bundles by branch and bound.

    Parameters
    ----------
    data
        The problem.
    limits
        `nodes` and `gap`. Default: to optimality.
    seed
        Seed of the solver. Default 0.
    start
        A feasible stocking to start from. Default: none.

    Returns
    -------
    Where bundles and pods go. The bound is at least that of the relaxation.

    Raises
    ------
    ModelError
        If the start is not feasible.
    """
    return solve_by(
        with_relaxed_bound(highs.solve),
        lambda: formulate(data, whole=False),
        limits,
        seed=seed,
        start=start,
        objective=lambda values: objective(data, values),
        violations=lambda values: violations(data, values),
    )
