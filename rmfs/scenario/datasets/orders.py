"""Collects orders from rows, for any file layout."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable
    from datetime import datetime

NO_LINE = "orders without a line"
NOT_TAKEN = "lines of orders that are not used"


@dataclass(slots=True)
class Order:
    """An order.

    Attributes
    ----------
    time
        Arrival, as a date and time, or in s from time zero.
    due
        Due time, if the data set has one.
    units
        Number of units by SKU, in the sequence of the order lines.
    """

    time: datetime | float
    due: datetime | None = None
    units: dict[str, int] = field(default_factory=dict)

    def add(self, sku: str, units: int) -> None:
        """Add units of a SKU; units of the same SKU form one line."""
        self.units[sku] = self.units.get(sku, 0) + units


@dataclass(slots=True)
class Orders:
    """The orders of a data set.

    Attributes
    ----------
    takes
        Function that returns whether to use an order, given its time; called once per order.
    by_name
        Orders by name; None for an order that is not used.
    left_out
        Number of omitted orders or lines, by reason (a text).
    """

    takes: Callable[[datetime | float], bool]
    by_name: dict[str, Order | None] = field(default_factory=dict)
    left_out: Counter[str] = field(default_factory=Counter)

    def begin(self, name: str, time: datetime | float) -> Order | None:
        """Return the order with this name, or None if it is not used.

        The first call with a name decides whether the order is used, and creates it if so.
        """
        if name not in self.by_name:
            taken = self.takes(time)
            self.by_name[name] = Order(time) if taken else None
            self.left_out["orders not asked for"] += not taken
        return self.by_name[name]

    def taken(self) -> list[tuple[str, Order]]:
        """Return pairs (name, order) of all orders used, sorted by time.

        Orders with the same time are in the sequence of the file. Orders without a line are
        omitted, and counted in `left_out`.
        """
        found = [(name, one) for name, one in self.by_name.items() if one is not None]
        self.left_out[NO_LINE] += sum(not one.units for _, one in found)
        return sorted((pair for pair in found if pair[1].units), key=lambda pair: pair[1].time)
