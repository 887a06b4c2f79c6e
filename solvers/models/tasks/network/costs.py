"""Cost tables in which an infinite entry forbids a pair."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from solvers.models.checks import reals, require


def costs(
    field: str,
    value: ArrayLike,
    shape: tuple[int | None, ...],
    *,
    low: float | None = None,
) -> NDArray[np.float64]:
    """Check and freeze an array of costs in which +inf means "not allowed".

    Parameters
    ----------
    field
        Name of the field, for the error.
    value
        The array.
    shape
        Expected shape; None in a place accepts any length there.
    low
        Smallest value allowed. Default: no limit.

    Returns
    -------
    A read-only copy.

    Raises
    ------
    ModelError
        If the shape, the kind or a value is wrong; -inf and nan are.
    """
    raw = np.asarray(value)
    # the kind is left to `reals`, which says what is wrong with it
    numeric = raw.dtype.kind in "iufb"
    forbidden = np.isposinf(raw.astype(np.float64)) if numeric else np.zeros(raw.shape, bool)
    placeholder = 0.0 if low is None else low
    checked = reals(field, np.where(forbidden, placeholder, raw), shape, low=low).copy()
    checked[np.reshape(forbidden, checked.shape)] = np.inf
    require(not np.isnan(checked).any(), field, "must be numbers")
    checked.setflags(write=False)
    return checked
