"""Rack allocation by CP-SAT, limited by deterministic time."""

from __future__ import annotations

from solvers.models.backends import cp_sat
from solvers.models.backends.backend import solve_by, with_relaxed_bound
from solvers.models.rack_allocation.data import Allocation, RackAllocation, objective, violations
from solvers.models.rack_allocation.program import formulate
from solvers.models.solution import NO_LIMITS, Limits, Solution


def solve(
    data: RackAllocation,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Allocation | None = None,
) -> Solution[Allocation]:
    """Find the fewest pods by constraint programming.

    Parameters
    ----------
    data
        The problem.
    limits
        `deterministic_s` and `gap`. Default: to optimality.
    seed
        Seed of the solver. Default 0.
    start
        A feasible allocation to start from. Default: none.

    Returns
    -------
    Who goes where. The bound is at least that of the relaxation.

    Raises
    ------
    ModelError
        If the start is not feasible.
    """
    return solve_by(
        with_relaxed_bound(cp_sat.solve),
        lambda: formulate(data),
        limits,
        seed=seed,
        start=start,
        objective=lambda values: objective(data, values),
        violations=lambda values: violations(data, values),
    )
