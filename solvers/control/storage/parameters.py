"""Parameters shared by PSA controllers with models."""

from __future__ import annotations

from typing import Annotated

import pydantic

from rmfs.control.base import Parameters
from rmfs.solvers.control.parameters import BufferParameters

Positive = Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)]


class ForecastParameters(Parameters):
    """Parameters of the forecast of visits."""

    horizon_s: Positive = 3600.0
    """Horizon, in seconds, of the forecast of visits; it should be about as long as pods stay
    stored."""
    refresh_s: Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)] = 60.0
    """Time, in seconds, after which the forecast of visits is recomputed."""


class StorageParameters(ForecastParameters, BufferParameters):
    """Parameters of PSA controllers that plan ahead."""
