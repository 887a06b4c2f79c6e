"""The integer program for the zones of stays, solved by CP-SAT."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.backends import cp_sat
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
    """Find the optimal zone of each stay by CP-SAT.

    Of the limits, `deterministic_s` and `gap` apply.
    """
    return solve_by(
        cp_sat.solve, lambda: formulate(data, whole=True), limits, seed=seed, start=start
    )
