"""Rack allocation by a solver, with a lower bound that is a whole number of pods."""

from __future__ import annotations

import math
from dataclasses import replace

from rmfs.solvers.models.backends.backend import Backend, relax, solve_by
from rmfs.solvers.models.rack_allocation.data import Allocation, RackAllocation, pods_needed
from rmfs.solvers.models.rack_allocation.program import formulate, together
from rmfs.solvers.models.solution import Limits, Solution, Status

_TOLERANCE = 1e-4
"""Amount by which rounding may raise a bound above a whole number."""


def solve_in_whole_pods(
    backend: Backend, data: RackAllocation, limits: Limits, seed: int, start: Allocation | None
) -> Solution[Allocation]:
    """Solve the integer program; the bound is a whole number of pods.

    This bound is the greatest of three: the solver's bound, rounded up; the bound of the relaxation
    `together`, rounded up; and `pods_needed`.

    Parameters
    ----------
    backend
        The solver.
    data
        The problem.
    limits, seed
        As for the back end.
    start
        A feasible allocation to start from, or None.

    Returns
    -------
    The allocation, never worse than the start. The status is INFEASIBLE if the solver or the
    relaxation `together` proves that there is none.
    """
    found = solve_by(backend, lambda: formulate(data), limits, seed=seed, start=start)
    if found.status is Status.INFEASIBLE:
        return found
    relaxed = relax(together(data))
    if not found.found and relaxed.status is Status.INFEASIBLE:
        wall_s = found.wall_s + relaxed.wall_s
        return replace(found, bound=math.inf, status=Status.INFEASIBLE, wall_s=wall_s)
    bound = max(found.bound, relaxed.bound)
    whole = float(math.ceil(bound - _TOLERANCE)) if math.isfinite(bound) else 0.0
    proven = max(whole, pods_needed(data))
    if found.found and proven >= found.objective:
        found = replace(found, status=Status.OPTIMAL)
    return replace(found, bound=proven, wall_s=found.wall_s + relaxed.wall_s)
