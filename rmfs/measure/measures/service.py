"""Whether orders were done in time: packed, where the scenario has packing, else picked."""

from __future__ import annotations

from math import nan
from typing import TYPE_CHECKING, Any

from rmfs.measure.base import Measure
from rmfs.measure.columns import INTEGER, LESS, MORE, REAL, Column
from rmfs.measure.measures.reckoning import ratio
from rmfs.scenario.due import PriorityDue

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.measure.ended import EndedRun
    from rmfs.observer import Observed


class Service(Measure):
    """On-time share and lateness, by priority where there are two classes."""

    columns = (
        Column(
            "on_time_share",
            REAL,
            "share",
            "Orders done by their due time, of those that were done or cancelled in the measured "
            "time or are overdue at its end; done: packed, where the scenario has packing, else "
            "picked",
            better=MORE,
        ),
        Column(
            "on_time_urgent_share",
            REAL,
            "share",
            "The same of urgent orders; empty unless due times are of two classes "
            '(orders.due.mode = "priority"), as is the next',
            better=MORE,
        ),
        Column("on_time_ordinary_share", REAL, "share", "The same of all others", better=MORE),
        Column(
            "lateness_p95_s",
            REAL,
            "s",
            "95th percentile of done less due time, negative if early, of the orders done",
            better=LESS,
        ),
        Column("lateness_max_s", REAL, "s", "Greatest of the same", better=LESS),
        Column(
            "orders_overdue_end",
            INTEGER,
            "orders",
            "Orders that are past their due time and not done at the end",
            better=LESS,
        ),
        Column(
            "oldest_order_end_s",
            REAL,
            "s",
            "Time since the arrival of the oldest order that is not done at the end",
            better=LESS,
        ),
    )

    def __init__(self) -> None:
        self._urgent_s = nan

    def run_started(self, run: Observed) -> None:
        """Take note of what is urgent."""
        due = run.scenario.orders.due
        if isinstance(due, PriorityDue):
            self._urgent_s = due.urgent_offset_s

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Look at orders, and at parcels if there are any."""
        orders = run.tables["orders"][["order", "created_s", "due_s", "completed_s", "cancelled_s"]]
        done_s = orders["completed_s"]
        if run.recorder.packing.given is not None:
            parcels = run.tables["parcels"]
            # an order may have been picked in the warm-up and be packed in the measured time
            orders = orders.merge(
                parcels[["order", "created_s", "due_s", "packed_s"]], "outer", on="order"
            )
            for name in ("created_s", "due_s"):
                orders[name] = orders.pop(f"{name}_x").fillna(orders.pop(f"{name}_y"))
            done_s = orders["packed_s"]
        due_s, end_s = orders["due_s"], run.end_s
        done = done_s >= run.start_s
        cancelled = orders["cancelled_s"] >= run.start_s
        overdue = done_s.isna() & ~cancelled & (due_s < end_s)
        counted, in_time = done | overdue | cancelled, done & (done_s <= due_s)
        urgent = due_s - orders["created_s"] <= self._urgent_s + 1e-6
        two = self._urgent_s == self._urgent_s
        lateness = (done_s - due_s)[done]
        waiting = orders["created_s"][done_s.isna() & ~cancelled]
        return {
            "on_time_share": _share(in_time, counted),
            "on_time_urgent_share": _share(in_time & urgent, counted & urgent) if two else nan,
            "on_time_ordinary_share": _share(in_time & ~urgent, counted & ~urgent) if two else nan,
            "lateness_p95_s": lateness.quantile(0.95),
            "lateness_max_s": lateness.max(),
            "orders_overdue_end": int(overdue.sum()),
            "oldest_order_end_s": end_s - waiting.min(),
        }


def _share(part: pd.Series[bool], whole: pd.Series[bool]) -> float:
    return ratio(int(part.sum()), int(whole.sum()))
