r"""Minimum-cost flow with supplies on nodes and capacities on arcs.

.. math::

    \min \sum_a c_a f_a, \quad 0 \le f_a \le q_a, \quad
    \sum_{a \text{ out of } v} f_a - \sum_{a \text{ into } v} f_a = b_v

Here :math:`f_a` is the flow on arc a, :math:`c_a` its cost per unit, :math:`q_a` the capacity of
the arc, and :math:`b_v` the supply of node v. For any node potentials :math:`\pi`, a lower bound on
the cost is (Ahuja, Magnanti, Orlin: Network Flows, section 9.4)

.. math::

    \sum_a q_a \min(0,\; c_a + \pi_{tail(a)} - \pi_{head(a)}) - \sum_v b_v \pi_v.

If the potentials are the shortest distances in the residual network of an optimal flow, the bound
equals the cost of this flow.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from ortools.graph.python import min_cost_flow as ortools_flow  # type: ignore[import-untyped]

_LARGEST_COST = 2.0**40
"""Largest integer cost passed to OR-Tools, which multiplies costs by the number of nodes."""

_FINEST = 1e6
"""Maximum resolution of costs, in parts of a unit; finer if no cost reaches a unit."""

_TINY = 2.0**-50


@dataclass(frozen=True)
class Network:
    """A directed graph with costs.

    Parameters
    ----------
    tail, head
        Start node and end node of each arc, shape (A,).
    capacity
        Maximum number of units on each arc, shape (A,).
    cost
        Cost per unit on each arc, shape (A,); finite, may be negative.
    supply
        Units that enter the network at each node, shape (V,); negative if units leave it there.
        The sum over all nodes must be 0.
    """

    tail: NDArray[np.int64]
    head: NDArray[np.int64]
    capacity: NDArray[np.int64]
    cost: NDArray[np.float64]
    supply: NDArray[np.int64]


class Flow(NamedTuple):
    """A minimum-cost flow.

    Attributes
    ----------
    units
        Units on each arc, shape (A,).
    bound
        Proven lower bound on the cost of every flow.
    work
        Deterministic work: the number of arcs of the network.
    """

    units: NDArray[np.int64]
    bound: float
    work: float


def min_cost_flow(network: Network) -> Flow | None:
    """Find a minimum-cost flow with OR-Tools' cost-scaling push-relabel algorithm.

    Costs are rounded to millionths (of the largest cost if it is below 1), or more coarsely if a
    cost exceeds about a million. The solver is exact for the rounded costs; the bound is valid for
    the unrounded ones, and shows what rounding may have cost.

    Parameters
    ----------
    network
        The graph, its costs and supplies.

    Returns
    -------
    A minimum-cost flow, or None if no flow meets all supplies.
    """
    if not len(network.tail):
        feasible = not network.supply.any()
        return Flow(np.zeros(0, np.int64), 0.0, 0.0) if feasible else None
    largest = float(np.abs(network.cost).max())
    scale = min(_FINEST / min(largest, 1.0), _LARGEST_COST / largest) if largest else 1.0
    whole = np.rint(network.cost * scale).astype(np.int64)
    solver = ortools_flow.SimpleMinCostFlow()
    arcs = solver.add_arcs_with_capacity_and_unit_cost(
        network.tail.astype(np.int32), network.head.astype(np.int32), network.capacity, whole
    )
    solver.set_nodes_supplies(np.arange(len(network.supply), dtype=np.int32), network.supply)
    status = solver.solve()
    if status == solver.INFEASIBLE:
        return None
    if status != solver.OPTIMAL:
        raise RuntimeError(f"OR-Tools ended a minimum-cost flow with {status}")
    units = np.asarray(solver.flows(arcs), np.int64)
    potential = _distances(network, units, whole) / scale
    return Flow(units, flow_bound(network, potential), float(len(network.tail)))


def flow_bound(network: Network, potential: NDArray[np.float64]) -> float:
    """Return a lower bound on the cost of every flow; any potentials give a valid bound.

    Parameters
    ----------
    network
        The graph, its costs and supplies.
    potential
        Potential of each node, shape (V,); optimal dual values make the bound tight.

    Returns
    -------
    The dual objective at these potentials, lowered by an allowance for rounding errors.
    """
    tail, head = potential[network.tail], potential[network.head]
    saved = np.minimum(0.0, network.cost + tail - head) * network.capacity
    given = network.supply * potential
    size = (np.abs(network.cost) + np.abs(tail) + np.abs(head)) * network.capacity
    error = _TINY * (math.fsum(size) + math.fsum(np.abs(given)))
    return math.fsum(saved) - math.fsum(given) - error


def _distances(
    network: Network, units: NDArray[np.int64], whole: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Return each node's shortest distance in the residual network from any node (Bellman-Ford)."""
    forward, backward = units < network.capacity, units > 0
    tail = np.concatenate([network.tail[forward], network.head[backward]])
    head = np.concatenate([network.head[forward], network.tail[backward]])
    length = np.concatenate([whole[forward], -whole[backward]])
    # arcs grouped by their head, so that one reduction finds the shortest way into each
    order = np.argsort(head, kind="stable")
    tail, head, length = tail[order], head[order], length[order]
    reached, first = np.unique(head, return_index=True)
    distance = np.zeros(len(network.supply), np.int64)
    for _ in range(len(distance)):
        shorter = np.minimum(distance[reached], np.minimum.reduceat(distance[tail] + length, first))
        if np.array_equal(shorter, distance[reached]):
            break
        distance[reached] = shorter
    return distance.astype(np.float64)
