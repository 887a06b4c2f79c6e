"""What can be set of the PSA controllers that ask optimisers."""

from __future__ import annotations

from typing import Annotated

import pydantic

from rmfs.solvers.control.parameters import BufferParameters

Positive = Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)]


class StorageParameters(BufferParameters):
    """How visits to pods are foreseen."""

    horizon_s: Positive = 3600.0
    """How far ahead visits to a pod are expected: about as long as pods stay where they are put."""
    refresh_s: Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)] = 60.0
    """How long expected visits are used before they are worked out anew."""
