"""The optimal matching by OR-Tools' minimum-cost flow."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution
from rmfs.solvers.models.tasks.matching.assignment import solve_by
from rmfs.solvers.models.tasks.matching.data import Matching


def solve(
    data: Matching,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: NDArray[np.int64] | None = None,
) -> Solution[NDArray[np.int64]]:
    """Find the optimal matching by OR-Tools' cost-scaling algorithm, on integer costs.

    The values of the solution are the robot of each task, or `LEFT` if the task is left for later.
    """
    return solve_by(data, "min_cost_flow")
