"""Orders that could not be served from stock."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.measure.base import Measure
from rmfs.measure.columns import INTEGER, LESS, REAL, Column

if TYPE_CHECKING:
    from rmfs.measure.ended import EndedRun


class ShortOrders(Measure):
    """Orders that were cancelled, delivered in part, or stuck at the end.

    An order is stuck if it waits for a station and cannot be served from stock.
    """

    columns = (
        Column(
            "orders_cancelled",
            INTEGER,
            "orders",
            "Orders cancelled because stock could not serve them (orders.shortage)",
            better=LESS,
        ),
        Column(
            "orders_partial",
            INTEGER,
            "orders",
            "Orders completed without some of their units, because these were not in stock",
            better=LESS,
        ),
        Column(
            "units_not_delivered",
            INTEGER,
            "units",
            "Units of cancelled orders, and units missing from completed orders",
            better=LESS,
        ),
        Column(
            "orders_stuck_end",
            INTEGER,
            "orders",
            "Orders in the backlog at the end that stock cannot serve",
            better=LESS,
        ),
        Column(
            "oldest_stuck_end_s",
            REAL,
            "s",
            "Age of the oldest order counted in orders_stuck_end; empty if there is none",
            better=LESS,
        ),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Return the numbers of cancelled, partly delivered and stuck orders.

        Also return the number of units not delivered, and the age of the oldest stuck order.
        """
        orders = run.tables["orders"]
        cancelled, done = orders["cancelled_s"].notna(), orders["completed_s"].notna()
        cut = orders["units_cut"]
        backlog = run.world.orders
        served = backlog.servable(run.world.inventory.free_stock).tolist()
        waited = [
            run.end_s - order.created_s
            for order, can in zip(backlog.at_row, served, strict=True)
            if not can
        ]
        return {
            "orders_cancelled": int(cancelled.sum()),
            "orders_partial": int((done & (cut > 0)).sum()),
            "units_not_delivered": int(cut[cancelled | done].sum()),
            "orders_stuck_end": len(waited),
            "oldest_stuck_end_s": max(waited, default=float("nan")),
        }
