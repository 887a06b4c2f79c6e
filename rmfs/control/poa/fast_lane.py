"""Fast lane: assigns orders to stations whose current pod alone can complete them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

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
    checked again during the visit.

    Attributes
    ----------
    number
        Number of the visit at the station.
    newest
        Index of the newest order that was checked.
    fitting
        Orders that the pod can complete, by index.
    """

    number: int
    newest: int
    fitting: dict[int, Order] = field(default_factory=dict)

    def begin(self, number: int, newest: int) -> None:
        """Reset the state for another pod."""
        self.number, self.newest = number, newest
        self.fitting.clear()


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
        self._visits = [_Visit(-1, -1) for _ in view.pick_stations]
        self._news = Follower(view.slot_news)
        self._serving: set[int] = set()
        self._hopeful: set[int] = set()
        self._newest = -1

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

    def promising(self) -> list[int]:
        """Return the numbers of stations with a free slot and a pod that may complete an order.

        The numbers are ascending. If there are new orders since the last call, all stations with a
        free slot are checked; otherwise, only those that have changed.
        """
        newest = next(reversed(self._view.orders.orders), -1)
        changed, serving = self._news.take(), self._serving
        for index in changed:
            station = self._view.pick_stations[index]
            if station.robot >= 0 and station.active and station.free_slots > 0:
                serving.add(index)
            else:
                serving.discard(index)
        if newest == self._newest and not changed and not self._hopeful:
            return []
        new: dict[int, list[Order]] = {}
        for index in serving if newest != self._newest else changed & serving:
            self._look(index, newest, new)
        self._newest = newest
        if not self._hopeful:
            return []
        return sorted(i for i in self._hopeful if i in serving and self._visits[i].fitting)

    def _look(self, index: int, newest: int, new: dict[int, list[Order]]) -> None:
        """Find orders that the pod at a station can complete, among all orders or the new ones.

        Parameters
        ----------
        new
            Orders newer than a given index, by that index; missing entries are added.
        """
        view, visit = self._view, self._visits[index]
        station = view.pick_stations[index]
        if visit.number != station.visits:
            visit.begin(station.visits, newest)
            self._look_at_all(visit, view.robots[station.robot].pod)
        elif visit.newest < newest:
            orders = new.get(visit.newest)
            if orders is None:
                orders = new[visit.newest] = view.orders.after(visit.newest)
            self._look_at_new(visit, view.robots[station.robot].pod, orders)
            visit.newest = newest
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
