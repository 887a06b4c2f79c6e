"""A lower bound computed from row multipliers, valid even if the multipliers are inexact.

For a program ``min c·x, row_lower <= A x <= row_upper, lower <= x <= upper`` and any row
multipliers y, weak duality over the box gives

    c·x = y·(A x) + (c - A'y)·x >= sum_i min(y_i row_lower_i, y_i row_upper_i)
                                   + sum_j min(r_j lower_j, r_j upper_j),   r = c - A'y

A multiplier whose sign refers to an absent (infinite) row bound is set to 0 first, which makes the
dual feasible. An a-priori bound on the rounding errors of the sums and products is subtracted from
the result. (Neumaier and Shcherbina 2004, Safe bounds in linear and mixed-integer linear
programming, Math. Program. 99.)
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.program import LinearProgram

_UNIT = float(np.finfo(np.float64).eps)


def safe_bound(program: LinearProgram, multipliers: NDArray[np.float64]) -> float:
    """Return a lower bound on the objective of a program, computed from row multipliers.

    Parameters
    ----------
    program
        The program. The bound is valid for this program and for its linear relaxation.
    multipliers
        Multiplier of each row, positive where the row's lower bound is binding. Any values give a
        valid bound; optimal dual values give a tight one.

    Returns
    -------
    The bound, including the offset, lowered by an allowance for rounding errors.
    """
    y = np.where(np.isfinite(multipliers), multipliers, 0.0)
    y = np.where((y > 0) & np.isinf(program.row_lower), 0.0, y)
    y = np.where((y < 0) & np.isinf(program.row_upper), 0.0, y)
    side = np.where(y > 0, program.row_lower, program.row_upper)
    # A zero multiplier may face two infinite sides; its product is 0, not a NaN.
    rows = y * np.where(y == 0, 0.0, side)
    transposed = program.matrix.T
    reduced = program.cost - np.asarray(transposed @ y)
    # |error of r_j| <= (terms of the sum) * unit * (sum of their magnitudes).
    terms = np.bincount(program.column, minlength=program.columns) + 2.0
    size = np.abs(program.cost) + np.asarray(abs(transposed) @ np.abs(y))
    wrong = terms * _UNIT * size
    reach = np.maximum(np.abs(program.lower), np.abs(program.upper))
    boxes = np.minimum(reduced * program.lower, reduced * program.upper)
    total = float(rows.sum() + boxes.sum() + program.offset)
    magnitude = float(np.abs(rows).sum() + np.abs(boxes).sum() + abs(program.offset))
    summing = (program.rows + program.columns + 4.0) * _UNIT * magnitude
    return float(np.nextafter(total - summing - float((wrong * reach).sum()), -np.inf))
