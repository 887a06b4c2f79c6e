"""Streams from files that anybody wrote."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from rmfs.errors import InputError
from rmfs.scenario.problems import Problems
from rmfs.scenario.streams.csv_file import read_csv
from rmfs.scenario.streams.rows import BundleRows, OrderRows

if TYPE_CHECKING:
    from pathlib import Path

    from rmfs.scenario.skus import SkuSet
    from rmfs.scenario.streams.rows import Rows
    from rmfs.scenario.streams.stream import BundleStream, OrderStream


def read_orders(path: Path, skus: SkuSet) -> OrderStream:
    """Read orders from a .csv or .parquet file.

    The columns are time (s, not decreasing), order (any name), sku (its id), quantity (units) and
    due (s; may be empty or missing), in any order. An order's lines follow each other.

    Raises
    ------
    InputError
        One line that names the wrong lines, each with its column and the reason.
    """
    problems = Problems(path)
    rows = OrderRows(skus, problems, _word(path))
    _read(path, rows, problems)
    return rows.builder.build()


def read_bundles(path: Path, skus: SkuSet, largest: float = math.inf) -> BundleStream:
    """Read bundles from a .csv or .parquet file.

    The columns are time (s, not decreasing), sku (its id) and quantity (units), in any order; order
    (any name) may be there, due must be empty. Each line is a bundle.

    Parameters
    ----------
    largest
        Space units of the largest pod.

    Raises
    ------
    InputError
        One line that names the wrong lines, each with its column and the reason.
    """
    problems = Problems(path)
    rows = BundleRows(skus, problems, _word(path), largest)
    _read(path, rows, problems)
    return rows.builder.build()


def _word(path: Path) -> str:
    return "line" if path.suffix.lower() == ".csv" else "row"


def _read(path: Path, rows: Rows, problems: Problems) -> None:
    suffix = path.suffix.lower()
    try:
        if suffix == ".csv":
            read_csv(path, rows, problems)
        elif suffix == ".parquet":
            from rmfs.scenario.streams.parquet_file import read_parquet  # slow to import

            read_parquet(path, rows, problems)
        else:
            raise InputError(f"{path}: must end in .csv or .parquet")
    except FileNotFoundError:
        raise InputError(f"{path}: no such file") from None
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from None
    rows.end()
    problems.stop_if_any()
