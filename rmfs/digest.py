"""A hash of a value, computed from its content and not from how it is stored in memory."""

from __future__ import annotations

import hashlib
from dataclasses import fields, is_dataclass

import numpy as np

OMITTED = "omitted"
"""Metadata key of fields that are left out of the hash while they are empty.

A dataclass can thus get a new field without changing the hash of values in which it is empty.
"""


def digest(value: object) -> str:
    """Return the SHA-256 of a value as 64 hexadecimal digits.

    The value may consist of arrays, numbers, strings, dataclasses, dicts, tuples and lists. An
    object with a method `digested` is represented by the return value of that method.
    """
    state = hashlib.sha256()
    _feed(state, value)
    return state.hexdigest()


def _feed(state: hashlib._Hash, value: object) -> None:
    if isinstance(value, np.ndarray):
        state.update(f"{value.dtype.kind}{value.shape}".encode())
        told = np.ascontiguousarray(value, value.dtype.newbyteorder("<"))
        state.update(told.reshape(-1).view(np.uint8).data)
    elif hasattr(value, "digested"):
        _feed(state, value.digested())
    elif is_dataclass(value) and not isinstance(value, type):
        for one in fields(value):
            if one.metadata.get(OMITTED) and not getattr(value, one.name):
                continue
            state.update(one.name.encode())
            _feed(state, getattr(value, one.name))
    elif isinstance(value, dict):
        for key in sorted(value):
            _feed(state, key)
            _feed(state, value[key])
    elif isinstance(value, tuple | list):
        state.update(f"({len(value)}".encode())
        for item in value:
            _feed(state, item)
    else:
        state.update(f"{type(value).__name__}:{value!r};".encode())
