"""POA random: any order that stock can serve, to any station with a free slot."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.control.base import NoParameters
from rmfs.control.decisions import AssignOrder
from rmfs.control.poa import PickOrderAssignment

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.world.orders import Order

_DRAWS = 8
"""Orders drawn from the backlog before those that can be served are looked up."""


class RandomOrder(PickOrderAssignment[NoParameters]):
    """Fills free slots with orders drawn at random, each at a station drawn at random.

    Source: rule "Default" of RAWSim-O with random order and random station.
    """

    def decide(self) -> Iterator[AssignOrder]:
        """Yield until no slot is free or no order can be served."""
        stations = [s for s in self.view.pick_stations if s.active and s.free_slots > 0]
        while stations:
            order = self._servable_order()
            if order is None:
                return
            station = stations[self.draw(len(stations))]
            yield AssignOrder(order, station.index)
            if not station.free_slots:
                stations.remove(station)

    def _servable_order(self) -> Order | None:
        backlog = self.view.orders.at_row
        if not backlog:
            return None
        free_stock = self.view.inventory.free_stock.item
        for _ in range(_DRAWS):
            order = backlog[self.draw(len(backlog))]
            if all(free_stock(line.sku) >= line.units for line in order.lines):
                return order
        rows = np.flatnonzero(self.view.orders.servable(self.view.inventory.free_stock))
        return backlog[int(rows[self.draw(len(rows))])] if len(rows) else None
