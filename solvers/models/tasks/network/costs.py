"""Cost tables in which an infinite entry forbids a pair."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from solvers.models.checks import reals


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
    if raw.dtype.kind != "f":
        # no infinity among whole numbers; what is no number is refused here
        return reals(field, value, shape, low=low)
    forbidden = np.isposinf(raw)
    checked = reals(field, np.where(forbidden, low or 0.0, raw), shape, low=low).copy()
    checked[np.reshape(forbidden, checked.shape)] = np.inf
    checked.setflags(write=False)
    return checked
