"""Fast lane: assigns orders to stations whose current pod alone can complete them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from rmfs.control.decisions import AssignOrder
from rmfs.world.news import Follower

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from rmfs.control.view import View
    from rmfs.world.orders import Order


@dataclass(slots=True)
class _Visit:
    """State of one pod's visit to a station.

    A pod that is being served only loses units, so an order that it cannot complete need not be
    checked again during the visit, unless the order itself loses units (`FastLane.cut`).

    Attributes
    ----------
    number
        Number of the visit at the station.
    fitting
        Orders that the pod can complete, by index.
    """

    number: int
    fitting: dict[int, Order] = field(default_factory=dict)


class FastLane:
    """Assigns orders of the backlog to stations whose current pod can complete them.

    Stations are considered by ascending number, and orders by ascending `rank`. Units of the
    pod that are needed by orders already at the station are not available to other orders.

    Parameters
    ----------
    rank
        Function that returns the rank of an order; the order with the smallest rank comes first.
    """

    def __init__(self, view: View, rank: Callable[[Order], tuple[float, int]]) -> None:
        self._view = view
        self._rank = rank
        stations = len(view.pick_stations)
        self._visits = [_Visit(-1) for _ in range(stations)]
        self._news = Follower(view.slot_news)
        self._serving: set[int] = set()
        self._hopeful: set[int] = set()
        self._newest = -1
        # by station: its pod, the newest order that was checked, and whether this is `_newest`
        self._pods = np.zeros(stations, np.intp)
        self._checked = np.full(stations, -1)
        self._is_up_to_date = np.zeros(stations, np.bool_)

    def decide(self, stations: list[int] | None = None) -> Iterator[AssignOrder]:
        """Yield assignments while the pod at a station with a free slot can complete an order.

        Parameters
        ----------
        stations
            The stations to consider. Default: those that `promising` returns.
        """
        for index in self.promising() if stations is None else stations:
            station, fitting = self._view.pick_stations[index], self._visits[index].fitting
            pod = self._view.robots[station.robot].pod
            while fitting and station.free_slots > 0:
                self._forget_lost(fitting, index, pod)
                order = min(fitting.values(), key=self._rank, default=None)
                if order is None:
                    break
                yield AssignOrder(order, index)
            if not fitting:
                self._hopeful.discard(index)

    def promising(self) -> list[int]:
        """Return the numbers of stations with a free slot and a pod that may complete an order.

        The numbers are ascending. New orders are checked for all stations at once; beyond that,
        only stations that have changed are checked.
        """
        newest = next(reversed(self._view.orders.orders), -1)
        changed = self._news.take()
        if changed:
            self._update_serving(changed)
        if newest != self._newest:
            self._look_at_arrivals(newest)
        if changed:
            new: dict[int, list[Order]] = {}
            for index in changed & self._serving:
                self._look(index, newest, new)
        if not self._hopeful:
            return []
        serving, visits = self._serving, self._visits
        return sorted(i for i in self._hopeful if i in serving and visits[i].fitting)

    def _update_serving(self, changed: set[int]) -> None:
        """Update which stations have a pod and a free slot."""
        serving, stations = self._serving, self._view.pick_stations
        for index in changed:
            station = stations[index]
            self._is_up_to_date[index] = False
            if station.robot >= 0 and station.active and station.free_slots > 0:
                serving.add(index)
            else:
                serving.discard(index)

    def _look_at_arrivals(self, newest: int) -> None:
        """Find new orders that pods can complete at the stations that are up to date."""
        available, checked = self._view.inventory.available, self._checked
        anywhere = bool(self._is_up_to_date.any())
        for order in self._view.orders.after(self._newest) if anywhere else []:
            fits = self._is_up_to_date & (checked < order.index)
            for line in order.lines:
                fits &= available[line.sku].take(self._pods) >= line.units
            for index in fits.nonzero()[0].tolist():
                self._visits[index].fitting[order.index] = order
                self._hopeful.add(index)
        np.maximum(checked, newest, out=checked, where=self._is_up_to_date)
        self._newest = newest

    def cut(self, order: Order) -> None:
        """Check an order of the backlog again, since it has lost units."""
        view = self._view
        for index, visit in enumerate(self._visits):
            station = view.pick_stations[index]
            if station.robot >= 0 and visit.number == station.visits:
                self._look_at_new(visit, view.robots[station.robot].pod, [order])
                if visit.fitting:
                    self._hopeful.add(index)

    def _look(self, index: int, newest: int, new: dict[int, list[Order]]) -> None:
        """Bring a station up to date: find orders that its pod can complete.

        All orders are checked if the pod is new, otherwise only those newer than the last check.

        Parameters
        ----------
        new
            Orders newer than a given index, by that index; missing entries are added.
        """
        view, visit, checked = self._view, self._visits[index], self._checked.item(index)
        station = view.pick_stations[index]
        pod = view.robots[station.robot].pod
        if visit.number != station.visits:
            visit.number, checked = station.visits, newest
            visit.fitting.clear()
            self._look_at_all(visit, pod)
        elif checked < newest:
            orders = new.get(checked)
            if orders is None:
                orders = new[checked] = view.orders.after(checked)
            self._look_at_new(visit, pod, orders)
            checked = newest
        self._pods[index], self._checked[index], self._is_up_to_date[index] = pod, checked, True
        if visit.fitting:
            self._hopeful.add(index)
        else:
            self._hopeful.discard(index)

    def _forget_lost(self, fitting: dict[int, Order], station: int, pod: int) -> None:
        """Drop orders that have been assigned elsewhere or that the pod can no longer complete."""
        backlog = self._view.orders.orders
        for index, order in list(fitting.items()):
            if index not in backlog or not self._completes(pod, order, station):
                del fitting[index]

    def _look_at_all(self, visit: _Visit, pod: int) -> None:
        orders = self._view.orders
        if not len(orders):
            return
        fits = (self._view.inventory.available[orders.sku, pod] >= orders.units).all(axis=1)
        for row in fits.nonzero()[0].tolist():
            order = orders.at_row[row]
            visit.fitting[order.index] = order

    def _look_at_new(self, visit: _Visit, pod: int, orders: list[Order]) -> None:
        available = self._view.inventory.available.item
        for order in orders:
            for line in order.lines:
                if available(line.sku, pod) < line.units:
                    break
            else:
                visit.fitting[order.index] = order

    def _completes(self, pod: int, order: Order, station: int) -> bool:
        """Whether the pod has all units of the order beyond what its station already needs."""
        available, need = self._view.inventory.available.item, self._view.need[station].item
        return all(available(line.sku, pod) - need(line.sku) >= line.units for line in order.lines)
