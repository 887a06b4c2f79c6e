"""The table `order_lines`: order lines read from a file, with the file's additional columns."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.measure.columns import INTEGER, REAL, TEXT, Column
from rmfs.measure.tables.orders import seen
from rmfs.measure.tables.stock import names_of_skus
from rmfs.measure.tables.tidy import tidy

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

    from rmfs.measure.tables.logs import Logs
    from rmfs.scenario.streams import OrderStream
    from rmfs.scenario.streams.order_file import OrderFile

ORDER_LINES = (
    Column("order", INTEGER, "", "Order, as in the table `orders`"),
    Column("sku", INTEGER, "", "SKU, as in the table `skus`"),
    Column("units", INTEGER, "units", "Units ordered"),
    Column(
        "picked_s",
        REAL,
        "s",
        "Time at which the handling of the line's last unit ended; empty if it had not ended by "
        "the end of the run",
    ),
    Column(
        "file_line", INTEGER, "", "Number of the line (CSV) or row (Parquet) in the file of orders"
    ),
    Column("file_order", TEXT, "", "Name of the order in the file"),
    Column("file_sku", TEXT, "", "Name of the SKU, or its number if it has no name"),
)
"""Columns of the table; further columns of the file follow, each as `file_NAME`."""


def order_lines(logs: Logs) -> pd.DataFrame:
    """Return one row per order line, for all orders in the table `orders` that come from a file."""
    stream = logs.recorder.order_stream
    orders = seen(logs)
    orders = orders[orders["in_file"] >= 0]
    if stream is None or stream.file is None or orders.empty:
        return tidy("order_lines", ORDER_LINES, {column.name: [] for column in ORDER_LINES})
    order, line = _lines(orders, stream)
    file, sku = stream.file, stream.sku[line]
    names = np.array(file.names, dtype=object)
    frame = tidy(
        "order_lines",
        ORDER_LINES,
        {
            "order": order,
            "sku": sku,
            "units": stream.units[line],
            "picked_s": _picked_s(logs, order, sku),
            "file_line": file.line[line],
            "file_order": names[np.repeat(orders["in_file"], _counts(orders, stream))],
            "file_sku": np.array(names_of_skus(logs.world.skus), dtype=object)[sku],
        },
    )
    return with_columns_of(file, line, frame)


def with_columns_of(file: OrderFile, line: NDArray[np.int64], frame: pd.DataFrame) -> pd.DataFrame:
    """Add the additional columns of a file of orders or bundles to a table made from the file.

    Parameters
    ----------
    line
        For each row of the table, the index in `file` of its order line or bundle.
    frame
        The table, which is changed and returned.
    """
    import pandas as pd

    for name, (codes, texts) in file.columns.items():
        given = pd.Series(np.array(texts, dtype=object)[codes[line]])
        frame[f"file_{name}"] = given.astype("str")
    return frame


def _lines(
    orders: pd.DataFrame, stream: OrderStream
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the order of each included line, and the line's position in the stream."""
    counts = _counts(orders, stream)
    begins = np.cumsum(counts) - counts
    within = np.arange(counts.sum()) - np.repeat(begins, counts)
    first = stream.first_line[orders["in_file"].to_numpy()]
    return np.repeat(orders["order"].to_numpy(), counts), np.repeat(first, counts) + within


def _counts(orders: pd.DataFrame, stream: OrderStream) -> NDArray[np.int64]:
    """Return the number of lines of each order."""
    counts: NDArray[np.int64] = np.diff(stream.first_line)[orders["in_file"].to_numpy()]
    return counts


def _picked_s(logs: Logs, order: NDArray[np.int64], sku: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return when each line was finished, or nan; an order has a SKU only once."""
    skus, done = len(logs.world.skus), logs.lines[logs.lines["end_s"] <= logs.end_s]
    keys = done["order"].to_numpy(np.int64) * skus + done["sku"].to_numpy(np.int64)
    by_key = np.argsort(keys, kind="stable")
    found = np.searchsorted(keys[by_key], order * skus + sku)
    at = by_key[np.minimum(found, len(keys) - 1)] if len(keys) else np.zeros(len(sku), np.int64)
    picked = np.full(len(sku), np.nan)
    if len(keys):
        same = keys[at] == order * skus + sku
        picked[same] = done["end_s"].to_numpy()[at[same]]
    return picked
