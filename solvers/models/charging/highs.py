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
    """Find the stay of each robot by branch and bound; of the limits, `nodes` and `gap` apply."""
    return solve_by(highs.solve, lambda: formulate(data), limits, seed=seed, start=start)
