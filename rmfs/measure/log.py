"""Rows of fixed types in one growing block of memory.

A long run records millions of rows. As a tuple, each row would take about 200 bytes and consist of
several objects; a packed row takes only the bytes of its values, and columns can be extracted
without converting the values one by one.
"""

from __future__ import annotations

from struct import Struct
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

_CODES = {"f8": "d", "i4": "i", "i2": "h", "i1": "b", "?": "?"}
"""How `struct` writes each type of NumPy."""


class Log:
    """An append-only table.

    Parameters
    ----------
    columns
        Name and type of each column: `f8`, `i4`, `i2`, `i1` or `?`, as in NumPy.
    """

    def __init__(self, **columns: str) -> None:
        self._types = columns
        self._dtype = np.dtype([(name, f"<{kind}") for name, kind in columns.items()])
        self._pack = Struct("<" + "".join(_CODES[kind] for kind in columns.values())).pack
        self._rows = bytearray()

    def __getstate__(self) -> tuple[dict[str, str], bytes]:
        return self._types, bytes(self._rows)

    def __setstate__(self, state: tuple[dict[str, str], bytes]) -> None:
        types, rows = state
        self.__init__(**types)  # type: ignore[misc]
        self._rows[:] = rows

    def __deepcopy__(self, memo: dict[int, Any]) -> Log:
        # once through the memory: a fork copies what a run has written down so far
        copied = Log(**self._types)
        copied._rows[:] = self._rows
        return copied

    def __len__(self) -> int:
        return len(self._rows) // self._dtype.itemsize

    def add(self, *values: Any) -> None:
        """Append a row with one value per column.

        Raises
        ------
        struct.error
            If a number does not fit into its column.
        """
        self._rows += self._pack(*values)

    def columns(self) -> dict[str, NDArray[Any]]:
        """Return a copy of each column by name, as an array of shape (rows,); integers as int64."""
        rows = np.frombuffer(self._rows, self._dtype)
        kinds = {"i": np.dtype(np.int64)}
        # a view would prevent the block from growing
        return {
            name: rows[name].astype(kinds.get(dtype.kind, dtype))
            for name, (dtype, *_) in (self._dtype.fields or {}).items()
        }
