"""The integer program for the zones of stays, solved by HiGHS."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.backends import highs
from rmfs.solvers.models.backends.backend import solve_by
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution
from rmfs.solvers.models.storage.stays.data import Stays
from rmfs.solvers.models.storage.stays.program import formulate


def solve(
    data: Stays,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: NDArray[np.int64] | None = None,
) -> Solution[NDArray[np.int64]]:
    """Find the optimal zone of each stay by branch and bound.

    Of the limits, `nodes` and `gap` apply.
    """
    return solve_by(
        highs.solve, lambda: formulate(data, whole=False), limits, seed=seed, start=start
    )
