"""Reading of CSV files, with protection against oversized, invalid and binary files."""

from __future__ import annotations

import csv
from typing import TYPE_CHECKING

from rmfs.scenario.streams.columns import MOST_ROWS, Columns

if TYPE_CHECKING:
    from pathlib import Path

    from rmfs.scenario.problems import Problems
    from rmfs.scenario.streams.rows import Rows

LONGEST_LINE = 4096
"""Maximum length of a line in bytes."""


class _UnreadableError(ValueError):
    """The rest of the file cannot be read."""


def read_csv(path: Path, rows: Rows, problems: Problems) -> None:
    """Pass the rows of a CSV file to a receiver; line 1 contains the column names.

    A line is read only up to the maximum length (`LONGEST_LINE`), so memory is bounded. Errors in
    the contents are added to `problems`. Reading ends early if line 1 is invalid, if a line is too
    long or not text, or if the file has more than `MOST_ROWS` lines.

    Raises
    ------
    OSError
        If the file cannot be read.
    """
    columns: Columns | None = None
    number = 0
    with path.open("rb") as file:
        while raw := file.readline(LONGEST_LINE + 1):
            number += 1
            try:
                fields = _fields(raw, number)
                if columns is None:
                    columns = Columns(fields, rows)
                elif number > MOST_ROWS:
                    raise _UnreadableError(f"more than {MOST_ROWS} lines")
                elif fields:
                    rows.take(number, columns.arranged(fields))
            except csv.Error as error:
                problems.add(f"line {number}: {error}")
            except ValueError as error:
                problems.add(f"line {number}: {error}")
                if columns is None or isinstance(error, _UnreadableError):
                    return
    if columns is None:
        problems.add("empty; line 1 must hold the names of the columns")


def _fields(raw: bytes, number: int) -> list[str]:
    if len(raw) > LONGEST_LINE:
        raise _UnreadableError(f"longer than {LONGEST_LINE} bytes")
    if b"\0" in raw:
        raise _UnreadableError("is not text: contains a zero byte")
    try:
        text = raw.decode("utf-8-sig" if number == 1 else "utf-8")
    except UnicodeDecodeError:
        raise _UnreadableError("is not UTF-8 text") from None
    text = text.strip("\r\n")
    if '"' in text or "\r" in text or not text:
        found = next(csv.reader([text], strict=True), [])
    else:
        found = text.split(",")  # the same, but faster
    return [field.strip() for field in found]
