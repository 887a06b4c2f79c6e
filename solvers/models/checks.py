"""Validation of a model's input arrays; every error names the field."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

_FAR = 2**63


class ModelError(ValueError):
    """An input array or parameter that the model cannot accept.

    Parameters
    ----------
    field
        The field of the data class, such as ``"stock"``.
    problem
        What is wrong, and what would be valid.
    """

    def __init__(self, field: str, problem: str) -> None:
        self.field = field
        self.problem = problem
        super().__init__(f"{field}: {problem}")


def require(condition: bool, field: str, problem: str) -> None:
    """Raise a `ModelError` unless a condition holds.

    Parameters
    ----------
    condition
        The condition, which must be true.
    field
        The field that the condition is about.
    problem
        Message if the condition is false.

    Raises
    ------
    ModelError
        If the condition is false.
    """
    if not condition:
        raise ModelError(field, problem)


def integers(
    field: str,
    value: ArrayLike,
    shape: Sequence[int | None],
    *,
    low: int | None = None,
    high: int | None = None,
) -> NDArray[np.int64]:
    """Check and freeze an array of integers.

    Parameters
    ----------
    field
        Name of the field, for the error.
    value
        The array. Floats are accepted if they are whole; booleans become 0 and 1.
    shape
        Expected shape, with None for a dimension of any length.
    low, high
        Smallest and largest value allowed (both included). Default: no limit.

    Returns
    -------
    A read-only copy.

    Raises
    ------
    ModelError
        If the shape, the type or a value is wrong.
    """
    raw = _shaped(field, value, shape)
    if raw.dtype.kind not in "iub":
        whole = raw.dtype.kind == "f" and bool(np.all(np.isfinite(raw) & (raw == np.rint(raw))))
        # An empty list has no kind of its own: NumPy calls it float.
        require(whole or raw.size == 0, field, "must hold whole numbers")
    if raw.dtype.kind in "uf":
        # beyond, the conversion would wrap around
        require(bool(np.all(np.abs(raw.astype(np.float64)) < _FAR)), field, f"must be below {_FAR}")
    checked = raw.astype(np.int64, order="C")
    _within(field, checked, low, high)
    checked.setflags(write=False)
    return checked


def reals(
    field: str,
    value: ArrayLike,
    shape: Sequence[int | None],
    *,
    low: float | None = None,
    high: float | None = None,
) -> NDArray[np.float64]:
    """Check and freeze an array of finite real numbers.

    Parameters
    ----------
    field
        Name of the field, for the error.
    value
        The array.
    shape
        Expected shape, with None for a dimension of any length.
    low, high
        Smallest and largest value allowed (both included). Default: no limit.

    Returns
    -------
    A read-only copy.

    Raises
    ------
    ModelError
        If the shape, the type or a value is wrong, or a value is not finite.
    """
    raw = _shaped(field, value, shape)
    require(raw.dtype.kind in "iufb" or raw.size == 0, field, "must hold numbers")
    # by rows however it came: the order in memory is the order in which sums are rounded
    checked = raw.astype(np.float64, order="C")
    require(bool(np.all(np.isfinite(checked))), field, "must be finite")
    _within(field, checked, low, high)
    checked.setflags(write=False)
    return checked


def costs(
    field: str,
    value: ArrayLike,
    shape: tuple[int | None, ...],
    *,
    low: float | None = None,
) -> NDArray[np.float64]:
    """Check and freeze an array of costs in which +inf marks a forbidden choice.

    Parameters
    ----------
    field
        Name of the field, for the error.
    value
        The array.
    shape
        Expected shape, with None for a dimension of any length.
    low
        Smallest value allowed. Default: no limit.

    Returns
    -------
    A read-only copy.

    Raises
    ------
    ModelError
        If the shape, the type or a value is wrong; -inf and nan are wrong values.
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


def flags(field: str, value: ArrayLike, shape: Sequence[int | None]) -> NDArray[np.bool_]:
    """Check and freeze an array of truth values (or of zeros and ones).

    Parameters
    ----------
    field
        Name of the field, for the error.
    value
        The array.
    shape
        Expected shape, with None for a dimension of any length.

    Returns
    -------
    A read-only copy.

    Raises
    ------
    ModelError
        If the shape is wrong or a value is neither 0 nor 1.
    """
    checked = integers(field, value, shape, low=0, high=1).astype(np.bool_)
    checked.setflags(write=False)
    return checked


def number(
    field: str, value: float, *, low: float | None = None, high: float | None = None
) -> float:
    """Check one finite real parameter.

    Parameters
    ----------
    field
        Name of the field, for the error.
    value
        The parameter.
    low, high
        Smallest and largest value allowed (both included). Default: no limit.

    Returns
    -------
    The parameter as a float.

    Raises
    ------
    ModelError
        If the parameter is out of range or not finite.
    """
    return float(reals(field, value, (), low=low, high=high))


def _shaped(field: str, value: ArrayLike, shape: Sequence[int | None]) -> NDArray[Any]:
    """Make an array of the expected shape, or complain."""
    try:
        raw = np.asarray(value)
    except ValueError as error:
        raise ModelError(field, "has rows of different lengths") from error
    expected = tuple(shape)
    if raw.size == 0 and 0 in expected and raw.ndim < len(expected):
        # `[]` stands for an empty table of any width.
        raw = raw.reshape([0 if n is None else n for n in expected])
    fits = raw.ndim == len(expected) and all(
        want in (None, have) for want, have in zip(expected, raw.shape, strict=True)
    )
    wanted = "(" + ", ".join("any" if n is None else str(n) for n in expected) + ")"
    require(fits, field, f"shape must be {wanted}, is {raw.shape}")
    return raw


def _within(
    field: str,
    values: NDArray[np.int64] | NDArray[np.float64],
    low: float | None,
    high: float | None,
) -> None:
    """Complain about the first value out of range, with its index."""
    for limit, wrong, word in (
        (low, values < low if low is not None else None, "at least"),
        (high, values > high if high is not None else None, "at most"),
    ):
        if wrong is not None and bool(np.any(wrong)):
            at = tuple(int(i) for i in np.argwhere(wrong)[0])
            where = f"[{', '.join(map(str, at))}]" if at else ""
            raise ModelError(f"{field}{where}", f"must be {word} {limit}, is {values[at]}")
