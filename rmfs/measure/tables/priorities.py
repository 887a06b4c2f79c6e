"""The table of service by priority class: orders done on time, and lateness of orders."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.measure.columns import INTEGER, REAL, TEXT, Column
from rmfs.measure.tables.orders import seen
from rmfs.measure.tables.packing import parcels
from rmfs.measure.tables.tidy import tidy
from rmfs.scenario.due import ClassesDue, PriorityDue

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

    from rmfs.measure.tables.logs import Logs
    from rmfs.scenario.due import Due

_HAIR_S = 1e-6

PRIORITIES = (
    Column(
        "priority",
        TEXT,
        "",
        'Name of the class of orders; "urgent" or "ordinary" if orders.due.mode = '
        '"priority" and their offsets differ; "all" if there are no classes',
    ),
    Column("weight", REAL, "", "Weight of the lateness of orders of the class"),
    Column("orders", INTEGER, "orders", "Orders done or cancelled, or overdue at the end"),
    Column("orders_done", INTEGER, "orders", "Orders done: packed or, without packing, picked"),
    Column(
        "orders_overdue_end",
        INTEGER,
        "orders",
        "Orders that are past their due time, but neither done nor cancelled, at the end",
    ),
    Column("on_time_share", REAL, "share", "Orders done by their due time, as a share of `orders`"),
    Column("lateness_mean_s", REAL, "s", "Mean lateness of the orders done; negative if early"),
    Column(
        "lateness_p95_s",
        REAL,
        "s",
        "95th percentile of the lateness of the orders done; negative if early",
    ),
    Column("lateness_max_s", REAL, "s", "Maximum lateness of the orders done"),
    Column(
        "late_by_mean_s",
        REAL,
        "s",
        "Mean tardiness of the orders done: their lateness, or 0 if on time",
    ),
    Column(
        "cycle_mean_s",
        REAL,
        "s",
        "Mean time from the arrival of an order until it is done",
    ),
    Column(
        "cycle_p95_s",
        REAL,
        "s",
        "95th percentile of the time from the arrival of an order until it is done",
    ),
)


def priorities(logs: Logs) -> pd.DataFrame:
    """Return one row per priority class: the service of its orders in the measured time."""
    orders, names, weights = served(logs), class_names(logs), class_weights(logs)
    rows = [
        {"priority": name, "weight": weight, **_of(orders[orders["class"] == number])}
        for number, (name, weight) in enumerate(zip(names, weights, strict=True))
    ]
    columns = {column.name: [row[column.name] for row in rows] for column in PRIORITIES}
    return tidy("priorities", PRIORITIES, columns)


def class_names(logs: Logs) -> tuple[str, ...]:
    """Return the names of the priority classes, the most urgent first."""
    due = logs.recorder.due
    if isinstance(due, ClassesDue):
        return due.names
    return ("urgent", "ordinary") if _tells_urgent(due) else ("all",)


def class_weights(logs: Logs) -> tuple[float, ...]:
    """Return the weight of lateness in each priority class, in the order of `class_names`."""
    due = logs.recorder.due
    if isinstance(due, ClassesDue):
        return tuple(one.weight for one in due.classes)
    return (1.0,) * len(class_names(logs))


def served(logs: Logs) -> pd.DataFrame:
    """Return the orders by which service is measured, one row per order.

    An order is done when it is packed or, in scenarios without packing, completely picked. Orders
    done or cancelled before the measured time are excluded.

    Returns
    -------
    DataFrame
        Columns `order`, `created_s`, `due_s`, `done_s` (empty if the order is not done),
        `cancelled_s`, `class` (index in `class_names`), and the flags `done`, `cancelled`,
        `overdue` (neither done nor cancelled, and due before the end of the run) and `on_time`
        (done by the due time). All flags are false for an order that is still unfinished but not
        overdue.
    """
    frame = seen(logs)[["order", "created_s", "due_s", "completed_s", "cancelled_s"]]
    frame = frame.rename(columns={"completed_s": "done_s"})
    if logs.recorder.packing.given is not None:
        # an order may be picked in the warm-up and packed in the measured time
        packed = parcels(logs)[["order", "created_s", "due_s", "packed_s"]]
        frame = frame.drop(columns="done_s").merge(packed, "outer", on="order")
        for name in ("created_s", "due_s"):
            frame[name] = frame.pop(f"{name}_x").fillna(frame.pop(f"{name}_y"))
        frame = frame.rename(columns={"packed_s": "done_s"})
    frame["class"] = _classes(logs, frame)
    frame["done"] = frame["done_s"] >= logs.start_s
    frame["cancelled"] = frame["cancelled_s"] >= logs.start_s
    waits = frame["done_s"].isna() & ~frame["cancelled"]
    frame["overdue"] = waits & (frame["due_s"] < logs.end_s)
    frame["on_time"] = frame["done"] & (frame["done_s"] <= frame["due_s"])
    return frame


def _classes(logs: Logs, frame: pd.DataFrame) -> NDArray[np.int64]:
    due = logs.recorder.due
    if isinstance(due, ClassesDue):
        every = logs.orders.set_index("order")["priority"]
        return every.reindex(frame["order"]).to_numpy(np.int64)
    if isinstance(due, PriorityDue) and _tells_urgent(due):
        later_s = (frame["due_s"] - frame["created_s"]).to_numpy() - due.urgent_offset_s
        if due.ordinary_offset_s < due.urgent_offset_s:
            later_s = -later_s
        return (later_s > _HAIR_S).astype(np.int64)
    return np.zeros(len(frame), np.int64)


def _tells_urgent(due: Due) -> bool:
    """Return whether the offset of an order tells if it is urgent or ordinary."""
    return isinstance(due, PriorityDue) and due.urgent_offset_s != due.ordinary_offset_s


def _of(orders: pd.DataFrame) -> dict[str, Any]:
    """Return the values of the row for the orders of one class, by column."""
    done = orders[orders["done"]]
    lateness, cycle = done["done_s"] - done["due_s"], done["done_s"] - done["created_s"]
    counted = int((orders["done"] | orders["cancelled"] | orders["overdue"]).sum())
    return {
        "orders": counted,
        "orders_done": len(done),
        "orders_overdue_end": int(orders["overdue"].sum()),
        "on_time_share": int(orders["on_time"].sum()) / counted if counted else np.nan,
        "lateness_mean_s": lateness.mean(),
        "lateness_p95_s": lateness.quantile(0.95),
        "lateness_max_s": lateness.max(),
        "late_by_mean_s": lateness.clip(lower=0.0).mean(),
        "cycle_mean_s": cycle.mean(),
        "cycle_p95_s": cycle.quantile(0.95),
    }
