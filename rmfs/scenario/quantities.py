"""Types of numbers in scenario files, and a check that one number is not below another."""

from __future__ import annotations

from typing import Annotated, TypeVar

import pydantic

from rmfs.config import Model

Positive = Annotated[float, pydantic.Field(gt=0)]
NotNegative = Annotated[float, pydantic.Field(ge=0)]
Share = Annotated[float, pydantic.Field(ge=0, le=1)]
Natural = Annotated[int, pydantic.Field(ge=0)]
Waiting = Annotated[int, pydantic.Field(ge=0, le=100_000)]
"""A number of waiting orders."""
Count = Annotated[int, pydantic.Field(ge=1, le=1_000_000)]

Number = TypeVar("Number", int, float)


class Block(Model):
    """A table of a scenario; numbers must be finite, and text is not converted to numbers."""

    model_config = pydantic.ConfigDict(strict=True, allow_inf_nan=False)


def not_below(value: Number, info: pydantic.ValidationInfo, key: str) -> Number:
    """Return `value` if it is not below the value of `key`, a field validated earlier.

    This function is for validators of a single field. Unlike validators of the whole table, these
    also run if other fields are invalid, so that one message can list all errors. If the value of
    `key` is invalid, the two values are not compared.

    Raises
    ------
    ValueError
        If `value` is below the value of `key`.
    """
    least = info.data.get(key)
    if least is not None and value < least:
        raise ValueError(f"must be at least {key} = {least:g}")
    return value
