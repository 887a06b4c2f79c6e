"""Audit of orders: whether each completed order has received exactly the units ordered."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from rmfs.measure.audit.report import Chapter
from rmfs.measure.events import Happening

if TYPE_CHECKING:
    from rmfs.measure.audit.rows import Rows

KINDS = (
    *(Happening.ORDER_CREATED, Happening.ORDER_LINE, Happening.ORDER_CUT),
    *(Happening.ORDER_CANCELLED, Happening.ORDER_ASSIGNED, Happening.UNIT_PICKED),
    *(Happening.ORDER_COMPLETED, Happening.PART_COMPLETED),
)


class _Orders:
    """The orders of a run, event by event."""

    def __init__(self, rows: Rows) -> None:
        self.rows = rows
        self.faults: list[str] = []
        self.wanted: dict[int, Counter[int]] = {}
        self.picked: dict[int, Counter[int]] = {}
        self.ended: dict[int, int] = {}
        self.completed = 0

    def follow(self) -> None:
        """Look at one event after the other."""
        rows = self.rows
        columns = (rows.kind, rows.order, rows.station, rows.sku, rows.units, rows.time_us)
        told = zip(*(column.tolist() for column in columns), strict=True)
        for row, (kind, order, station, sku, units, time_us) in enumerate(told):
            if kind == Happening.ORDER_CREATED:
                if order in self.wanted or order < 0:
                    self._wrong(row, f"order {order} arrives a second time")
                self.wanted[order], self.picked[order] = Counter(), Counter()
                continue
            if order not in self.wanted:
                self._wrong(row, f"order {order} has not arrived yet")
                continue
            if self.ended.get(order, time_us) != time_us:
                self._wrong(row, f"order {order} was completed or cancelled earlier")
            wants = self.wanted[order]
            if kind == Happening.ORDER_LINE and station < 0:
                wants[sku] += units
            elif kind == Happening.ORDER_CUT:
                wants.clear()
            elif kind == Happening.ORDER_CANCELLED:
                wants.clear()
                self._end(row, order, time_us)
            elif kind == Happening.UNIT_PICKED:
                self.picked[order][sku] += units
                if self.picked[order][sku] > wants[sku]:
                    self._wrong(row, f"order {order} needs no more units of SKU {sku}")
            elif kind == Happening.ORDER_COMPLETED:
                self._complete(row, order, units, time_us)

    def _complete(self, row: int, order: int, units: int, time_us: int) -> None:
        self._end(row, order, time_us)
        self.completed += 1
        wants, has = self.wanted[order], self.picked[order]
        if wants != has or not wants.total():
            self._wrong(
                row,
                f"order {order} is completed, but the {has.total()} units picked for it are not "
                f"the {wants.total()} units ordered",
            )
        if units != wants.total():
            self._wrong(
                row,
                f"order {order} is completed with {units} units, but it has {wants.total()}",
            )

    def _end(self, row: int, order: int, time_us: int) -> None:
        if order in self.ended:
            self._wrong(row, f"order {order} was already completed or cancelled")
        self.ended[order] = time_us

    def _wrong(self, row: int, what: str) -> None:
        self.faults.append(self.rows.tell(row, what))


def check(rows: Rows) -> Chapter:
    """Check that no order gets too many units, and none before its arrival or after its end.

    Also checks that a completed order has got all its units.
    """
    orders = _Orders(rows.of_kind(*KINDS))
    orders.follow()
    open_ = [
        f"order {order} has no lines left, but is not completed or cancelled"
        for order, wants in orders.wanted.items()
        if order not in orders.ended and wants.total() == 0
    ]
    told = f"{len(orders.wanted)} arrived, {orders.completed} completed"
    return Chapter("orders", told, orders.faults + open_)
