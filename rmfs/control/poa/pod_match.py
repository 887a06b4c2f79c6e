"""POA pod-match: the order with most units available on pods on their way to the station."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from rmfs.control.base import Parameters
from rmfs.control.decisions import AssignOrder
from rmfs.control.poa import PickOrderAssignment
from rmfs.control.poa.fast_lane import FastLane

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.world.orders import Order
    from rmfs.world.stations import PickStation

TieBreaker = Literal["due-time", "first-come", "random"]


class PodMatchParameters(Parameters):
    """Parameters of POA pod-match."""

    tie_breaker: TieBreaker = "due-time"
    """Which of several orders with equally many units: earliest due time, earliest arrival, or
    any."""
    late_first: bool = False
    """Whether orders past their due time come before all others."""
    fast_lane: bool = True
    """Whether one slot of each station is kept for orders that the pod being served there can
    complete."""
    fast_lane_tie_breaker: TieBreaker = "due-time"
    """Which of several such orders."""


class PodMatch(PickOrderAssignment[PodMatchParameters]):
    """Matches orders with pods that come anyway, for a high pile-on.

    The score of a pair of order and station is the number of its units that are available on pods
    inbound to the station. The pair with the highest score is assigned, until no slot is free.
    Ties: the tie-breaker, then the order that arrived first, then the station with the lowest
    number.

    Differences from RAWSim-O, where these are defects: an available unit is counted for one order
    only (units that open requests of the station wait for are left out, those of orders assigned
    a moment ago included); the stock an order needs is compared with the stock there is, not with
    all that ever was; `late_first` prefers late orders, not orders in time.
    """

    parameters_model = PodMatchParameters

    def __init__(
        self, parameters: PodMatchParameters, view: View, rng: np.random.Generator
    ) -> None:
        super().__init__(parameters, view, rng)
        self._lane = FastLane(view, self._order_key) if parameters.fast_lane else None
        self._kept_slots = [
            int(parameters.fast_lane and station.slots > 1) for station in view.pick_stations
        ]

    def decide(self) -> Iterator[AssignOrder]:
        """Yield orders for the fast lane first, then the best pairs while slots are free."""
        if self._lane is not None:
            yield from self._lane.decide()
        while True:
            stations = [
                station
                for station in self.view.pick_stations
                if station.active and station.free_slots > self._kept_slots[station.index]
            ]
            best = self._best_pair(stations) if stations and len(self.view.orders) else None
            if best is None:
                return
            yield best

    def _best_pair(self, stations: list[PickStation]) -> AssignOrder | None:
        orders = self.view.orders
        servable = orders.servable(self.view.inventory.free_stock)
        if not servable.any():
            return None
        scores = np.stack([self._matches(station.index) for station in stations])
        if self.parameters.late_first:
            scores += (orders.due_s < self.view.now_s) * (int(scores.max()) + 1)
        scores[:, ~servable] = -1
        best = scores.max()
        rows = (scores.max(axis=0) == best).nonzero()[0]
        row = self._first(rows)
        station = stations[int(scores[:, row].argmax())]
        return AssignOrder(orders.at_row[row], station.index)

    def _matches(self, station: int) -> NDArray[np.int32]:
        """Units of each order that spare stock on inbound pods can serve, shape (B,)."""
        orders = self.view.orders
        sku = orders.sku
        spare = self.view.inventory.inbound[station][sku] - self.view.need[station][sku]
        np.clip(spare, 0, orders.units, out=spare)
        matches: NDArray[np.int32] = spare.sum(axis=1, dtype=np.int32)
        return matches

    def _first(self, rows: NDArray[np.intp]) -> int:
        """Break ties between rows of the backlog."""
        if len(rows) == 1:
            return int(rows[0])
        if self.parameters.tie_breaker == "random":
            return int(rows[self.draw(len(rows))])
        if self.parameters.tie_breaker == "due-time":
            due_s = self.view.orders.due_s[rows]
            rows = rows[due_s == due_s.min()]
        at_row = self.view.orders.at_row
        tied: list[int] = rows.tolist()
        return min(tied, key=lambda row: at_row[row].index)

    def _order_key(self, order: Order) -> tuple[float, int]:
        """Rank orders for the fast lane; the smallest comes first."""
        if self.parameters.fast_lane_tie_breaker == "random":
            return float(self.rng.random()), order.index
        if self.parameters.fast_lane_tie_breaker == "due-time":
            return order.due_s, order.index
        return 0.0, order.index
