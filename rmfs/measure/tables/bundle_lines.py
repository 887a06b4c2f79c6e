"""The table `bundle_lines`: bundles read from a file, with all additional columns of the file."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.measure.columns import INTEGER, REAL, TEXT, Column
from rmfs.measure.tables.handled import seen_bundles
from rmfs.measure.tables.order_lines import with_columns_of
from rmfs.measure.tables.stock import names_of_skus
from rmfs.measure.tables.tidy import tidy

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.measure.tables.logs import Logs

BUNDLE_LINES = (
    Column("sku", INTEGER, "", "SKU, as in the table `skus`"),
    Column("units", INTEGER, "units", "Units in the bundle"),
    Column("created_s", REAL, "s", "Time of arrival"),
    Column(
        "stored_s", REAL, "s", "Time at which the transfer into the pod started; empty if not yet"
    ),
    Column("pod", INTEGER, "", "Pod; -1 if not yet decided"),
    Column("station", INTEGER, "", "Replenishment station; -1 if not yet decided"),
    Column(
        "file_line", INTEGER, "", "Number of the line (CSV) or row (Parquet) in the file of bundles"
    ),
    Column(
        "file_order", TEXT, "", "Text in the column `order` of the file of bundles; may be empty"
    ),
    Column("file_sku", TEXT, "", "Name of the SKU, or its number if it has no name"),
)
"""Columns of the table; further columns of the file follow, each as `file_NAME`."""

KEPT = ("sku", "units", "created_s", "stored_s", "pod", "station")
"""Columns copied from the table of bundles."""


def bundle_lines(logs: Logs) -> pd.DataFrame:
    """Return one row per bundle, for all bundles in the table `bundles` that come from a file."""
    stream = logs.recorder.bundle_stream
    bundles = seen_bundles(logs)
    bundles = bundles[bundles["in_file"] >= 0]
    if stream is None or stream.file is None or bundles.empty:
        return tidy("bundle_lines", BUNDLE_LINES, {column.name: [] for column in BUNDLE_LINES})
    file, line = stream.file, bundles["in_file"].to_numpy(np.int64)
    told = {
        **{name: bundles[name].to_numpy() for name in KEPT},
        "file_line": file.line[line],
        "file_order": np.array(file.names, dtype=object)[line],
        "file_sku": np.array(names_of_skus(logs.world.skus), dtype=object)[bundles["sku"]],
    }
    return with_columns_of(file, line, tidy("bundle_lines", BUNDLE_LINES, told))
