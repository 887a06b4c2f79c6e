"""Determines which orders may be split: as many as the put wall, or a given limit, allows.

If the totes of an order share a slot of the wall, a split order needs one slot; otherwise, it needs
a slot for each of its totes except the last. The number of totes is known only when the last line
has a station, so each line without a station counts as a separate tote. If no other limit is given,
the wall therefore always has room for the totes of split orders, and never blocks a pick station.

If the number of split orders is limited, orders are ranked by a ratio: the largest number of lines
of the order that the pods under way to a single station can serve, divided by the number of slots
of the wall that the order needs. An order is left out if the pods under way to one station can
serve all its lines, as it need not be split. It is also left out if no pods under way to any
station can serve any of its lines, as it would not benefit from being split now.
"""

from __future__ import annotations

from math import inf, isnan
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from rmfs.control.view import View
    from rmfs.world.orders import Order


class Splitting:
    """Capacity left for split orders at one instant.

    Parameters
    ----------
    view
        The world.
    limit
        Maximum number of orders split at a time, regardless of the wall; None: the wall's capacity.
    planned
        Orders of the backlog with lines planned for stations.
    pays
        Function that returns whether splitting an order is worth its cost; None: it always is.
    """

    def __init__(
        self,
        view: View,
        limit: int | None,
        planned: Iterable[Order] = (),
        pays: Callable[[Order], bool] | None = None,
    ) -> None:
        self._view, self._pays = view, pays
        wall = view.put_wall
        self._per_part = wall is None or wall.slot_per_part
        self._orders = inf if limit is None else float(limit)
        slots = None if wall is None or limit is not None else wall.slots
        self._slots = inf if slots is None else float(slots)
        self._counted: set[int] = set()
        if self.is_free:
            return
        if wall is not None:
            for parcel in wall.parcels.values():
                if parcel.picked and isnan(parcel.consolidated_s):
                    self._take(float(parcel.kept))
        for order in (*view.split_orders.values(), *planned):
            self.add(order)

    @property
    def is_free(self) -> bool:
        """Whether every order may be split, without limit or cost."""
        return self._orders == self._slots == inf and self._pays is None

    def admits(self, order: Order) -> bool:
        """Whether the lines of an order in the backlog may be assigned separately.

        Always true if the order is already split, or has a single line.
        """
        return self._is_settled(order) or (self._orders >= 1 and self._slots >= self._need(order))

    def offers(self) -> Callable[[Order], bool]:
        """Choose the orders that may be split now; return a function that is true for them.

        The function is also true for orders that are already split, or have a single line.
        """
        if self._orders == self._slots == inf:
            return lambda order: self._is_settled(order) or self._is_worth_it(order)
        chosen: set[int] = set()
        orders, slots = self._orders, self._slots
        for order in self._candidates():
            need = self._need(order)
            if orders >= 1 and slots >= need and self._is_worth_it(order):
                orders, slots = orders - 1, slots - need
                chosen.add(order.index)
        return lambda order: self._is_settled(order) or order.index in chosen

    def _is_settled(self, order: Order) -> bool:
        split = bool(order.parts) or order.index in self._counted
        return self.is_free or split or len(order.lines) == 1

    def _is_worth_it(self, order: Order) -> bool:
        return self._pays is None or self._pays(order)

    def _candidates(self) -> list[Order]:
        """Return orders of which pods under way to one station can serve some lines, but not all.

        Orders with the most such lines per slot of the wall come first; ties go to the oldest.
        """
        view = self._view
        spare = view.inventory.inbound[: len(view.pick_stations)] - view.need
        units = view.orders.units
        asked = units > 0
        lines = asked.sum(axis=1)
        best = ((units <= spare[:, view.orders.sku]) & asked).sum(axis=2).max(axis=0)
        rows = np.flatnonzero((best > 0) & (best < lines))
        slots = lines[rows] - 1 if self._per_part else np.ones(len(rows))
        order = np.lexsort((view.orders.index[rows], -best[rows] / slots))
        return [view.orders.at_row[row] for row in rows[order].tolist()]

    def add(self, order: Order) -> None:
        """Count an order as split."""
        if order.index not in self._counted:
            need = self._need(order)
            if need:
                self._counted.add(order.index)
            self._take(need)

    def _take(self, need: float) -> None:
        self._slots -= need
        self._orders -= need > 0

    def _need(self, order: Order) -> float:
        """Return the number of slots of the wall that an order may need."""
        lines = len(order.lines) if order in self._view.orders else bool(order.lines)
        others = max(len(order.parts) + lines - 1, 0)
        return float(others if self._per_part else min(others, 1))
