"""Pick orders, their lines, and replenishment bundles.

Times are simulated seconds and nan until the event has happened; indices are -1 until decided.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import nan
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping


@dataclass(slots=True, eq=False)
class OrderLine:
    """Units of one SKU wanted by one order.

    Each unit is an extract request of its own. A request is *open* until a unit on a certain pod
    is bound to it, which happens late: when a robot gets the task to bring that pod, or while the
    pod is on its way.

    Attributes
    ----------
    units
        How many units the customer ordered.
    open_units
        Requests not yet bound to a pod.
    picked_units
        Requests fulfilled.
    """

    order: Order
    sku: int
    units: int
    open_units: int
    picked_units: int = 0


@dataclass(slots=True, eq=False)
class Order:
    """A pick order: in the backlog, then on one pick station until it is complete.

    An order may be split: then some of its lines go to a station as a *part*, an order of its own
    that takes a slot there, while the others stay in the backlog or make further parts. Of the
    parts of an order there is one at most at a station. It is complete when all its parts are.

    Attributes
    ----------
    index
        Ordinal of arrival.
    lines
        One per SKU, all SKUs different.
    open_units, unpicked_units
        Sums over the lines.
    station
        The pick station, or -1 while in the backlog.
    queued_at
        The pick station in whose pool an order of the backlog is queued, or -1.
    whole
        The order this one is a part of; None if it is no part.
    parts
        Parts split off so far; their lines are no longer among those of the order.
    slots_taken
        Slots that the order and its parts have at present.
    in_file
        Its place among the orders of a file, or -1.
    cancelled_s
        When it was given up because stock could not serve it.
    units_cut
        Units ordered that are not delivered.
    priority
        Its class, or -1 where the scenario has none (`orders.due.mode = "classes"`).
    weight
        What its lateness counts, by its class.
    """

    index: int
    created_s: float
    due_s: float
    lines: tuple[OrderLine, ...]
    open_units: int
    unpicked_units: int
    station: int = -1
    assigned_s: float = nan
    completed_s: float = nan
    queued_at: int = -1
    queued_s: float = nan
    whole: Order | None = None
    parts: list[Order] = field(default_factory=list)
    slots_taken: int = 0
    in_file: int = -1
    cancelled_s: float = nan
    units_cut: int = 0
    priority: int = -1
    weight: float = 1.0

    @property
    def all_lines(self) -> tuple[OrderLine, ...]:
        """Its lines as the customer ordered them, those of its parts included."""
        return sum((part.lines for part in self.parts), self.lines)

    def take_over(self, lines: tuple[OrderLine, ...]) -> None:
        """Make lines of another order lines of this one; none of them is bound to a pod yet."""
        giver = lines[0].order
        giver.lines = tuple(line for line in giver.lines if line not in lines)
        self.lines += lines
        for line in lines:
            line.order = self
        for order, sign in ((giver, -1), (self, 1)):
            order.open_units += sign * sum(line.open_units for line in lines)
            order.unpicked_units += sign * sum(line.open_units for line in lines)

    def cut(self, keep: Mapping[int, int]) -> None:
        """Let units of lines go, none of which is bound to a pod; lines without units go, too.

        Parameters
        ----------
        keep
            Units left of each SKU.
        """
        for line in self.lines:
            left = keep.get(line.sku, 0)
            self.units_cut += line.units - left
            line.units = line.open_units = left
        self.lines = tuple(line for line in self.lines if line.units)
        self.open_units = self.unpicked_units = sum(line.units for line in self.lines)

    @classmethod
    def of(
        cls,
        index: int,
        created_s: float,
        due_s: float,
        skus: tuple[int, ...],
        units: tuple[int, ...],
    ) -> Order:
        """Make an order with a line for each SKU."""
        total = sum(units)
        order = cls(index, created_s, due_s, (), total, total)
        order.lines = tuple(
            OrderLine(order, sku, count, count) for sku, count in zip(skus, units, strict=True)
        )
        return order


@dataclass(slots=True, eq=False)
class Bundle:
    """A replenishment order: units of one SKU that go into one pod at one station.

    Two decisions are needed: RPS promises it room on a pod and, perhaps after waiting for more
    bundles for the same pod, releases that decision; ROA chooses the station. When both have been
    taken the bundle is *assigned*, an insert request that only its pod can serve.

    Attributes
    ----------
    space
        Space units of the whole bundle.
    pod
        The pod with room promised, or -1.
    released
        Whether RPS has released the choice of the pod.
    station
        The replenishment station with space reserved, or -1.
    stored_s
        When its transfer into the pod began.
    in_file
        Its place among the bundles of a file, or -1.
    """

    index: int
    sku: int
    units: int
    space: float
    created_s: float
    pod: int = -1
    released: bool = False
    station: int = -1
    assigned_s: float = nan
    stored_s: float = nan
    in_file: int = -1
