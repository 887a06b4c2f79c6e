r"""Stays in two zones as a minimum-cost flow: an optimal solution at any size.

With two zones, a stay that is not in zone 0 is in zone 1. Each of the :math:`k_0` places of zone 0
is a unit of flow through the periods: from one period to the next, the unit waits (the place is
empty), or it follows the arc of a stay. A stay in zone 0 saves :math:`c_{s1} - c_{s0}`. Of the
:math:`present_t` stays present in period t, at most :math:`k_1` fit into zone 1, so at most
:math:`k_0 - (present_t - k_1)^+` units may wait in period t. For a stay that must be in zone 0, a
unit leaves the flow when the stay begins and returns when the stay ends. (Carlisle and Lloyd 1995
solve the k-colouring of intervals as such a flow; the limit on waiting is added here.)
"""

from __future__ import annotations

import math
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.backends.flow import Network, min_cost_flow
from rmfs.solvers.models.checks import require
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, solution_of_optimum
from rmfs.solvers.models.storage.stays.data import Stays, objective


def solve(
    data: Stays,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: NDArray[np.int64] | None = None,
) -> Solution[NDArray[np.int64]]:
    """Find the optimal zone of each stay in a problem with two zones.

    Parameters
    ----------
    data
        The problem, with two zones.
    limits, seed, start
        Not used.

    Returns
    -------
    The zone of each stay, shape (S,). Work is the number of arcs of the network.

    Raises
    ------
    ModelError
        If the number of zones is not two.
    """
    require(len(data.capacity) == 2, "capacity", f"must have two zones, has {len(data.capacity)}")
    begin = perf_counter()
    near, far = data.cost_s.T
    forced_near, forced_far = np.isinf(far), np.isinf(near)
    network, free = _network(data, forced_near, forced_far)
    built = perf_counter()
    flow = None
    if not (forced_near & forced_far).any() and (network.capacity >= 0).all():
        flow = min_cost_flow(network)
    zone = None
    if flow is not None:
        zone = np.ones(len(near), np.int64)
        zone[forced_near] = 0
        zone[free[flow.units[len(flow.units) - len(free) :] > 0]] = 0
    fixed = math.fsum(near[forced_near]) + math.fsum(far[~forced_near])
    return solution_of_optimum(
        zone,
        lambda values: objective(data, values),
        bound=math.inf if flow is None else fixed + flow.bound,
        backend="min_cost_flow",
        work=0.0 if flow is None else flow.work,
        began=begin,
        built=built,
    )


def _network(
    data: Stays, forced_near: NDArray[np.bool_], forced_far: NDArray[np.bool_]
) -> tuple[Network, NDArray[np.int64]]:
    """Build the network of the flow.

    Returns
    -------
    The network, in which the arcs for waiting come before those of stays; and the stays that have
    an arc, in the sequence of the arcs.
    """
    first, last, periods = data.periods
    near_places, far_places = data.capacity.tolist()
    everywhere = np.zeros(len(first), np.int64)
    overflow = np.maximum(0, data.present(everywhere, 0) - far_places)
    free = np.flatnonzero(~forced_near & ~forced_far)
    supply = np.zeros(periods + 1, np.int64)
    supply[0] += near_places
    supply[periods] -= near_places
    np.add.at(supply, first[forced_near], -1)
    np.add.at(supply, last[forced_near], 1)
    saved = data.cost_s[free, 0] - data.cost_s[free, 1]
    return (
        Network(
            tail=np.concatenate([np.arange(periods), first[free]]),
            head=np.concatenate([np.arange(1, periods + 1), last[free]]),
            capacity=np.concatenate([near_places - overflow, np.ones(len(free), np.int64)]),
            cost=np.concatenate([np.zeros(periods), saved]),
            supply=supply,
        ),
        free,
    )
