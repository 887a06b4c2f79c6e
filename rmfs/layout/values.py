"""Types of values that several formats of layout files share."""

from __future__ import annotations

from typing import Annotated

import pydantic
from pydantic import Field

from rmfs.config import Model

Positive = Annotated[float, Field(gt=0)]
Count = Annotated[int, Field(ge=1)]
Amount = Annotated[int, Field(ge=0)]
Index = Amount
Radius = Annotated[float, Field(ge=0.01, lt=0.5)]
Metres = Annotated[float, Field(ge=0.01, le=1000)]
Rate = Annotated[float, Field(ge=0.001, le=1000)]
"""Speeds and accelerations of robots, within physically sensible limits."""
Seconds = Annotated[float, Field(ge=1e-6, le=86400)]
"""Durations of one motion or one unit: from a microsecond, the time resolution, to a day."""
Space = Annotated[float, Field(ge=1e-3, le=1e6)]
"""Space units, limited so that the largest pod holds a billion units of the smallest size."""
Some = Annotated[int, Field(ge=1, le=100_000)]


class Strict(Model):
    """A table of a layout file, in which numbers must be finite.

    Values of other types are not converted: neither "16" nor true is accepted as a number.
    """

    model_config = pydantic.ConfigDict(strict=True, allow_inf_nan=False)
