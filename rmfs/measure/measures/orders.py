"""Times of completed orders, and counts of arriving, waiting and open orders."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.measure.base import Measure
from rmfs.measure.columns import INTEGER, LESS, REAL, Column
from rmfs.measure.measures.reckoning import ratio, spread, spread_columns
from rmfs.measure.steps import Steps
from rmfs.measure.tables.orders import completed

if TYPE_CHECKING:
    from rmfs.measure.ended import EndedRun


class OrderTimes(Measure):
    """Turnover, throughput time and lateness of completed orders."""

    columns = (
        Column(
            "order_turnover_mean_s",
            REAL,
            "s",
            "Mean time from arrival to completion of an order",
            better=LESS,
        ),
        Column(
            "order_turnover_median_s",
            REAL,
            "s",
            "Median time from arrival to completion of an order",
            better=LESS,
        ),
        Column(
            "order_turnover_lower_quartile_s",
            REAL,
            "s",
            "First quartile of the time from arrival to completion of an order",
            better=LESS,
        ),
        Column(
            "order_turnover_upper_quartile_s",
            REAL,
            "s",
            "Third quartile of the time from arrival to completion of an order",
            better=LESS,
        ),
        *spread_columns(
            "order_throughput_time",
            "the time from the assignment of an order to a station until its completion",
        ),
        Column(
            "late_share",
            REAL,
            "share",
            "Share of the completed orders that were completed after their due time",
            better=LESS,
        ),
        Column(
            "orders_late", INTEGER, "orders", "Orders completed after their due time", better=LESS
        ),
        *spread_columns(
            "order_lateness",
            "the lateness of orders (completion time minus due time; negative if early)",
        ),
        *spread_columns("late_by", "the lateness of late orders"),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Return statistics of the times of completed orders, and how many of them were late."""
        done = completed(run.tables["orders"])
        lateness = done["lateness_s"]
        late = lateness[lateness > 0]
        return {
            **spread("order_turnover", done["turnover_s"]),
            **spread("order_throughput_time", done["throughput_time_s"]),
            "late_share": ratio(len(late), len(done)),
            "orders_late": len(late),
            **spread("order_lateness", lateness),
            **spread("late_by", late),
        }


class Backlog(Measure):
    """Numbers of orders that arrive, wait for a station, or are open."""

    columns = (
        Column(
            "backlog_orders_mean",
            REAL,
            "orders",
            "Time average of the number of orders in the backlog; a split order leaves it when its "
            "first part is assigned to a station",
            better=LESS,
        ),
        Column(
            "backlog_orders_end",
            INTEGER,
            "orders",
            "Orders in the backlog at the end; a split order is not among them if a part of it has "
            "been assigned to a station",
            better=LESS,
        ),
        Column(
            "open_orders_mean",
            REAL,
            "orders",
            "Time average of the number of open orders at stations; a split order counts once, "
            "from the assignment of its first part to the completion of the order",
        ),
        Column("orders_created", INTEGER, "orders", "Orders that arrived"),
        Column(
            "order_redraws",
            INTEGER,
            "draws",
            "Number of times that the SKU of a line of an order that arrived was drawn again "
            "because stock could not serve the line",
        ),
        Column(
            "orders_short",
            INTEGER,
            "orders",
            "Orders for which stock was short when they arrived: they needed more units of a "
            "SKU than were left in stock for them by earlier orders",
            better=LESS,
        ),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Return mean and final backlog, mean number of open orders, and number of arrivals.

        Also return how many order lines were drawn again for lack of stock, and how many orders
        exceeded the available stock when they arrived.
        """
        orders, counters = run.logs.orders, run.recorder.counters
        measured = (run.start_s, run.end_s)
        waiting = Steps.between(
            orders["created_s"], orders["assigned_s"].fillna(orders["cancelled_s"])
        )
        open_ones = Steps.between(orders["assigned_s"], orders["completed_s"])
        return {
            "backlog_orders_mean": waiting.mean(*measured),
            "backlog_orders_end": int(waiting.at(run.end_s)),
            "open_orders_mean": open_ones.mean(*measured),
            "orders_created": int((orders["created_s"] >= run.start_s).sum()),
            "order_redraws": int(counters["order_redraws"]),
            "orders_short": int(counters["orders_short"]),
        }
