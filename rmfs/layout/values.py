"""Kinds of values that layout files share."""

from __future__ import annotations

from typing import Annotated

import pydantic
from pydantic import Field

from rmfs.config import Model

Positive = Annotated[float, Field(gt=0)]
Count = Annotated[int, Field(ge=1)]
Amount = Annotated[int, Field(ge=0)]
Index = Amount


class Strict(Model):
    """Numbers must be written as finite numbers: "16" or true is not taken for 16 or 1."""

    model_config = pydantic.ConfigDict(strict=True, allow_inf_nan=False)
