"""Conversion of a table to the declared order and types of its columns."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import pandas as pd

    from rmfs.measure.columns import Column


@cache
def _dtype(name: str) -> Any:
    """Return the pandas type `name`; cached, since the lookup takes longer than a conversion."""
    import pandas as pd

    return pd.api.types.pandas_dtype(name)


def tidy(
    table: str, declared: Sequence[Column], columns: Mapping[str, Any] | pd.DataFrame
) -> pd.DataFrame:
    """Return a frame with exactly the declared columns, in their order and with their types.

    Columns are converted one at a time, so that making a long table takes little more memory than
    the table itself.

    Parameters
    ----------
    table
        Name of the table in error messages.
    declared
        The columns of the result.
    columns
        Values of each column, by its name: an array, list or series, or a single value for all
        rows.

    Raises
    ------
    ValueError
        If a declared column is missing, or a given column is not declared.
    TypeError, ValueError, OverflowError
        If a value does not fit the declared type.
    """
    import pandas as pd

    described = {column.name: _dtype(column.dtype) for column in declared}
    wrong = described.keys() ^ set(columns.keys())
    if wrong:
        raise ValueError(f"table {table} and its dictionary differ in {', '.join(sorted(wrong))}")
    given = (columns[name] for name in described)
    rows = next(len(column) for column in given if pd.api.types.is_list_like(column))
    index = pd.RangeIndex(rows)
    made: dict[str, Any] = {}
    for name, dtype in described.items():
        column = columns[name]
        if isinstance(column, pd.Series):
            column = column.array
        made[name] = _of_type(column, dtype, rows)
        if made[name] is None:
            made[name] = pd.Series(column, index=index).astype(dtype)
    return pd.DataFrame(made, index=index, copy=False)


def _of_type(column: Any, dtype: Any, rows: int) -> Any:
    """Return a copy of a column if it already has the type (faster than pandas), else None."""
    if isinstance(column, np.ndarray) and column.dtype == dtype and column.shape == (rows,):
        return column.copy()
    if isinstance(column, list) and rows == 1 and _PLAIN.get(dtype) is type(column[0]):
        return np.array(column, dtype)
    return None


_PLAIN = {np.dtype(np.float64): float, np.dtype(np.int64): int}
"""For each column type, the Python type whose values it can store without a check."""
