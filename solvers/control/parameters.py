"""Parameters shared by controllers that use solvers."""

from __future__ import annotations

from typing import Annotated

import pydantic

from rmfs.control.base import Parameters
from rmfs.solvers.models.solution import Limits


class BufferParameters(Parameters):
    """Parameter that limits how often the optimiser is asked."""

    buffer_s: Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)] = 0.0
    """Minimum time, in seconds, between two questions to the optimiser, so that one question covers
    several decisions."""


class SearchParameters(BufferParameters):
    """Limits of the optimiser's search."""

    work_s: Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)] = 0.25
    """Limit of the search by CP-SAT in deterministic seconds, which are close to wall time."""
    gap: Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)] = 0.0
    """Relative gap between objective value and bound at which the search ends."""

    @property
    def limits(self) -> Limits:
        """Return `work_s` and `gap` as limits of a model."""
        return Limits(deterministic_s=self.work_s, gap=self.gap)
