"""The columns of a table of orders or bundles."""

from __future__ import annotations

import difflib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.scenario.streams.rows import Rows

MOST_ROWS = 5_000_000
"""Rows of a file: thirty times what ten busy pick stations handle in two days."""


class Columns:
    """Where in a row each column is.

    Parameters
    ----------
    names
        As the file gives them.
    rows
        What is to read the rows.

    Raises
    ------
    ValueError
        If a column is unknown, missing or there twice.
    """

    def __init__(self, names: Sequence[str], rows: Rows) -> None:
        valid = ", ".join(rows.columns)
        for name in names:
            if name not in rows.columns:
                near = difflib.get_close_matches(name, rows.columns, n=1)
                hint = f"did you mean {near[0]}?" if near else f"valid: {valid}"
                raise ValueError(f"unknown column {name!r:.40}; {hint}")
            if names.count(name) > 1:
                raise ValueError(f"column {name} comes twice")
        missing = [name for name in rows.columns if name in rows.required - set(names)]
        if missing:
            raise ValueError(f"column {missing[0]} is missing; valid: {valid}")
        self._width = len(names)
        self._at = [names.index(name) if name in names else -1 for name in rows.columns]

    def arranged(self, fields: Sequence[str]) -> list[str]:
        """Return the fields of a row in the order that is expected, empty where there is none.

        Raises
        ------
        ValueError
            If the row has another number of fields than the file has columns.
        """
        if len(fields) != self._width:
            raise ValueError(f"{len(fields)} fields, expected {self._width}")
        return [fields[at] if at >= 0 else "" for at in self._at]
