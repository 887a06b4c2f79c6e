"""Rack allocation by HiGHS, limited by nodes."""

from __future__ import annotations

from solvers.models.backends import highs
from solvers.models.rack_allocation.data import Allocation, RackAllocation
from solvers.models.rack_allocation.exact import solve_with
from solvers.models.solution import NO_LIMITS, Limits, Solution


def solve(
    data: RackAllocation,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Allocation | None = None,
) -> Solution[Allocation]:
    """Find the fewest pods by branch and bound.

    Parameters
    ----------
    data
        The problem.
    limits
        `nodes` and `gap`. Default: to optimality.
    seed
        Seed of the solver. Default 0.
    start
        A feasible allocation to start from. Default: none.

    Returns
    -------
    Who goes where. The bound is at least that of the relaxation over all stations together.

    Raises
    ------
    ModelError
        If the start is not feasible.
    """
    return solve_with(highs.solve, data, limits, seed=seed, start=start)
