"""A lower bound on the number of late orders that holds for every controller.

An order is on time only if all its units are handled between its arrival and its due time. Each
station handles units one after the other. The bound considers intervals of time: of the orders that
both arrive and are due in an interval, those on time cannot need more work than all stations
together can do in the interval. The bound assumes that every pod is at any station as soon as it is
needed, that all SKUs are in stock, and that orders can be split over stations.
"""

from __future__ import annotations

from math import ceil
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import linprog

if TYPE_CHECKING:
    from numpy.typing import NDArray

_HAIR = 1e-6


def fewest_late(
    released_s: NDArray[np.float64],
    due_s: NDArray[np.float64],
    work_s: NDArray[np.float64],
    stations: int,
) -> int:
    """Return a lower bound on the number of late orders.

    A linear program maximises the number of orders on time; all other orders are late. It has one
    constraint for each interval from an arrival to a due time: the total work of those orders on
    time that both arrive and are due in the interval must not exceed the length of the interval
    times the number of stations.

    Parameters
    ----------
    released_s, due_s
        Arrival and due time of each order, shape (N,), in s.
    work_s
        Total time that each order needs at stations, shape (N,), in s.
    stations
        Number of stations.

    Raises
    ------
    RuntimeError
        If the linear program cannot be solved.
    """
    count = len(released_s)
    if not count:
        return 0
    rows, limits = [], []
    for start_s in np.unique(released_s):
        for end_s in np.unique(due_s[due_s >= start_s]):
            inside = (released_s >= start_s) & (due_s <= end_s)
            limit = stations * (end_s - start_s)
            if (work_s * inside).sum() > limit:
                rows.append(work_s * inside)
                limits.append(limit)
    if not rows:
        return 0
    solved = linprog(-np.ones(count), A_ub=np.array(rows), b_ub=limits, bounds=(0.0, 1.0))
    if not solved.success or solved.fun is None:
        raise RuntimeError(f"bound on late orders: {solved.message}")
    return max(ceil(count + solved.fun - _HAIR), 0)
