"""The columns of a table of orders or bundles."""

from __future__ import annotations

import difflib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.scenario.streams.rows import Rows

MOST_ROWS = 5_000_000
"""Maximum number of rows of a file: thirty times what ten busy pick stations handle in two days."""


class Columns:
    """The positions of the columns in the rows of a file.

    Columns whose names are not known to rmfs are additional columns of the user. A column without a
    name, such as the index that pandas writes, is ignored.

    Parameters
    ----------
    names
        Names of the columns in the file.
    rows
        Receiver of the rows; its method `begin` is called with the names of the additional columns.

    Raises
    ------
    ValueError
        If a required column is missing, a column occurs twice, or a name looks misspelt.
    """

    def __init__(self, names: Sequence[str], rows: Rows) -> None:
        valid = ", ".join(rows.columns)
        missing = [name for name in rows.columns if name not in names]
        further = [at for at, name in enumerate(names) if name and name not in rows.columns]
        for name in (names[at] for at in further):
            near = difflib.get_close_matches(name, missing, n=1)
            if near:
                raise ValueError(f"unknown column {name!r:.40}; did you mean {near[0]}?")
        for name in names:
            if name and names.count(name) > 1:
                raise ValueError(f"column {name} occurs twice")
        needed = [name for name in missing if name in rows.required]
        if needed:
            found = ", ".join(names) or "none"
            raise ValueError(
                f"column {needed[0]} is missing; valid: {valid}, separated by commas, and columns "
                f"of your own (given: {found:.100})"
            )
        self._width = len(names)
        known = [names.index(name) if name in names else -1 for name in rows.columns]
        self._at = [*known, *further]
        rows.begin([names[at] for at in further])

    def arranged(self, fields: Sequence[str]) -> list[str]:
        """Return the fields of a row as `Rows.take` expects them; missing columns are empty.

        Raises
        ------
        ValueError
            If the number of fields differs from the number of columns.
        """
        if len(fields) != self._width:
            raise ValueError(f"{len(fields)} fields, expected {self._width}")
        return [fields[at] if at >= 0 else "" for at in self._at]
