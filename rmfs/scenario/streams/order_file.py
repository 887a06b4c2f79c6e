"""Names and additional columns of orders in a file, kept for joining results to the file."""

from __future__ import annotations

from array import array
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class OrderFile:
    """Names and additional columns of n orders with a total of m lines, as in their file.

    A file of bundles is represented in the same way: each bundle counts as an order of one line.

    Attributes
    ----------
    names
        Name of each of the n orders.
    line
        For each order line, the number of its line (CSV) or row (Parquet) in the file, shape (m,).
    columns
        The m texts of each additional column, by column name. They are stored as a pair: an array
        of indices, shape (m,), and the tuple of distinct texts to which the indices refer.
    """

    names: tuple[str, ...]
    line: NDArray[np.int64]
    columns: dict[str, tuple[NDArray[np.int32], tuple[str, ...]]]


class OrderFileBuilder:
    """Builds an `OrderFile`; each repetition of a text in an additional column takes only 4 bytes.

    Parameters
    ----------
    columns
        Names of the additional columns of the file.
    """

    def __init__(self, columns: Sequence[str]) -> None:
        self._columns = columns
        self._names: list[str] = []
        self._line = array("q")
        self._codes = [array("i") for _ in columns]
        self._texts: list[dict[str, int]] = [{} for _ in columns]

    def add_order(self, name: str) -> None:
        """Start an order."""
        self._names.append(name)

    def add_line(self, number: int, further: Sequence[str]) -> None:
        """Add a line to the last order.

        Parameters
        ----------
        number
            Number of the line (CSV) or row (Parquet) in the file.
        further
            Fields of the additional columns.
        """
        self._line.append(number)
        for codes, texts, text in zip(self._codes, self._texts, further, strict=True):
            codes.append(texts.setdefault(text, len(texts)))

    def build(self) -> OrderFile:
        """Return the `OrderFile` of the orders and lines added."""
        columns = {
            name: (np.array(codes, dtype=np.int32), tuple(texts))
            for name, codes, texts in zip(self._columns, self._codes, self._texts, strict=True)
        }
        return OrderFile(tuple(self._names), np.array(self._line, dtype=np.int64), columns)
