"""Orders being put together from rows, whatever the layout of the columns."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable
    from datetime import datetime

NO_LINE = "orders without a line"
NOT_TAKEN = "lines of orders that are not taken"


@dataclass(slots=True)
class Order:
    """An order.

    Attributes
    ----------
    time
        When it comes; a moment, or s from time zero.
    due
        When it is due, if the set tells.
    units
        By SKU, in the order of its lines.
    """

    time: datetime | float
    due: datetime | None = None
    units: dict[str, int] = field(default_factory=dict)

    def add(self, sku: str, units: int) -> None:
        """Add units; rows of one SKU are one line."""
        self.units[sku] = self.units.get(sku, 0) + units


@dataclass(slots=True)
class Orders:
    """Orders of a set.

    Attributes
    ----------
    takes
        Told the time of an order, says whether it is taken; asked once for each order.
    by_name
        Those taken; None for those that are not.
    left_out
        What was left out, and how often.
    """

    takes: Callable[[datetime | float], bool]
    by_name: dict[str, Order | None] = field(default_factory=dict)
    left_out: Counter[str] = field(default_factory=Counter)

    def begin(self, name: str, time: datetime | float) -> Order | None:
        """Return the order of a name; a new one if it is taken."""
        if name not in self.by_name:
            taken = self.takes(time)
            self.by_name[name] = Order(time) if taken else None
            self.left_out["orders not asked for"] += not taken
        return self.by_name[name]

    def taken(self) -> list[tuple[str, Order]]:
        """Return what has lines, by time; those of one time by the order of the file."""
        found = [(name, one) for name, one in self.by_name.items() if one is not None]
        self.left_out[NO_LINE] += sum(not one.units for _, one in found)
        return sorted((pair for pair in found if pair[1].units), key=lambda pair: pair[1].time)
