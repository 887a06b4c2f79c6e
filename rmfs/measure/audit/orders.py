"""Audit of orders: whether each completed order has received exactly the units ordered."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from rmfs.measure.audit.report import Chapter
from rmfs.measure.events import Happening

if TYPE_CHECKING:
    from collections.abc import Iterator

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
        self.last_us: dict[int, int] = {}
        self.completed = 0

    def follow(self) -> None:
        """Process the events one after another."""
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
                self.last_us[order] = time_us
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


def check(rows: Rows, finished_us: int = -1) -> Chapter:
    """Check that orders receive exactly the units ordered.

    An order must not receive more units than ordered, nor any units before its arrival or after its
    completion or cancellation. A completed order must have received all its units, and an order
    that has received all its units must be completed.

    Parameters
    ----------
    rows
        All events of the run.
    finished_us
        Time (us) before which orders can be checked for completion: all picks begun before this
        time were finished by the end of the run, so an order whose last unit was picked before this
        time must be completed. -1 if unknown.
    """
    orders = _Orders(rows.of_kind(*KINDS))
    orders.follow()
    return Chapter(
        "orders",
        f"{len(orders.wanted)} arrived, {orders.completed} completed",
        [*orders.faults, *_still_open(orders, finished_us)],
    )


def _still_open(orders: _Orders, finished_us: int) -> Iterator[str]:
    """Yield the orders that should have been completed or cancelled."""
    for order, wants in orders.wanted.items():
        if order in orders.ended:
            continue
        if wants.total() == 0:
            yield f"order {order} has no lines left, but is not completed or cancelled"
        elif wants == orders.picked[order] and orders.last_us[order] < finished_us:
            yield (
                f"order {order} got its last unit at {orders.last_us[order] / 1e6:.6f} s, but is "
                "not completed"
            )
