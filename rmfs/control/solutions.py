"""Recording of optimisers' solutions as text; numbers are preserved to the last bit."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rmfs.control.asks import Plain

_ARRAY = "array"


def to_text(solution: Mapping[str, Plain]) -> str:
    """Return a solution as JSON; `from_text` restores arrays with their type and shape.

    Raises
    ------
    TypeError
        If the solution contains a value of a type that is not supported. Supported are JSON values,
        tuples, and NumPy arrays and scalars that consist of real numbers, truth values or strings.
    """
    return json.dumps({str(name): value for name, value in solution.items()}, default=_plain)


def from_text(text: str) -> dict[str, Any]:
    """Restore a solution from the text that `to_text` has returned.

    Tuples are returned as lists, and NumPy scalars as Python values.
    """
    solution: dict[str, Any] = json.loads(text, object_hook=_array)
    return solution


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray) and value.dtype.kind in "biufU":
        told = {"dtype": value.dtype.str, "shape": value.shape, "values": value.ravel().tolist()}
        return {_ARRAY: told}
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"a solution contains a {type(value).__name__}: only plain values may be used")


def _array(table: dict[str, Any]) -> Any:
    if table.keys() != {_ARRAY}:
        return table
    told = table[_ARRAY]
    return np.array(told["values"], dtype=told["dtype"]).reshape(told["shape"])
