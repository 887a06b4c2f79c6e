"""What both back ends share: the relaxation's bound, rounded up to whole pods."""

from __future__ import annotations

import math
from dataclasses import replace

from solvers.models.backends.backend import Backend, solve_by, with_relaxed_bound
from solvers.models.rack_allocation.data import (
    Allocation,
    RackAllocation,
    objective,
    pods_needed,
    violations,
)
from solvers.models.rack_allocation.program import formulate
from solvers.models.solution import Limits, Solution

_TOLERANCE = 1e-4
"""What a bound may be above a whole number by rounding."""


def solve_with(
    backend: Backend, data: RackAllocation, limits: Limits, *, seed: int, start: Allocation | None
) -> Solution[Allocation]:
    """Solve the problem by a solver of integer programmes.

    Parameters
    ----------
    backend
        The solver.
    data
        The problem.
    limits, seed, start
        As the back ends say.

    Returns
    -------
    Who goes where, never worse than the start.

    Raises
    ------
    ModelError
        If the start is not feasible.
    """
    found = solve_by(
        with_relaxed_bound(backend),
        lambda: formulate(data),
        limits,
        seed=seed,
        start=start,
        objective=lambda values: objective(data, values),
        violations=lambda values: violations(data, values),
    )
    if math.isinf(found.bound):
        return found
    bound = max(float(math.ceil(found.bound - _TOLERANCE)), pods_needed(data))
    return replace(found, bound=bound)
