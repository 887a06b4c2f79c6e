"""Fast lane: orders that the pod being served at a station can complete all by itself."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rmfs.control.decisions import AssignOrder

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from rmfs.control.view import View
    from rmfs.world.orders import Order
    from rmfs.world.stations import PickStation


@dataclass(slots=True)
class _Visit:
    """What is known about one pod at one station.

    A pod that is being served only loses units, so an order it could not complete is not looked at
    again during the visit.

    Attributes
    ----------
    number
        Which visit of the station it is.
    newest
        Index of the newest order looked at.
    fitting
        Orders it could complete, by index.
    """

    number: int
    newest: int
    fitting: dict[int, Order] = field(default_factory=dict)


class FastLane:
    """Assigns orders of the backlog to the station where their pod stands.

    The order with the lowest rank comes first; stations in their order. Units that orders assigned
    before are to get from the pod are not counted twice.

    Parameters
    ----------
    rank
        Gives the key by which orders compete; the smallest wins.
    """

    def __init__(self, view: View, rank: Callable[[Order], tuple[float, int]]) -> None:
        self._view = view
        self._rank = rank
        self._visits = [_Visit(-1, -1) for _ in view.pick_stations]

    def decide(self) -> Iterator[AssignOrder]:
        """Yield until no pod that is being served can complete an order."""
        newest = next(reversed(self._view.orders.orders), -1)
        for station in self._view.pick_stations:
            if station.robot < 0 or not station.active:
                continue
            while station.free_slots > 0:
                order = self._best(station, newest)
                if order is None:
                    break
                yield AssignOrder(order, station.index)

    def _best(self, station: PickStation, newest: int) -> Order | None:
        pod = self._view.robots[station.robot].pod
        visit = self._visits[station.index]
        if visit.number != station.visits:
            visit = self._visits[station.index] = _Visit(station.visits, newest)
            self._look_at_all(visit, pod)
        elif visit.newest < newest:
            self._look_at_new(visit, pod)
            visit.newest = newest
        if not visit.fitting:
            return None
        self._forget_lost(visit, station.index, pod)
        return min(visit.fitting.values(), key=self._rank, default=None)

    def _forget_lost(self, visit: _Visit, station: int, pod: int) -> None:
        """Forget orders that have gone elsewhere or that the pod can complete no more."""
        backlog = self._view.orders.orders
        need = self._view.need[station].item
        for index, order in list(visit.fitting.items()):
            if index not in backlog or not self._completes(pod, order, need):
                del visit.fitting[index]

    def _look_at_all(self, visit: _Visit, pod: int) -> None:
        orders = self._view.orders
        if not len(orders):
            return
        fits = (self._view.inventory.available[orders.sku, pod] >= orders.units).all(axis=1)
        for row in fits.nonzero()[0].tolist():
            order = orders.at_row[row]
            visit.fitting[order.index] = order

    def _look_at_new(self, visit: _Visit, pod: int) -> None:
        for order in self._view.orders.after(visit.newest):
            if self._completes(pod, order, None):
                visit.fitting[order.index] = order

    def _completes(self, pod: int, order: Order, need: Callable[[int], int] | None) -> bool:
        """Whether the pod has all units of the order to spare."""
        available = self._view.inventory.available.item
        return all(
            available(line.sku, pod) - (need(line.sku) if need else 0) >= line.units
            for line in order.lines
        )
