"""POA related: sends each order to the station whose orders have most SKUs in common with it."""

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
    """Tie-breaker among stations with equally many SKUs in common: fewest (`least-busy`) or most
    (`most-busy`) open orders, or random."""


class Related(Filling[RelatedParameters]):
    """Groups orders for the same SKUs, so that one pod serves several orders.

    Orders are assigned in the sequence of their arrival; those that stock cannot serve are skipped.
    Each goes to the station whose open orders have the most lines, picked or not, for SKUs of the
    order to be assigned. Ties are broken by the tie-breaker, then by station number.
    """

    parameters_model = RelatedParameters

    def next_assignment(self, stations: list[PickStation]) -> AssignOrder | None:
        """Choose the oldest order that stock can serve, and a station by SKUs in common."""
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
