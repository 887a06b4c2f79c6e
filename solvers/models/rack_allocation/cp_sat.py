"""Rack allocation, solved by CP-SAT."""

from __future__ import annotations

from functools import partial

from rmfs.solvers.models.backends import cp_sat
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
    """Find an allocation with the fewest pods by constraint programming.

    Of the limits, `deterministic_s` and `gap` apply.
    """
    # presolving takes longer than it saves, and is hardly counted as work
    return solve_in_whole_pods(partial(cp_sat.solve, presolve=False), data, limits, seed, start)
