"""POA related: sends an order to the station whose orders share the most SKUs with the order."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from rmfs.control.base import Parameters
from rmfs.control.decisions import AssignOrder
from rmfs.control.poa.filling import Filling

if TYPE_CHECKING:
    from rmfs.world.stations import PickStation


class RelatedParameters(Parameters):
    """Parameters of POA related."""

    tie_breaker: Literal["least-busy", "most-busy", "random"] = "least-busy"
    """Which station is chosen if the open orders of several stations have equally many lines for
    SKUs of the order: the one with the fewest (`least-busy`) or most (`most-busy`) open orders, or
    a random one (`random`)."""


class Related(Filling[RelatedParameters]):
    """Groups orders for the same SKUs at a station, so that one pod serves several orders.

    Orders are assigned in the sequence of their arrival; those that stock cannot serve are skipped.
    Each order goes to the station whose open orders have the most lines, picked or not, for SKUs of
    this order. Ties are broken by `tie_breaker`; remaining ties go to the station with the lowest
    number.
    """

    parameters_model = RelatedParameters

    def next_assignment(self, stations: list[PickStation]) -> AssignOrder | None:
        """Choose the oldest servable order, and the station whose orders share the most SKUs."""
        order = self.oldest_order()
        if order is None:
            return None
        skus = [line.sku for line in order.lines]
        shared = self.view.lines[:, skus].sum(axis=1)
        most = max(shared.item(station.index) for station in stations)
        tied = [station for station in stations if shared.item(station.index) == most]
        return AssignOrder(order, self._one_of(tied).index)

    def _one_of(self, stations: list[PickStation]) -> PickStation:
        if self.parameters.tie_breaker == "random":
            return stations[self.draw(len(stations))]
        sign = 1 if self.parameters.tie_breaker == "least-busy" else -1
        return min(stations, key=lambda station: sign * len(station.orders))
