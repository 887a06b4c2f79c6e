"""On-time service: whether orders are done by their due time.

An order is done when it is packed or, if the scenario has no packing, when it is picked.
"""

from __future__ import annotations

from math import nan
from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.measure.base import Measure
from rmfs.measure.columns import INTEGER, LESS, MORE, REAL, Column
from rmfs.measure.measures.reckoning import ratio
from rmfs.measure.tables.priorities import class_names, class_weights, served

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.measure.ended import EndedRun


class Service(Measure):
    """On-time share and lateness; the table `priorities` gives them for each class of orders."""

    columns = (
        Column(
            "on_time_share",
            REAL,
            "share",
            "Orders done by their due time, as a share of the orders that were done or cancelled "
            "in the measured time or are overdue at its end; an order is done when it is packed "
            "or, without packing, when it is picked",
            better=MORE,
        ),
        Column(
            "on_time_urgent_share",
            REAL,
            "share",
            "on_time_share of urgent orders, that is, of the first class (orders.due.mode = "
            '"priority" or "classes"); empty with fewer than two classes',
            better=MORE,
        ),
        Column(
            "on_time_ordinary_share",
            REAL,
            "share",
            "on_time_share of orders that are not urgent; empty with fewer than two classes",
            better=MORE,
        ),
        Column(
            "on_time_weighted_share",
            REAL,
            "share",
            "on_time_share in which each order counts with the weight of its class "
            '(orders.due.mode = "classes")',
            better=MORE,
        ),
        Column(
            "lateness_p95_s",
            REAL,
            "s",
            "95th percentile of the lateness of the orders done; negative if early",
            better=LESS,
        ),
        Column("lateness_max_s", REAL, "s", "Maximum lateness of the orders done", better=LESS),
        Column(
            "orders_overdue_end",
            INTEGER,
            "orders",
            "Orders that are past their due time, but neither done nor cancelled, at the end",
            better=LESS,
        ),
        Column(
            "oldest_order_end_s",
            REAL,
            "s",
            "Age of the oldest order that is neither done nor cancelled at the end",
            better=LESS,
        ),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Return on-time shares, and the lateness of the orders done.

        Also return, for the end of the run, the number of overdue orders and the age of the oldest
        order that is neither done nor cancelled.
        """
        orders, names = served(run.logs), class_names(run.logs)
        done, cancelled, overdue = orders["done"], orders["cancelled"], orders["overdue"]
        counted, in_time = done | overdue | cancelled, orders["on_time"]
        first, several = orders["class"] == 0, len(names) > 1
        weight = np.array(class_weights(run.logs))[orders["class"]]
        lateness = (orders["done_s"] - orders["due_s"])[done]
        waiting = orders["created_s"][orders["done_s"].isna() & ~cancelled]
        return {
            "on_time_share": _share(in_time, counted),
            "on_time_urgent_share": _share(in_time & first, counted & first) if several else nan,
            "on_time_ordinary_share": _share(in_time & ~first, counted & ~first)
            if several
            else nan,
            "on_time_weighted_share": ratio(
                float((weight * in_time).sum()), float((weight * counted).sum())
            ),
            "lateness_p95_s": lateness.quantile(0.95),
            "lateness_max_s": lateness.max(),
            "orders_overdue_end": int(overdue.sum()),
            "oldest_order_end_s": run.end_s - waiting.min(),
        }


def _share(part: pd.Series[bool], whole: pd.Series[bool]) -> float:
    return ratio(int(part.sum()), int(whole.sum()))
