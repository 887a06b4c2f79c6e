"""Pickling of arrays that share memory: the copy of a view is a view of the copied array."""

from __future__ import annotations

import copyreg
import pickle
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from collections.abc import Callable


class ArrayPickler(pickle.Pickler):
    """Pickler that keeps views of arrays as views; NumPy alone would make independent copies.

    Parameters
    ----------
    aside
        Function that receives the contents of arrays, which are then left out of the pickled
        stream. Default: the stream includes these contents.
    """

    def __init__(
        self, stream: Any, aside: Callable[[pickle.PickleBuffer], object] | None = None
    ) -> None:
        super().__init__(stream, protocol=5, buffer_callback=aside)
        # looked up by type: nothing is called for the many small objects of a run
        self.dispatch_table: dict[type, Any] = dict(copyreg.dispatch_table)
        self.dispatch_table[np.ndarray] = _reduced


def _reduced(array: NDArray[Any]) -> Any:
    """Reduce a view to its base array and the position in the base at which the view begins."""
    base = array.base
    if type(base) is not np.ndarray or not base.flags.c_contiguous or base.dtype.hasobject:
        return array.__reduce_ex__(5)
    begin = array.__array_interface__["data"][0] - base.__array_interface__["data"][0]
    shape = (array.dtype.str, array.shape, array.strides, begin, array.flags.writeable)
    return _view, (base, *shape)


def _view(
    base: NDArray[Any],
    dtype: str,
    shape: tuple[int, ...],
    strides: tuple[int, ...],
    begin: int,
    writeable: bool,
) -> NDArray[Any]:
    """Restore a view of a base array."""
    view: NDArray[Any] = np.ndarray(shape, dtype, base, begin, strides)
    view.flags.writeable = writeable
    return view
