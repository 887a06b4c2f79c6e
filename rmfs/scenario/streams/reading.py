"""Reading of streams of orders and bundles from files."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from rmfs.errors import InputError
from rmfs.scenario.problems import Problems
from rmfs.scenario.streams.csv_file import read_csv
from rmfs.scenario.streams.rows import BundleRows, OrderRows
from rmfs.scenario.streams.times import is_number, parsed

if TYPE_CHECKING:
    from collections.abc import Sequence
    from datetime import datetime
    from pathlib import Path

    from rmfs.scenario.skus import SkuSet
    from rmfs.scenario.streams.rows import Rows
    from rmfs.scenario.streams.stream import BundleStream, OrderStream


def read_orders(
    path: Path, skus: SkuSet, zero: datetime | None = None, classes: tuple[str, ...] = ()
) -> OrderStream:
    """Read orders from a .csv or .parquet file.

    The columns, in any sequence, are `time` (s or ISO 8601, not decreasing), `order` (any name),
    `sku` (name or id of the SKU), `quantity` (units) and `due` (due time, in the format of `time`;
    may be empty or missing). The lines of an order must be consecutive. Further columns are kept in
    `OrderStream.file`.

    Parameters
    ----------
    zero
        Date and time of time zero, used if times are in ISO 8601. Default: midnight before the
        first order.
    classes
        Names of the classes of orders. If there are any, a column `priority` contains the class
        name of each order; the column may be missing, or empty for some orders.

    Raises
    ------
    InputError
        If the file cannot be read, or its contents are invalid; the message lists the first
        errors.
    """
    problems = Problems(path)
    rows = OrderRows(skus, problems, _word(path), zero, classes)
    _read(path, rows, problems)
    return replace(rows.builder.build(), file=rows.file.build())


def read_bundles(
    path: Path, skus: SkuSet, largest: float = math.inf, zero: datetime | None = None
) -> BundleStream:
    """Read bundles from a .csv or .parquet file.

    The columns, in any sequence, are `time` (s or ISO 8601, not decreasing), `sku` (name or id of
    the SKU) and `quantity` (units). Each line is a bundle. A column `order` may contain names of
    bundles; a column `due`, if present, must be empty. Further columns are kept in
    `BundleStream.file`.

    Parameters
    ----------
    largest
        Capacity of the largest pod, in space units; a larger bundle is an error.
    zero
        As for `read_orders`.

    Raises
    ------
    InputError
        If the file cannot be read, or its contents are invalid; the message lists the first
        errors.
    """
    problems = Problems(path)
    rows = BundleRows(skus, problems, _word(path), largest, zero)
    _read(path, rows, problems)
    return replace(rows.builder.build(), file=rows.file.build())


def first_moment(path: Path) -> datetime | None:
    """Return the time in the first row of a file; None if it is not a valid ISO 8601 time."""
    try:
        _read(path, _FirstMoment(), Problems(path))
    except _FoundError as found:
        return found.moment
    except InputError:  # reported when the file is read
        pass
    return None


class _FoundError(Exception):
    """Raised to stop reading after the first row."""

    def __init__(self, moment: datetime | None) -> None:
        self.moment = moment


class _FirstMoment:
    """Receiver that reads only the first row."""

    columns = ("time",)
    required = frozenset(("time",))

    def begin(self, further: Sequence[str]) -> None:
        """Ignore the additional columns (see `Rows`)."""

    def take(self, number: int, fields: Sequence[str]) -> None:
        """Stop reading after this row (see `Rows`)."""
        raise _FoundError(parsed(fields[0]) if not is_number(fields[0]) else None)

    def end(self) -> None:
        """Do nothing, as this is called only if the file has no rows."""


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
