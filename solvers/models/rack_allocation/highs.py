"""Rack allocation, solved by HiGHS."""

from __future__ import annotations

from rmfs.solvers.models.backends import highs
from rmfs.solvers.models.rack_allocation.bound import solve_in_whole_pods
from rmfs.solvers.models.rack_allocation.data import Allocation, RackAllocation
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution


def solve(
    data: RackAllocation,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Allocation | None = None,
) -> Solution[Allocation]:
    """Find an allocation with the fewest pods by branch and bound.

    Of the limits, `nodes` and `gap` apply.
    """
    return solve_in_whole_pods(highs.solve, data, limits, seed, start)
