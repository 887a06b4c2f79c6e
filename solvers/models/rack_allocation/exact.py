"""Rack allocation as an integer programme, by CP-SAT or by HiGHS.

Their bound is at least that of the relaxation over all stations together, rounded up to whole pods.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial

from rmfs.solvers.models.backends import cp_sat, highs
from rmfs.solvers.models.backends.backend import Backend, relax, solve_by
from rmfs.solvers.models.rack_allocation.data import (
    Allocation,
    RackAllocation,
    objective,
    pods_needed,
    violations,
)
from rmfs.solvers.models.rack_allocation.program import formulate, together
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, Status

_TOLERANCE = 1e-4
"""What a bound may be above a whole number by rounding."""


def solve_by_cp_sat(
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
    Who goes where, never worse than the start.

    Raises
    ------
    ModelError
        If the start is not feasible.
    """
    # presolving takes longer than it saves, and is hardly counted as work
    return _solve(partial(cp_sat.solve, presolve=False), data, limits, seed, start)


def solve_by_highs(
    data: RackAllocation,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Allocation | None = None,
) -> Solution[Allocation]:
    """Do the same as `solve_by_cp_sat` by branch and bound, limited by `nodes` and `gap`."""
    return _solve(highs.solve, data, limits, seed, start)


def _solve(
    backend: Backend, data: RackAllocation, limits: Limits, seed: int, start: Allocation | None
) -> Solution[Allocation]:
    found = solve_by(
        backend,
        lambda: formulate(data),
        limits,
        seed=seed,
        start=start,
        objective=lambda values: objective(data, values),
        violations=lambda values: violations(data, values),
    )
    if found.status is Status.INFEASIBLE:
        return found
    relaxed = relax(together(data))
    bound = max(found.bound, relaxed.bound)
    whole = float(math.ceil(bound - _TOLERANCE)) if math.isfinite(bound) else 0.0
    proven = max(whole, pods_needed(data))
    if found.found and proven >= found.objective:
        found = replace(found, status=Status.OPTIMAL)
    return replace(found, bound=proven, wall_s=found.wall_s + relaxed.wall_s)
