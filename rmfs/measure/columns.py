"""Descriptions of columns for the data dictionary."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, Literal

if TYPE_CHECKING:
    from collections.abc import Mapping

INTEGER = "int64"
COUNT_OR_EMPTY = "Int64"
REAL = "float64"
TEXT = "str"
FLAG = "bool"

DTYPES = (INTEGER, COUNT_OR_EMPTY, REAL, TEXT, FLAG)
NUMBERS = (INTEGER, COUNT_OR_EMPTY, REAL)
"""The types for which means are computed."""

Better = Literal["more", "less", "neither"]

MORE: Better = "more"
LESS: Better = "less"
NEITHER: Better = "neither"


@dataclass(frozen=True, slots=True)
class Column:
    """Description of a column of a table.

    Attributes
    ----------
    name
        Name of the column. Most names of times, lengths, rates and shares end with a suffix for the
        unit: `_s`, `_m`, `_per_h`, or `_share` (from 0 to 1).
    dtype
        The pandas type of the column, one of `DTYPES`.
    unit
        Unit as text, such as "s" or "orders"; empty for names and identifiers.
    meaning
        Definition of the values. If cells can be empty, the definition also states when.
    measured
        Whether the values depend on the machine and are therefore not reproducible.
    better
        "more" if larger values are better for a warehouse, "less" if smaller values are better, and
        "neither" if the column is only descriptive.
    """

    name: str
    dtype: str
    unit: str
    meaning: str
    measured: bool = False
    better: Better = NEITHER

    @property
    def is_number(self) -> bool:
        """Whether the column holds numbers, of which means can be computed."""
        return self.dtype in NUMBERS

    def to_table(self) -> dict[str, Any]:
        """Return all attributes as a dictionary that can be written as JSON."""
        return asdict(self)

    @classmethod
    def from_table(cls, table: Mapping[str, Any]) -> Column:
        """Create a column from the result of `to_table`."""
        return cls(**table)
