"""POA related: orders as they came, to the station whose orders want the same SKUs."""

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
    """Which of several stations with equally many SKUs in common: the one with the fewest or most
    open orders, or any."""


class Related(Filling[RelatedParameters]):
    """Puts orders together that want the same SKUs, so that a pod serves several of them.

    Orders are taken as they came; one that stock cannot serve is passed over. It goes to the
    station with the highest sum, over the orders there, of SKUs they share with it, picked or not.
    Ties: the tie-breaker, then the station with the lowest number.
    """

    parameters_model = RelatedParameters

    def next_assignment(self, stations: list[PickStation]) -> AssignOrder | None:
        """Choose the order that came first, and a station by SKUs in common."""
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
