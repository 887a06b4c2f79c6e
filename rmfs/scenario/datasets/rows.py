"""Rows of the CSV files of public data sets, with fields by column name."""

from __future__ import annotations

import csv
from datetime import datetime
from itertools import chain
from typing import TYPE_CHECKING

from rmfs.errors import InputError
from rmfs.scenario.streams.times import parsed

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

MOST_UNITS = 1_000_000
LONGEST_NAME = 200


class Row:
    """A row with its position in the file.

    Parameters
    ----------
    path, line
        Position of the row, for messages.
    fields
        Fields by column.
    """

    __slots__ = ("_fields", "line", "path")

    def __init__(self, path: Path, line: int, fields: dict[str, str]) -> None:
        self.path, self.line, self._fields = path, line, fields

    def text(self, column: str) -> str:
        """Return a field as text."""
        return self._fields[column]

    def name(self, column: str) -> str:
        """Return a field that contains a name.

        Raises
        ------
        InputError
            If the field is empty or too long.
        """
        text = self._fields[column]
        if not 0 < len(text) <= LONGEST_NAME:
            raise self.wrong(column, f"must have 1 to {LONGEST_NAME} characters")
        return text

    def whole(self, column: str, least: int, most: int = MOST_UNITS) -> int:
        """Return a field that contains a whole number from `least` to `most`.

        Raises
        ------
        InputError
            If the field is not a whole number, or the number is out of bounds.
        """
        text = self._fields[column]
        digits = text.removeprefix("-")
        number = int(text) if digits.isdecimal() and digits.isascii() and len(digits) < 16 else None
        if number is None or not least <= number <= most:
            raise self.wrong(column, f"must be a whole number from {least} to {most}")
        return number

    def moment(self, column: str, *further: str) -> datetime:
        """Return a field that contains a time without time zone.

        Parameters
        ----------
        further
            Formats (as for `strptime`) that are accepted in addition to ISO 8601.

        Raises
        ------
        InputError
            If the field is not such a time.
        """
        text = self._fields[column]
        moment = parsed(text)
        for form in further if moment is None else ():
            try:
                moment = datetime.strptime(text, form)
                break
            except ValueError:
                continue
        if moment is None or moment.tzinfo is not None:
            raise self.wrong(column, "must be a time such as 2018-03-01 17:14:25")
        return moment

    def wrong(self, column: str, why: str) -> InputError:
        """Return an error that states what is wrong with a field."""
        given = self._fields[column]
        return InputError(f"{self.path}: line {self.line}: {column} {why} (given: {given!r:.40})")


def rows(path: Path, columns: Sequence[str], encoding: str = "utf-8-sig") -> Iterator[Row]:
    """Read a CSV file row by row; columns that are not required are ignored.

    Parameters
    ----------
    columns
        Required columns. `a|b` means a column named a or b; each `Row` uses the name a for it.

    Raises
    ------
    InputError
        If the file cannot be read, a required column is missing or occurs twice, or a row is
        invalid. The message names the file and, if a column or a row is wrong, the line.
    """
    reader = None
    try:
        with path.open(encoding=encoding, newline="") as file:
            reader = csv.reader(file, strict=True)
            names = [name.strip() for name in next(reader, [])]
            at = _places(path, names, columns)
            width = len(names)
            for fields in reader:
                if not fields:
                    continue
                if len(fields) != width:
                    told = f"{len(fields)} fields, expected {width}"
                    raise InputError(f"{path}: line {reader.line_num}: {told}")
                found = {name: fields[place].strip() for name, place in at.items()}
                yield Row(path, reader.line_num, found)
    except FileNotFoundError:
        raise InputError(f"{path}: no such file") from None
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from None
    except UnicodeDecodeError:
        raise InputError(f"{path}: is not UTF-8 text") from None
    except csv.Error as error:
        line = reader.line_num if reader is not None else 1
        raise InputError(f"{path}: line {line}: {error}") from None


def _places(path: Path, names: list[str], columns: Sequence[str]) -> dict[str, int]:
    """Return the position of each column, by its first name."""
    places: dict[str, int] = {}
    for column in columns:
        either = column.split("|")
        found = [name for name in either if name in names]
        if not found or names.count(found[0]) > 1:
            what = "occurs twice" if found else "is missing"
            needed = ", ".join(chain.from_iterable(one.split("|")[:1] for one in columns))
            raise InputError(
                f"{path}: line 1: column {either[0]} {what}; needed: {needed} (given: "
                f"{', '.join(names)!s:.100})"
            )
        places[either[0]] = names.index(found[0])
    return places
