"""The charging model, solved by CP-SAT."""

from __future__ import annotations

from rmfs.solvers.models.backends import cp_sat
from rmfs.solvers.models.backends.backend import solve_by, with_relaxed_bound
from rmfs.solvers.models.charging.data import ChargePlan, Charging
from rmfs.solvers.models.charging.program import formulate
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution


def solve(
    data: Charging,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: ChargePlan | None = None,
) -> Solution[ChargePlan]:
    """Find an optimal stay of each robot by constraint programming.

    Of the limits, `deterministic_s` and `gap` apply.
    """
    return solve_by(
        with_relaxed_bound(cp_sat.solve), lambda: formulate(data), limits, seed=seed, start=start
    )
