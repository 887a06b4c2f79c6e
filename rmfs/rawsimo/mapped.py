"""How a column or file of RAWSim-O is paired with its counterpart in rmfs."""

from __future__ import annotations

from typing import NamedTuple


class Mapped(NamedTuple):
    """A footprint column or an output file of RAWSim-O, with its counterpart in rmfs.

    Attributes
    ----------
    theirs
        Name of the column or file in RAWSim-O.
    ours
        The counterpart in rmfs, or the reason why there is none. Text in backticks names a column
        of rmfs: a column of the footprint or, in the form `table.column`, of another table. The
        rest is prose.
    """

    theirs: str
    ours: str
