"""The charging model, solved by HiGHS."""

from __future__ import annotations

from rmfs.solvers.models.backends import highs
from rmfs.solvers.models.backends.backend import solve_by
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
    """Find an optimal stay of each robot by branch and bound; the limits are `nodes` and `gap`."""
    return solve_by(highs.solve, lambda: formulate(data), limits, seed=seed, start=start)
