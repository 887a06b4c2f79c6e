"""Pickling arrays that share memory: a view stays a view of the copy of its base."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
from numpy.typing import NDArray


class ArrayPickler(pickle.Pickler):
    """Pickles views of arrays as views, where NumPy alone makes independent copies of them."""

    def __init__(self, stream: Any) -> None:
        super().__init__(stream, protocol=5)

    def reducer_override(self, thing: Any) -> Any:
        """Reduce a view to its base, and where in it the view begins."""
        if type(thing) is not np.ndarray or type(thing.base) is not np.ndarray:
            return NotImplemented
        base: NDArray[Any] = thing.base
        if not base.flags.c_contiguous or base.dtype.hasobject:
            return NotImplemented
        begin = thing.__array_interface__["data"][0] - base.__array_interface__["data"][0]
        shape = (thing.dtype.str, thing.shape, thing.strides, begin, thing.flags.writeable)
        return _view, (base, *shape)


def _view(
    base: NDArray[Any],
    dtype: str,
    shape: tuple[int, ...],
    strides: tuple[int, ...],
    begin: int,
    writeable: bool,
) -> NDArray[Any]:
    """Make the view again."""
    view: NDArray[Any] = np.ndarray(shape, dtype, base, begin, strides)
    view.flags.writeable = writeable
    return view
