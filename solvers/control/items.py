"""Items assigned by models: whole orders, or single lines of orders that may be split."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rmfs.control.decisions import AssignLines, AssignOrder

if TYPE_CHECKING:
    from rmfs.control.view import View
    from rmfs.solvers.control.splitting import Splitting
    from rmfs.world.orders import Order, OrderLine


@dataclass(frozen=True, eq=False)
class Item:
    """An order, or one line of an order that may be split.

    Attributes
    ----------
    line
        The line; None for the whole order.
    """

    order: Order
    line: OrderLine | None = None

    @property
    def lines(self) -> tuple[OrderLine, ...]:
        """The order lines of this item."""
        return self.order.lines if self.line is None else (self.line,)

    @property
    def key(self) -> tuple[int, int]:
        """Key of the item: index of the order, and SKU of the line (-1 for a whole order)."""
        return self.order.index, -1 if self.line is None else self.line.sku

    def waits(self, view: View) -> bool:
        """Whether the item is still in the backlog."""
        return self.order in view.orders and (self.line is None or self.line in self.order.lines)

    def decision(self, station: int) -> AssignOrder | AssignLines:
        """Return the decision that assigns the item to a station."""
        if self.line is None:
            return AssignOrder(self.order, station)
        return AssignLines(self.order, station, (self.line.sku,))


def servable(view: View, split: bool, splitting: Splitting | None = None) -> list[Item]:
    """Return the items of the backlog that stock can serve, in order of arrival.

    Each item is compared, as if it were the only one, with the stock that orders at stations do not
    need.

    Parameters
    ----------
    split
        Whether orders may be split; each line of an order that may be split is then an item.
    splitting
        With `split`, determines which orders may be split; the others remain whole. Default: all.
    """
    orders, stock = view.orders, view.inventory.free_stock
    if split:
        offered = None if splitting is None else splitting.offers()
        found = (
            Item(order, line)
            for order in orders
            for line in (order.lines if offered is None or offered(order) else (None,))
        )
        return [one for one in found if all(line.units <= stock[line.sku] for line in one.lines)]
    rows = orders.servable(stock).nonzero()[0]
    rows = rows[np.argsort(orders.index[rows], kind="stable")]
    return [Item(orders.at_row[row]) for row in rows.tolist()]
