"""The optimal placement by OR-Tools' minimum-cost flow."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution
from rmfs.solvers.models.storage.placement.assignment import solve_by
from rmfs.solvers.models.storage.placement.data import Placement


def solve(
    data: Placement,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: NDArray[np.int64] | None = None,
) -> Solution[NDArray[np.int64]]:
    """Find the optimal place of each pod by OR-Tools' cost-scaling algorithm, on integer costs."""
    return solve_by(data, "min_cost_flow")
