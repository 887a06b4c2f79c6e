"""SKU sets as CSV or Parquet files with a row per SKU."""

from __future__ import annotations

import csv
import io
import math
from collections import Counter
from typing import TYPE_CHECKING

import numpy as np

from rmfs.errors import InputError
from rmfs.files import read_bounded
from rmfs.scenario.skus.content import SkuFileContent

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

COLUMNS = ("sku", "popularity", "space_per_unit", "bundle_units")
"""Columns that are read; other columns are ignored."""

LONGEST_NAME = 200
MOST_UNITS = 1_000_000


def read_sku_table(path: Path) -> SkuFileContent:
    """Read a SKU table: the column `sku` and, if present, the other `COLUMNS`.

    If all entries of `sku` are whole numbers, they are the ids of the SKUs; otherwise the SKUs are
    numbered from 0, and the entries become their names. Without a column `popularity`, all SKUs are
    equally popular. A file of orders (with columns `order` and `quantity`) is also accepted: the
    popularity of a SKU is then its number of order lines.

    Raises
    ------
    InputError
        If the file cannot be read or its contents are invalid; for an invalid field, the message
        names the line.
    """
    rows = _rows(path)
    head = next(rows, (1, []))[1]
    known = {column: head.index(column) for column in COLUMNS if column in head}
    doubles = sorted({column for column in known if head.count(column) > 1})
    if "sku" not in known or doubles:
        wrong = f"column {doubles[0]} occurs twice" if doubles else "column sku is missing"
        raise InputError(f"{path}: line 1: {wrong}; columns: {', '.join(COLUMNS)}")
    found: dict[str, list[str]] = {column: [] for column in known}
    lines: list[int] = []
    for line, fields in rows:
        if len(fields) != len(head):
            raise InputError(f"{path}: line {line}: {len(fields)} fields, expected {len(head)}")
        lines.append(line)
        for column, place in known.items():
            found[column].append(fields[place])
    if not lines:
        raise InputError(f"{path}: contains no SKU")
    if {"order", "quantity"} <= set(head) and known.keys() == {"sku"}:
        found, lines = _ordered(found["sku"], lines)
    ids, names = _named(found["sku"], lines, path)
    popularity = _numbers(found, "popularity", lines, path, least=0.0)
    if popularity is not None and not popularity.any():
        raise InputError(f"{path}: popularity: at least one value must be positive")
    space = _numbers(found, "space_per_unit", lines, path, least=np.nextafter(0.0, 1.0))
    units = _numbers(found, "bundle_units", lines, path, least=1.0, whole=True)
    return SkuFileContent(
        ids=ids,
        popularity=np.ones(len(ids)) if popularity is None else popularity,
        space_per_unit=space,
        bundle_units=None if units is None else units.astype(np.int64),
        names=names,
    )


def _ordered(skus: list[str], lines: list[int]) -> tuple[dict[str, list[str]], list[int]]:
    """Return the columns of the SKUs in order lines, and the line where each SKU first occurs."""
    first: dict[str, int] = {}
    for sku, line in zip(skus, lines, strict=True):
        first.setdefault(sku, line)
    often = Counter(skus)
    columns = {"sku": list(first), "popularity": [str(often[sku]) for sku in first]}
    return columns, list(first.values())


def _rows(path: Path) -> Iterator[tuple[int, list[str]]]:
    """Yield line number and fields of every row that is not empty.

    The rows of a Parquet file are numbered like the lines of a CSV file with the same rows.
    """
    if path.suffix.lower() == ".parquet":
        from rmfs.scenario.streams.parquet_file import parquet_rows  # slow to import

        yield from enumerate(parquet_rows(path), start=1)
        return
    try:
        text = read_bounded(path).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise InputError(f"{path}: is not UTF-8 text") from None
    reader = csv.reader(io.StringIO(text, newline=""), strict=True)
    try:
        for fields in reader:
            if fields:
                yield reader.line_num, [field.strip() for field in fields]
    except csv.Error as error:
        raise InputError(f"{path}: line {reader.line_num}: {error}") from None


def _named(
    texts: list[str], lines: list[int], path: Path
) -> tuple[np.ndarray[tuple[int], np.dtype[np.int64]], tuple[str, ...]]:
    """Return the ids of SKUs, and their names; no names if all texts are whole numbers."""
    seen: set[str] = set()
    for line, text in zip(lines, texts, strict=True):
        if not text or len(text) > LONGEST_NAME:
            raise InputError(f"{path}: line {line}: sku must have 1 to {LONGEST_NAME} characters")
        if text in seen:
            raise InputError(f"{path}: line {line}: sku {text:.40} occurs twice")
        seen.add(text)
    if all(text.isascii() and text.isdecimal() and len(text) < 16 for text in texts):
        numbers = [int(text) for text in texts]
        if [str(number) for number in numbers] == texts:
            return np.array(numbers, dtype=np.int64), ()
    return np.arange(len(texts), dtype=np.int64), tuple(texts)


def _numbers(
    found: dict[str, list[str]],
    column: str,
    lines: list[int],
    path: Path,
    *,
    least: float,
    whole: bool = False,
) -> np.ndarray[tuple[int], np.dtype[np.float64]] | None:
    """Return a column of numbers; None if the file has no column of that name."""
    if column not in found:
        return None
    made = []
    for line, text in zip(lines, found[column], strict=True):
        try:
            number = math.nan if "_" in text else float(text)
        except ValueError:
            number = math.nan
        if not (least <= number < math.inf) or (whole and (number % 1 or number > MOST_UNITS)):
            kind = f"a whole number from 1 to {MOST_UNITS}" if whole else "a positive number"
            raise InputError(f"{path}: line {line}: {column} must be {kind} (given: {text!r:.40})")
        made.append(number)
    return np.array(made, dtype=np.float64)
