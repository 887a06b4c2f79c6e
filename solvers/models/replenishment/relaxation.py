"""The programme without whole numbers: solved in a fraction of the time, and tight."""

from __future__ import annotations

import dataclasses

import numpy as np

from solvers.models.backends import Outcome, highs
from solvers.models.program import LinearProgram
from solvers.models.solution import NO_LIMITS, Limits


def relax(linear: LinearProgram, limits: Limits = NO_LIMITS, *, seed: int = 0) -> Outcome:
    """Solve the relaxation of a programme; its bound is one for the programme.

    Parameters
    ----------
    linear
        The programme.
    limits
        `iterations` of the simplex. Default: none.
    seed
        Seed of the solver. Default 0.
    """
    relaxed = dataclasses.replace(linear, integer=np.zeros(linear.columns, bool))
    return highs.solve(relaxed, limits, seed=seed)
