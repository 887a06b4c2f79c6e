"""Bringing a table into the order and the types that its declaration promises."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import pandas as pd

    from rmfs.measure.columns import Column


@cache
def _dtype(name: str) -> Any:
    """Return the type of that name; to look it up takes pandas longer than to convert to it."""
    import pandas as pd

    return pd.api.types.pandas_dtype(name)


def tidy(
    table: str, declared: Sequence[Column], columns: Mapping[str, Any] | pd.DataFrame
) -> pd.DataFrame:
    """Return a frame with exactly the columns declared.

    Each column is brought into its type by itself, so that a long table takes little more memory
    while it is made than afterwards.

    Parameters
    ----------
    table
        Its name, for errors.
    columns
        Arrays, lists or series of one length; a single value stands for a column of it.

    Raises
    ------
    ValueError
        If a column is missing or not declared: nothing is written that is not described.
    """
    import pandas as pd

    described = {column.name: _dtype(column.dtype) for column in declared}
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
