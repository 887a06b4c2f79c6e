r"""Rack allocation as an integer program.

Two additions to the program of the module `data` make its relaxation tighter without cutting off
any allocation. No station needs more of SKU k than the sum :math:`d_{sk}` of the :math:`C_s`
largest order lines of that SKU, so

.. math:: \sum_p \min(stock_{pk}, d_{sk})\, y_{ps} \ge \sum_o units_{ok}\, x_{os};

and each SKU k of an order must be on at least one pod at the order's station: :math:`x_{os} \le
\sum_{p \ni k} y_{ps}`. An order has no columns if it asks for more units of a SKU than all pods
together hold. A pod has no columns if it holds no SKU of the remaining orders.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.backends.backend import Formulation
from rmfs.solvers.models.names import Names
from rmfs.solvers.models.program import LinearProgram, ProgramBuilder
from rmfs.solvers.models.rack_allocation.data import (
    NONE,
    Allocation,
    RackAllocation,
    objective,
    violations,
)


def formulate(data: RackAllocation) -> Formulation[Allocation]:
    """Formulate the problem as an integer program.

    Parameters
    ----------
    data
        The problem.
    """
    orders, pods = _useful(data)
    stations = len(data.slots)

    def encode(allocation: Allocation) -> NDArray[np.float64]:
        number = np.arange(stations)
        x = allocation.order_station[orders, np.newaxis] == number
        y = allocation.pod_station[pods, np.newaxis] == number
        return np.concatenate([x.ravel(), y.ravel()]).astype(np.float64)

    def decode(columns: NDArray[np.float64]) -> Allocation:
        chosen = columns.reshape(-1, stations) > 0.5 if stations else np.zeros((0, 1), bool)
        order_station = np.full(len(data.units), NONE, np.int64)
        pod_station = np.full(len(data.stock), NONE, np.int64)
        if stations:
            at = np.where(chosen.any(axis=1), chosen.argmax(axis=1), NONE)
            order_station[orders], pod_station[pods] = at[: len(orders)], at[len(orders) :]
        return Allocation(order_station, pod_station)

    def name(names: Names) -> None:
        x, y = np.split(np.arange(len(names.name)), [len(orders) * stations])
        at = np.arange(stations)
        x, y = x.reshape(len(orders), stations), y.reshape(len(pods), stations)
        names.block("order", x, "order_station[{o}] = {s}", o=orders[:, np.newaxis], s=at)
        names.block("pod", y, "pod_station[{p}] = {s}", p=pods[:, np.newaxis], s=at)

    units, stock = _wanted(data, orders, pods)
    program = _program(units, stock, data.slots, _most_wanted(units, data.slots))
    return Formulation(
        program,
        encode,
        decode,
        lambda allocation: objective(data, allocation),
        lambda allocation: violations(data, allocation),
        name,
    )


def together(data: RackAllocation) -> LinearProgram:
    """Formulate the program with all stations merged into one; this is a relaxation.

    For each SKU k, the largest :math:`d_{sk}` of all stations s (see the module) is used, so that
    each row is implied by the sum of the rows that it replaces. If all stations have equally many
    slots, the linear relaxation of this program has the same value as that of the program from
    `formulate`.

    Parameters
    ----------
    data
        The problem.
    """
    units, stock = _wanted(data, *_useful(data))
    most = _most_wanted(units, data.slots).max(axis=1, keepdims=True, initial=0)
    return _program(units, stock, data.slots.sum(keepdims=True), most)


def _useful(data: RackAllocation) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Find the orders that all pods together can serve, and the pods that hold a SKU of these."""
    orders = np.flatnonzero((data.units <= data.stock.sum(axis=0)).all(axis=1))
    pods = np.flatnonzero((data.stock[:, data.units[orders].any(axis=0)] > 0).any(axis=1))
    return orders, pods


def _wanted(
    data: RackAllocation, orders: NDArray[np.int64], pods: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the units of the orders and the stock of the pods, for the SKUs of the orders."""
    skus = np.flatnonzero(data.units[orders].any(axis=0))
    return data.units[np.ix_(orders, skus)], data.stock[np.ix_(pods, skus)]


def _program(
    units: NDArray[np.int64],
    stock: NDArray[np.int64],
    slots: NDArray[np.int64],
    most: NDArray[np.int64],
) -> LinearProgram:
    """Build the program; `most` limits the units of each pod that count, shape (K, S)."""
    (orders, skus), pods, stations = units.shape, len(stock), len(slots)
    builder = ProgramBuilder()
    x = builder.columns((orders, stations))
    y = builder.columns((pods, stations), cost=1.0)
    at = np.arange(stations)
    builder.rows(stations, (at, x, 1.0), lower=slots, upper=slots)
    builder.rows(orders, (np.arange(orders)[:, np.newaxis], x, 1.0), upper=1.0)
    builder.rows(pods, (np.arange(pods)[:, np.newaxis], y, 1.0), upper=1.0)

    pod, held = np.nonzero(stock)
    order, wanted = np.nonzero(units)
    enough = np.minimum(stock[pod, held, np.newaxis], most[held])
    builder.rows(
        skus * stations,
        (held[:, np.newaxis] * stations + at, y[pod], enough),
        (wanted[:, np.newaxis] * stations + at, x[order], -units[order, wanted, np.newaxis]),
        lower=0.0,
    )
    # the pods that hold the SKU of each line
    line, holder = _meet(wanted, held)
    builder.rows(
        len(order) * stations,
        (np.arange(len(order))[:, np.newaxis] * stations + at, x[order], -1.0),
        (line[:, np.newaxis] * stations + at, y[pod[holder]], 1.0),
        lower=0.0,
    )
    return builder.build()


def _most_wanted(units: NDArray[np.int64], slots: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the maximum demand of each station for each SKU, in units, shape (K, S)."""
    largest = np.sort(units, axis=0)[::-1].cumsum(axis=0)
    totals = np.vstack([np.zeros((1, units.shape[1]), np.int64), largest])
    most: NDArray[np.int64] = totals[np.minimum(slots, len(units))].T
    return most


def _meet(
    one: NDArray[np.int64], other: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """List the pairs (index into `one`, index into `other`) of equal values."""
    order = np.argsort(other, kind="stable")
    begin = np.searchsorted(other[order], one, side="left")
    count = np.searchsorted(other[order], one, side="right") - begin
    first = np.repeat(np.arange(len(one)), count)
    within = np.arange(len(first)) - np.repeat(np.cumsum(count) - count, count)
    return first, order[within + np.repeat(begin, count)]
