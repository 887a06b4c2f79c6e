"""Conversion of fields to and from JSON without loss, and the hash that names a question.

Integers stay integers. Other numbers are written with the fewest digits that read back as the same
double (Python's `repr`), and as `"inf"` or `"-inf"` if they are infinite. A large array with mostly
equal entries, or one without rows, is written as `{"shape": [...], "all": V, "at": [...], "values":
[...]}`. The entries at the positions `at` are given in `values`, and all others are V. Positions
are counted row by row.
"""

from __future__ import annotations

import hashlib
import itertools
import json
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.errors import InputError
from rmfs.solvers.decisions.schema import KINDS, SCHEMAS, sizes

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from rmfs.solvers.decisions.schema import Field, Plain, Schema

SPARSE_FROM = 64
"""Minimum number of entries of an array that may be written in the short form."""

_REAL = {"real", "cost", "worth", "ms", "cost_ms", "space"}
_INFINITE = {"cost": math.inf, "cost_ms": math.inf, "worth": -math.inf}
_PARTS = {"ms": 1000, "cost_ms": 1000, "space": 16}
_LARGEST = 2**53
"""Largest integer that every JSON reader represents exactly."""


def content_hash(family: str, data: Plain) -> str:
    """Return the hash of a question: SHA-256 of its canonical JSON.

    The canonical JSON is `{"data":{...},"family":"..."}` without blanks and with sorted keys.
    Absent fields are left out, and every array is written in full.

    Parameters
    ----------
    family
        The family of the question.
    data
        The fields of the question.
    """
    full = encoded(SCHEMAS[family].data, data, sparse=False)
    text = json.dumps({"family": family, "data": full}, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()


def encoded(fields: tuple[Field, ...], plain: Plain, *, sparse: bool = True) -> dict[str, Any]:
    """Return fields in the form in which JSON stores them.

    Parameters
    ----------
    fields
        Definitions of the fields to encode.
    plain
        Values of the fields, by name.
    sparse
        Whether arrays with mostly equal entries may be written in short form. Default: yes.
    """
    found: dict[str, Any] = {}
    for field in fields:
        value = plain.get(field.name)
        if value is not None:
            found[field.name] = _encoded(field, value, sparse=sparse)
    return found


def decoded(
    where: str, schema: Schema, part: str, raw: Any, known: Mapping[str, int] | None = None
) -> Plain:
    """Read the fields of a question or an answer.

    Parameters
    ----------
    where
        Name of the file or object, for errors.
    schema
        Definition of the family's fields.
    part
        `data` for a question, `values` for an answer.
    raw
        The parsed JSON.
    known
        Sizes of dimensions that are already known (for an answer: those of its question).

    Raises
    ------
    InputError
        If a field is missing, unknown, of the wrong shape, or has an invalid value.
    """
    fields: tuple[Field, ...] = getattr(schema, part)
    if not isinstance(raw, dict):
        raise InputError(f"{where}: {part}: must be an object with the fields of the family")
    unknown = raw.keys() - {field.name for field in fields}
    if unknown:
        valid = ", ".join(field.name for field in fields)
        raise InputError(f"{where}: {part}.{min(unknown)}: unknown field; valid: {valid}")
    plain: Plain = {}
    for field in fields:
        if raw.get(field.name) is None:
            if not field.optional:
                raise InputError(f"{where}: {part}.{field.name}: is missing")
            plain[field.name] = None
            continue
        try:
            plain[field.name] = _decoded(field, raw[field.name])
        except _WrongError as error:
            raise InputError(f"{where}: {part}.{field.name}: {error}") from None
    _check_shapes(where, schema, part, plain, dict(known or {}))
    return plain


class _WrongError(ValueError):
    """What is wrong with one field."""


def _encoded(field: Field, value: Any, *, sparse: bool) -> Any:
    if field.kind == "text":
        return str(value)
    if field.kind == "lists":
        return [[int(one) for one in row] for row in value]
    kind = np.float64 if field.kind in _REAL else np.int64
    array = np.asarray(value).astype(kind)
    if array.ndim == 2 and not len(array):
        # nested lists without rows do not tell how wide they are
        return {"shape": list(array.shape), "all": 0, "at": [], "values": []}
    if not sparse or array.size < SPARSE_FROM:
        return _listed(array)
    usual, count = _most_frequent(array)
    if 3 * (array.size - count) > array.size:
        return _listed(array)
    at = np.flatnonzero(~_same(array.ravel(), usual))
    return {
        "shape": list(array.shape),
        "all": _listed(np.asarray(usual)),
        "at": at.tolist(),
        "values": _listed(array.ravel()[at]),
    }


def _same(array: NDArray[Any], value: Any) -> NDArray[np.bool_]:
    """Return which entries equal a value; zeros must also have the same sign."""
    same: NDArray[np.bool_] = array == value
    if array.dtype.kind == "f":
        same &= np.signbit(array) == np.signbit(value)
    return same


def _most_frequent(array: NDArray[Any]) -> tuple[Any, int]:
    usual = np.unique_counts(array.ravel())
    value = usual.values[usual.counts.argmax()]
    return value, int(np.count_nonzero(_same(array, value)))


def _listed(array: NDArray[Any]) -> Any:
    """Return nested lists, with infinity as text, because JSON has no infinity."""
    if array.dtype.kind == "f" and np.isinf(array).any():
        texts = array.astype(object)
        texts[np.isposinf(array)] = "inf"
        texts[np.isneginf(array)] = "-inf"
        return texts.tolist() if array.ndim else texts.item()
    return array.tolist()


def _decoded(field: Field, raw: Any) -> Any:
    if field.kind == "text":
        if raw not in field.texts:
            raise _WrongError(f"must be one of {', '.join(field.texts)}")
        return raw
    if field.kind == "lists":
        if not isinstance(raw, list) or not all(isinstance(row, list) for row in raw):
            raise _WrongError(f"must be {KINDS['lists']}")
        return [_numbers(field, row, 1).tolist() for row in raw]
    dimensions = len(field.shape.split())
    if isinstance(raw, dict):
        return _filled(field, raw, dimensions)
    array = _numbers(field, raw, dimensions)
    return array if dimensions else array.item()


def _filled(field: Field, raw: dict[str, Any], dimensions: int) -> NDArray[Any]:
    """Read an array that is written in the short form."""
    if raw.keys() != {"shape", "all", "at", "values"}:
        raise _WrongError("must be lists, or an object with shape, all, at and values")
    shape, at = raw["shape"], raw["at"]
    if not (isinstance(shape, list) and len(shape) == dimensions):
        raise _WrongError(f"shape must name {dimensions} sizes")
    if not all(type(one) is int and 0 <= one <= _LARGEST for one in shape):
        raise _WrongError("shape must hold whole numbers, 0 or more")
    size = math.prod(shape)
    if size > _LARGEST_ARRAY:
        raise _WrongError(f"has more than {_LARGEST_ARRAY} entries")
    values = _numbers(field, raw["values"], 1)
    rising = isinstance(at, list) and all(type(one) is int for one in at)
    if not rising or len(at) != len(values) or any(a >= b for a, b in itertools.pairwise(at)):
        raise _WrongError("at must hold ascending positions, one for each of values")
    if at and not (at[0] >= 0 and at[-1] < size):
        raise _WrongError(f"at must hold positions from 0 to {size - 1}")
    array = np.full(size, _numbers(field, raw["all"], 0), dtype=values.dtype)
    array[at] = values
    return array.reshape(shape)


_LARGEST_ARRAY = 50_000_000


def _numbers(field: Field, raw: Any, dimensions: int) -> NDArray[Any]:
    """Read nested lists of numbers of the kind of a field."""
    real = field.kind in _REAL
    flat: list[Any] = []
    shape = _flatten(raw, dimensions, flat)
    for one in flat:
        if type(one) is not int and not (real and (type(one) is float or _is_infinite(field, one))):
            raise _WrongError(f"must hold {KINDS[field.kind]}, not {str(one)[:40]!r}")
        if type(one) is int and abs(one) > _LARGEST:
            raise _WrongError(f"{str(one)[:40]} is too large")
    if not real:
        array = np.array(flat, np.int64).reshape(shape)
        if field.kind == "flag" and ((array < 0) | (array > 1)).any():
            raise _WrongError("must hold 0 or 1")
        return array
    reals = np.array([float(one) for one in flat], np.float64).reshape(shape)
    if np.isnan(reals).any() or (np.isinf(reals) & (reals != _INFINITE.get(field.kind))).any():
        raise _WrongError(f"must hold {KINDS[field.kind]}; nan and other infinities are invalid")
    if field.kind in _PARTS:
        finite, parts = reals[np.isfinite(reals)], _PARTS[field.kind]
        if (np.rint(finite * parts) / parts != finite).any():
            raise _WrongError(f"must hold {KINDS[field.kind]}")
    return reals


def _is_infinite(field: Field, one: Any) -> bool:
    return isinstance(one, str) and one == str(_INFINITE.get(field.kind))


def _flatten(raw: Any, dimensions: int, into: list[Any]) -> tuple[int, ...]:
    """Collect the entries of nested lists; return their shape."""
    if dimensions == 0:
        into.append(raw)
        return ()
    if not isinstance(raw, list):
        raise _WrongError(f"must be lists in {dimensions} dimensions")
    if dimensions == 1:
        into.extend(raw)
        return (len(raw),)
    inner = {_flatten(row, dimensions - 1, into) for row in raw}
    if len(inner) > 1:
        raise _WrongError("has rows of different lengths")
    return (len(raw), *(inner.pop() if inner else (0,) * (dimensions - 1)))


def _check_shapes(
    where: str, schema: Schema, part: str, plain: Plain, known: dict[str, int]
) -> None:
    """Check that each letter in the shapes stands for the same size throughout."""
    fields: tuple[Field, ...] = getattr(schema, part)
    if part == "data":
        known |= {letter: count(plain) for letter, count in schema.derived.items()}
    for field in fields:
        value = plain[field.name]
        if value is None or not field.shape:
            continue
        if field.kind == "lists":
            shape: tuple[int, ...] = (len(value),)
        else:
            shape = np.shape(value)
        for letter, size in zip(field.shape.split(), shape, strict=True):
            if known.setdefault(letter, size) != size:
                raise InputError(
                    f"{where}: {part}.{field.name}: has size {size}, but {letter} is "
                    f"{known[letter]}"
                )


def sizes_of(family: str, data: Plain) -> dict[str, int]:
    """Return the sizes of a question's dimensions, by the letters that name them in the schema."""
    return sizes(SCHEMAS[family], data)
