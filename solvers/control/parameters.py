"""Parameters that solver-backed controllers have in common."""

from __future__ import annotations

from typing import Annotated

import pydantic

from rmfs.control.base import Parameters
from rmfs.solvers.models.solution import Limits


class BufferParameters(Parameters):
    """When the optimiser is asked."""

    buffer_s: Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)] = 0.0
    """Seconds for which decisions are collected before the optimiser is asked again."""


class SearchParameters(BufferParameters):
    """How long the optimiser may search."""

    work_s: Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)] = 0.25
    """Limit of the search in deterministic seconds of CP-SAT: about the same in wall time."""
    gap: Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)] = 0.0
    """Relative gap between value and bound at which the search ends."""

    @property
    def limits(self) -> Limits:
        """The same as limits of a model."""
        return Limits(deterministic_s=self.work_s, gap=self.gap)
