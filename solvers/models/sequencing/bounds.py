"""A lower bound on the number of visits.

The visiting pods together hold all needed SKUs. So there are at least as many visits as there are
pods in the smallest set that holds all these SKUs (a minimum cover). The dual value of the linear
relaxation of this covering problem (`safe_bound`), rounded up to a whole number, is a lower bound
on the size of that set.
"""

from __future__ import annotations

import math

import numpy as np

from rmfs.solvers.models.backends import highs
from rmfs.solvers.models.program import LinearProgram, ProgramBuilder
from rmfs.solvers.models.sequencing.data import Sequencing


def covering(data: Sequencing) -> LinearProgram:
    """Formulate the covering problem: the fewest pods that together hold all needed SKUs.

    Parameters
    ----------
    data
        The input, which must be feasible.
    """
    builder = ProgramBuilder()
    pods = builder.columns(data.pods, cost=1.0)
    skus = np.flatnonzero(data.needs.any(axis=0))
    row, pod = np.nonzero(data.holds[:, skus].T)
    builder.rows(skus.size, (row, pods[pod], 1), lower=1)
    return builder.build()


def visits_bound(data: Sequencing) -> float:
    """Return a lower bound on the number of visits of every plan; +inf if no plan is feasible.

    Parameters
    ----------
    data
        The input.
    """
    if not data.feasible:
        return math.inf
    if not data.orders:
        return 0.0
    bound = highs.relax(covering(data)).bound
    return max(1.0, math.ceil(bound - 1e-6))
