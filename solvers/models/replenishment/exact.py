"""Replenishment as an integer programme, by CP-SAT or by HiGHS."""

from __future__ import annotations

from rmfs.solvers.models.backends import cp_sat, highs
from rmfs.solvers.models.backends.backend import Backend, solve_by, with_relaxed_bound
from rmfs.solvers.models.replenishment.data import Replenishment, Stocking, objective, violations
from rmfs.solvers.models.replenishment.program import formulate
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution


def solve_by_cp_sat(
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
    Where bundles and pods go. The bound is at least that of the relaxation.

    Raises
    ------
    ModelError
        If the start is not feasible.
    """
    return _solve(cp_sat.solve, data, limits, seed, start, whole=True)


def solve_by_highs(
    data: Replenishment,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Stocking | None = None,
) -> Solution[Stocking]:
    """Do the same as `solve_by_cp_sat` by branch and bound, limited by `nodes` and `gap`."""
    return _solve(highs.solve, data, limits, seed, start, whole=False)


def _solve(
    backend: Backend,
    data: Replenishment,
    limits: Limits,
    seed: int,
    start: Stocking | None,
    *,
    whole: bool,
) -> Solution[Stocking]:
    return solve_by(
        with_relaxed_bound(backend),
        lambda: formulate(data, whole=whole),
        limits,
        seed=seed,
        start=start,
        objective=lambda values: objective(data, values),
        violations=lambda values: violations(data, values),
    )
