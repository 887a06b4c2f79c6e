"""Pick orders, their lines, and replenishment bundles.

Times are in simulated seconds; the time of an event that has not happened is nan. The index of a
pod or station that has not been chosen is -1.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import nan
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping


@dataclass(slots=True, eq=False)
class OrderLine:
    """Units of one SKU in one order.

    There is a request for each unit. A request is *open* until a unit on a certain pod is
    bound to it. This happens when a robot gets the task of bringing that pod, or later during the
    task.

    Attributes
    ----------
    units
        Number of units ordered.
    open_units
        Number of requests not yet bound to a pod.
    picked_units
        Number of requests fulfilled.
    """

    order: Order
    sku: int
    units: int
    open_units: int
    picked_units: int = 0


@dataclass(slots=True, eq=False)
class Order:
    """A pick order: in the backlog, then at one pick station until it is complete.

    An order may be split: some of its lines then go to a station as a *part*, while the others stay
    in the backlog or form further parts. A part is itself an `Order`, and takes a slot at its
    station. At any time, a station has at most one part of the same order. The split order is
    complete when all its parts and its remaining lines are complete.

    Attributes
    ----------
    index
        Ordinal of arrival.
    lines
        The order lines, all of different SKUs.
    open_units, unpicked_units
        Number of requests not yet bound to a pod, and of units not yet picked, over all lines.
    station
        The pick station, or -1 while in the backlog.
    assigned_s
        Time of the assignment to a station; for a split order, the time at which its first lines
        were assigned.
    queued_at
        The pick station in whose pool the order is, or -1.
    slot_s
        Time at which the order itself took a slot. It differs from `assigned_s` if other lines of
        the order had been assigned before.
    whole
        The order of which this is a part; None if it is not a part.
    parts
        Parts split off so far; their lines no longer belong to the order itself.
    slots_taken
        Slots currently occupied by the order and its parts.
    in_file
        Position among the orders of a file, from 0; -1 if the order is not from a file.
    cancelled_s
        Time at which the order was cancelled because stock could not serve it.
    units_cut
        Number of ordered units that will not be delivered, for lack of stock.
    priority
        Index of the order's class in the scenario's `orders.due.classes`; -1 if there are none.
    weight
        Weight of the order's lateness, given by its class; 1 if there are no classes.
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
    slot_s: float = nan
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
        """The order's own lines and those of its parts, without lines that lost all their units."""
        return sum((part.lines for part in self.parts), self.lines)

    def take_over(self, lines: tuple[OrderLine, ...]) -> None:
        """Move lines of another order, which has no slot yet, to this one."""
        giver = lines[0].order
        giver.lines = tuple(line for line in giver.lines if line not in lines)
        self.lines += lines
        for line in lines:
            line.order = self
        for order, sign in ((giver, -1), (self, 1)):
            order.open_units += sign * sum(line.open_units for line in lines)
            # in a pool, units are bound to pods before the order has a slot
            order.unpicked_units += sign * sum(line.units for line in lines)

    def cut(self, keep: Mapping[int, int]) -> None:
        """Reduce the units, which must not be bound to pods; remove lines left without units.

        Parameters
        ----------
        keep
            Units that remain, by SKU; a SKU without an entry loses all its units.
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
        """Create an order with one line per SKU; `units` has the number of units of each line."""
        total = sum(units)
        order = cls(index, created_s, due_s, (), total, total)
        order.lines = tuple(
            OrderLine(order, sku, count, count) for sku, count in zip(skus, units, strict=True)
        )
        return order


@dataclass(slots=True, eq=False)
class Bundle:
    """A replenishment order: units of one SKU that go into one pod at one station.

    Two decisions are needed. RPS reserves room on a pod and releases the bundle, at once or after
    waiting for more bundles for the same pod; ROA chooses the station. Once the bundle is released
    and has a station, it is *assigned*: it waits at the station for its pod.

    Attributes
    ----------
    space
        Space of the whole bundle, in space units.
    pod
        The pod on which room is reserved for the bundle, or -1.
    released
        Whether RPS has released the bundle.
    station
        The replenishment station at which space is reserved for the bundle, or -1.
    stored_s
        Time at which the transfer of the bundle into the pod started.
    in_file
        Position among the bundles of a file, from 0; -1 if the bundle is not from a file.
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
