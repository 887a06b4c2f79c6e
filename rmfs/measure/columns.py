"""What the data dictionary says of one column."""

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
"""The types of which means are taken."""

Better = Literal["more", "less", "neither"]

MORE: Better = "more"
LESS: Better = "less"
NEITHER: Better = "neither"


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
    better
        What a good warehouse has of it: more, less, or neither if it only describes.
    """

    name: str
    dtype: str
    unit: str
    meaning: str
    measured: bool = False
    better: Better = NEITHER

    @property
    def is_number(self) -> bool:
        """Whether means can be taken of it."""
        return self.dtype in NUMBERS

    def to_table(self) -> dict[str, Any]:
        """Everything, as JSON can say it."""
        return asdict(self)

    @classmethod
    def from_table(cls, table: Mapping[str, Any]) -> Column:
        """Read what `to_table` gave."""
        return cls(**table)
