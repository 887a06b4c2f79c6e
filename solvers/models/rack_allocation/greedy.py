"""Fill the stations one after another, always adding the pod that completes the most orders."""

from __future__ import annotations

import math
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.rack_allocation.data import (
    NONE,
    Allocation,
    RackAllocation,
    objective,
    pods_needed,
    violations,
)
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, solution_of_rule


def solve(
    data: RackAllocation,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Allocation | None = None,
) -> Solution[Allocation]:
    """Fill the stations one after another, in decreasing order of their numbers of slots.

    Until its slots are filled, a station repeatedly gets the pod that completes the most remaining
    orders, and then the orders that its pods can serve, orders with fewer units first. If no
    pod completes an order, the station gets the pod that holds missing units of the most order
    lines. Pods that turn out to be unnecessary are released.

    Returns
    -------
    The allocation; ties go to the lowest index. The bound is that of `pods_needed`. If a station
    could not be filled, there is no allocation. The status is then INFEASIBLE or LIMIT. It is
    INFEASIBLE if fewer orders than slots are servable; an order is servable if the stock of all
    pods suffices for this order alone.
    """
    begin = perf_counter()
    servable = (data.units <= data.stock.sum(axis=0)).all(axis=1)
    bound = pods_needed(data)
    filling = _Filling(data)
    for station in np.argsort(-data.slots, kind="stable").tolist():
        filling.fill(station)
    allocation = Allocation(filling.order_station, filling.pod_station)
    broken = bool(violations(data, allocation))
    if broken and int(servable.sum()) < int(data.slots.sum()):
        bound = math.inf
    return solution_of_rule(
        None if broken else allocation,
        lambda values: objective(data, values),
        bound=bound,
        work=float(filling.scored),
        began=begin,
    )


class _Filling:
    """The state of the rule: the stations of orders and pods so far."""

    def __init__(self, data: RackAllocation) -> None:
        self._data = data
        self.order_station = np.full(len(data.units), NONE, np.int64)
        self.pod_station = np.full(len(data.stock), NONE, np.int64)
        self.scored = 0
        self._line_order, self._line_sku = data.lines
        self._line_units = data.units[self._line_order, self._line_sku]
        self._size = data.units.sum(axis=1)

    def fill(self, station: int) -> None:
        """Give a station pods and orders until it is full, or no pod helps."""
        left = np.zeros(self._data.units.shape[1], np.int64)
        while self._take_orders(station, left):
            pod = self._next_pod(left)
            if pod == NONE:
                return
            self.pod_station[pod] = station
            left += self._data.stock[pod]
        for pod in np.flatnonzero(self.pod_station == station).tolist():
            if (self._data.stock[pod] <= left).all():
                self.pod_station[pod] = NONE
                left -= self._data.stock[pod]

    def _take_orders(self, station: int, left: NDArray[np.int64]) -> int:
        """Give the station orders that its pods can serve; return the number of slots left."""
        free = int(self._data.slots[station] - (self.order_station == station).sum())
        waiting = np.flatnonzero(self.order_station == NONE)
        for order in waiting[np.argsort(self._size[waiting], kind="stable")].tolist():
            if free and (self._data.units[order] <= left).all():
                self.order_station[order] = station
                left -= self._data.units[order]
                free -= 1
        return free

    def _next_pod(self, left: NDArray[np.int64]) -> int:
        """Choose the pod that completes the most orders; `NONE` if no pod helps.

        If no pod completes an order, choose the pod that holds missing units of the most lines.
        """
        pods = np.flatnonzero(self.pod_station == NONE)
        lines = np.flatnonzero(self.order_station[self._line_order] == NONE)
        if not len(pods) or not len(lines):
            return NONE
        sku, order = self._line_sku[lines], self._line_order[lines]
        missing = np.maximum(self._line_units[lines] - left[sku], 0)
        covered = self._data.stock[np.ix_(pods, sku)] >= missing
        self.scored += covered.size
        # lines are sorted by order, so those of an order are a range
        first = np.flatnonzero(np.diff(order, prepend=-1))
        completes = np.logical_and.reduceat(covered, first, axis=1).sum(axis=1)
        if completes.any():
            return int(pods[completes.argmax()])
        adds = (np.minimum(self._data.stock[np.ix_(pods, sku)], missing) > 0).sum(axis=1)
        return int(pods[adds.argmax()]) if adds.any() else NONE
