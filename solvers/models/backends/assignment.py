r"""The linear assignment problem for a cost table with at least as many columns as rows.

.. math::

    \min \sum_{ij} c_{ij} x_{ij}, \quad \sum_j x_{ij} = 1, \quad \sum_i x_{ij} \le 1

Dual: :math:`\max \sum_i u_i + \sum_j v_j` subject to :math:`u_i + v_j \le c_{ij}`,
:math:`v \le 0` (Burkard, Dell'Amico, Martello: Assignment Problems, chapter 4). With
:math:`u_i = \min_j (c_{ij} - v_j)`, every :math:`v \le 0` gives a lower bound. If v is derived from
an optimal assignment, the bound equals the minimum cost.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from time import perf_counter
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from rmfs.solvers.models.backends.flow import Network, min_cost_flow
from rmfs.solvers.models.solution import Solution, solution_of_optimum

Solver = Literal["scipy", "min_cost_flow"]
"""Shortest augmenting paths on real costs (SciPy), or cost scaling on integers (OR-Tools)."""

_TINY = 2.0**-50
"""Upper bound on the relative rounding error of a sum of two numbers, with a safety margin."""


class Assigned(NamedTuple):
    """An optimal assignment of columns to rows.

    Attributes
    ----------
    column
        Column of each row, shape (M,).
    bound
        Proven lower bound on the cost of every assignment.
    work
        Deterministic work: the number of entries of the cost table, plus the number of comparisons
        made to compute the bound.
    """

    column: NDArray[np.int64]
    bound: float
    work: float


def assign(cost: NDArray[np.float64], solver: Solver = "scipy") -> Assigned | None:
    """Assign each row a different column at minimum total cost.

    Parameters
    ----------
    cost
        Cost of each pair of row and column, shape (M, N); +inf forbids a pair.
    solver
        Algorithm: `scipy` or `min_cost_flow`. Default `scipy`.

    Returns
    -------
    An optimal assignment, or None if every assignment contains a forbidden pair.
    """
    rows, columns = cost.shape
    if rows > columns:
        return None
    if not rows:
        return Assigned(np.zeros(0, np.int64), 0.0, 0.0)
    column = _by_scipy(cost) if solver == "scipy" else _by_flow(cost)
    if column is None:
        return None
    bound, compared = _dual(cost, column)
    return Assigned(column, bound, float(cost.size + compared))


def solve_by_assignment(
    table: Callable[[], NDArray[np.float64]],
    read: Callable[[NDArray[np.int64]], NDArray[np.int64]],
    objective: Callable[[NDArray[np.int64]], float],
    solver: Solver,
) -> Solution[NDArray[np.int64]]:
    """Solve a model that is a linear assignment problem.

    Parameters
    ----------
    table
        Function that returns the cost table; the time it takes counts as building time.
    read
        Function that turns an assignment (an array with the column of each row) into the model's
        values.
    objective
        Objective function of the model.
    solver
        Algorithm, as for `assign`.

    Returns
    -------
    The optimal values, with the work of `Assigned`. If there is no assignment, the status is
    INFEASIBLE, and the work is the number of entries of the cost table.
    """
    began = perf_counter()
    cost = table()
    built = perf_counter()
    assigned = assign(cost, solver)
    return solution_of_optimum(
        None if assigned is None else read(assigned.column),
        objective,
        bound=math.inf if assigned is None else assigned.bound,
        backend=solver,
        work=float(cost.size) if assigned is None else assigned.work,
        began=began,
        built=built,
    )


def assignment_bound(cost: NDArray[np.float64], column: NDArray[np.int64]) -> float:
    """Return a lower bound on the cost of every assignment, derived from a given assignment.

    The price v of an assigned column is the length of the shortest alternating path that ends at
    this column, computed by the Bellman-Ford algorithm; it is 0 or negative. All other columns have
    the price 0. The bound is valid for any given assignment. If the given assignment is optimal,
    the bound equals the minimum cost (up to rounding).

    Parameters
    ----------
    cost
        Cost of each pair of row and column, shape (M, N); +inf forbids a pair.
    column
        Column of each row in the given assignment, shape (M,).

    Returns
    -------
    The dual objective at these prices, lowered by an allowance for rounding errors.
    """
    return _dual(cost, column)[0]


def _dual(cost: NDArray[np.float64], column: NDArray[np.int64]) -> tuple[float, int]:
    """Return the bound of `assignment_bound` and the number of entries compared for it."""
    rows = len(column)
    if not rows:
        return 0.0, 0
    price = np.zeros(cost.shape[1])
    exchange = cost[:, column] - cost[np.arange(rows), column][:, np.newaxis]
    shortest = np.zeros(rows)
    rounds = 0
    while rounds < rows:
        rounds += 1
        shorter = np.minimum(shortest, (shortest[:, np.newaxis] + exchange).min(axis=0))
        if np.array_equal(shorter, shortest):
            break
        shortest = shorter
    price[column] = shortest
    value = (cost - price).min(axis=1)
    error = _TINY * (math.fsum(np.abs(value)) + math.fsum(np.abs(price)))
    return math.fsum(value) + math.fsum(price) - error, rounds * exchange.size


def _by_scipy(cost: NDArray[np.float64]) -> NDArray[np.int64] | None:
    try:
        _, column = linear_sum_assignment(cost)
    except ValueError:  # SciPy's word for "infeasible"
        return None
    return np.asarray(column, np.int64)


def _by_flow(cost: NDArray[np.float64]) -> NDArray[np.int64] | None:
    """Solve by a flow of one unit from every row through a column to a sink."""
    rows, columns = cost.shape
    row, column = np.nonzero(np.isfinite(cost))
    sink = rows + columns
    supply = np.zeros(sink + 1, np.int64)
    supply[:rows] = 1
    supply[sink] = -rows
    network = Network(
        tail=np.concatenate([row, np.arange(rows, sink)]),
        head=np.concatenate([row * 0 + rows + column, np.full(columns, sink)]),
        capacity=np.ones(len(row) + columns, np.int64),
        cost=np.concatenate([cost[row, column], np.zeros(columns)]),
        supply=supply,
    )
    flow = min_cost_flow(network)
    if flow is None:
        return None
    used = np.flatnonzero(flow.units[: len(row)])
    chosen = np.empty(rows, np.int64)
    chosen[row[used]] = column[used]
    return chosen
