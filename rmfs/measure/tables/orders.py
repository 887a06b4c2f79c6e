"""The table of orders."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.measure.columns import INTEGER, REAL, TEXT, Column
from rmfs.measure.energy import WH
from rmfs.measure.tables.tidy import tidy
from rmfs.scenario.due import ClassesDue

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

    from rmfs.measure.tables.logs import Logs


ORDERS = (
    Column(
        "order",
        INTEGER,
        "",
        "Number of the order, in sequence of arrival from the start of the run",
    ),
    Column(
        "name",
        TEXT,
        "",
        "Name of the order in the file of orders; empty if the order was generated",
    ),
    Column("priority", TEXT, "", 'Class of the order; empty unless orders.due.mode = "classes"'),
    Column(
        "station",
        INTEGER,
        "",
        "Pick station (of a split order, the one assigned last); -1 until the whole order is "
        "assigned",
    ),
    Column(
        "lines",
        INTEGER,
        "lines",
        "Number of order lines, excluding lines that lost all their units for lack of stock",
    ),
    Column("units", INTEGER, "units", "Units ordered, including units_cut"),
    Column("created_s", REAL, "s", "Time of arrival"),
    Column("due_s", REAL, "s", "Due time"),
    Column(
        "assigned_s",
        REAL,
        "s",
        "Time of the assignment to a station (of a split order, the first); empty if not yet "
        "assigned",
    ),
    Column("completed_s", REAL, "s", "Time of completion; empty if not yet completed"),
    Column(
        "cancelled_s",
        REAL,
        "s",
        "Time at which the order was cancelled for lack of stock; empty if it was not",
    ),
    Column("units_cut", INTEGER, "units", "Units not delivered for lack of stock"),
    Column("turnover_s", REAL, "s", "completed_s - created_s"),
    Column("throughput_time_s", REAL, "s", "completed_s - assigned_s"),
    Column("lateness_s", REAL, "s", "completed_s - due_s; negative if early"),
    Column(
        "pods", INTEGER, "pods", "Number of pods from which units of the order have been picked"
    ),
    Column(
        "energy_wh",
        REAL,
        "Wh",
        "Energy that robots have drawn for the units of the order (docs/energy.md); empty if "
        "energy is not modelled",
    ),
)


def orders(logs: Logs) -> pd.DataFrame:
    """Return one row per order waiting, open, completed or cancelled during the measured time."""
    frame = seen(logs)
    frame["name"] = _names(logs, frame.pop("in_file"))
    frame["priority"] = _priorities(logs, frame["priority"])
    frame["turnover_s"] = frame["completed_s"] - frame["created_s"]
    frame["throughput_time_s"] = frame["completed_s"] - frame["assigned_s"]
    frame["lateness_s"] = frame["completed_s"] - frame["due_s"]
    frame["pods"] = _pods(logs, frame["order"])
    energy = logs.recorder.energy
    frame["energy_wh"] = (
        frame["order"].map(energy.per_order).fillna(0.0) / WH if energy.final else np.nan
    )
    return tidy("orders", ORDERS, frame)


def seen(logs: Logs) -> pd.DataFrame:
    """Return the orders that were waiting, open, completed or cancelled in the measured time."""
    frame = logs.orders
    gone = (frame["completed_s"] < logs.start_s) | (frame["cancelled_s"] < logs.start_s)
    return frame[~gone].reset_index(drop=True)


def _priorities(logs: Logs, number: pd.Series[int]) -> NDArray[Any]:
    """Return the class name of each order, given the number of its class."""
    due = logs.recorder.due
    names = due.names if isinstance(due, ClassesDue) else ()
    # orders without a class have number -1, the last element
    return np.array([*names, ""], dtype=object)[number.to_numpy()]


def _names(logs: Logs, in_file: pd.Series[int]) -> NDArray[Any]:
    """Return the name of each order, given its position in the file of orders."""
    stream = logs.recorder.order_stream
    if stream is None or stream.file is None:
        return np.full(len(in_file), "", dtype=object)
    # drawn orders have position -1, the last element
    return np.array([*stream.file.names, ""], dtype=object)[in_file.to_numpy()]


def _pods(logs: Logs, order: pd.Series[int]) -> NDArray[np.int64]:
    """Return, for each order, the number of pods from which its units were picked."""
    pods = logs.layout.pods
    both = np.unique(logs.units["order"].to_numpy() * pods + logs.units["pod"].to_numpy())
    number = np.bincount(both // pods, minlength=int(order.max()) + 1 if len(order) else 0)
    return number[order.to_numpy()]


def completed(frame: pd.DataFrame) -> pd.DataFrame:
    """Return the rows of completed orders from a table of orders."""
    return frame[frame["completed_s"].notna()]
