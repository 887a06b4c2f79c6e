"""Choice of one place for each stay within its zone; no two stays share a place at any time."""

from __future__ import annotations

import heapq

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.checks import require
from rmfs.solvers.models.storage.stays.data import Stays, violations


def places(data: Stays, zone: NDArray[np.int64]) -> NDArray[np.int64]:
    """Give every stay the lowest-numbered place of its zone that is free when the stay begins.

    Places of a zone are numbered from 0. As stays are processed in the order in which they begin,
    a zone needs only as many places as it has stays at the same time (interval colouring).

    Parameters
    ----------
    data
        The problem.
    zone
        Zone of each stay, shape (S,).

    Returns
    -------
    Place of each stay within its zone, shape (S,).

    Raises
    ------
    ModelError
        If the choice of zones is not feasible.
    """
    broken = violations(data, zone)
    require(not broken, "zone", "; ".join(broken))
    place = np.full(len(zone), -1, np.int64)
    free = [list(range(count)) for count in data.capacity.tolist()]
    taken: list[list[tuple[float, int]]] = [[] for _ in free]
    for stay in np.argsort(data.begin_s, kind="stable").tolist():
        own = int(zone[stay])
        while taken[own] and taken[own][0][0] <= data.begin_s[stay]:
            heapq.heappush(free[own], heapq.heappop(taken[own])[1])
        place[stay] = heapq.heappop(free[own])
        heapq.heappush(taken[own], (float(data.end_s[stay]), int(place[stay])))
    return place
