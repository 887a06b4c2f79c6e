"""What the data dictionary says of one column."""

from __future__ import annotations

from dataclasses import dataclass

INTEGER = "int64"
COUNT_OR_EMPTY = "Int64"
REAL = "float64"
TEXT = "str"
FLAG = "bool"


@dataclass(frozen=True, slots=True)
class Column:
    """One column of a table.

    Attributes
    ----------
    name
        Ends with the unit where there is one: `_s`, `_m`, `_h` (per hour), `_share` (0 to 1).
    dtype
        The pandas type it is written in.
    unit
        Unit in words, or empty for names and identifiers.
    meaning
        Definition; empty cells are explained where they can occur.
    measured
        Whether it depends on the machine and the moment, and so does not repeat.
    """

    name: str
    dtype: str
    unit: str
    meaning: str
    measured: bool = False
