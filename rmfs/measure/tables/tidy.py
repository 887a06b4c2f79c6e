"""Bringing a table into the order and the types that the data dictionary promises."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

import pandas as pd

from rmfs.measure.dictionary import TABLES

if TYPE_CHECKING:
    from collections.abc import Mapping


@cache
def _dtype(name: str) -> Any:
    """Return the type of that name; to look it up takes pandas longer than to convert to it."""
    return pd.api.types.pandas_dtype(name)


def tidy(table: str, columns: Mapping[str, Any] | pd.DataFrame) -> pd.DataFrame:
    """Return a frame with exactly the columns of the dictionary.

    Each column is brought into its type by itself, so that a long table takes little more memory
    while it is made than afterwards.

    Parameters
    ----------
    columns
        Arrays, lists or series of one length; a single value stands for a column of it.

    Raises
    ------
    ValueError
        If a column is missing or not in the dictionary: nothing is written that is not described.
    """
    described = {column.name: _dtype(column.dtype) for column in TABLES[table]}
    wrong = described.keys() ^ set(columns.keys())
    if wrong:
        raise ValueError(f"table {table} and its dictionary differ in {', '.join(sorted(wrong))}")
    given = (columns[name] for name in described)
    rows = next(len(column) for column in given if pd.api.types.is_list_like(column))
    index = pd.RangeIndex(rows)
    made = {}
    for name, dtype in described.items():
        column = columns[name]
        if isinstance(column, pd.Series):
            column = column.array
        made[name] = pd.Series(column, index=index).astype(dtype)
    return pd.DataFrame(made, copy=False)
