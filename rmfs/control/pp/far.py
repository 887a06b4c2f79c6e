"""PP FAR: flow annotation replanning, one straight hop at a time."""

from __future__ import annotations

import pydantic

from rmfs.control.base import Parameters
from rmfs.control.pp import PathPlanning


class FarParameters(Parameters):
    """When robots evade."""

    period_s: float = pydantic.Field(1.0, gt=0)
    """Least simulated time between two calls of the planner."""
    runs_granted: int = pydantic.Field(1, ge=1)
    """Hops of its way that a robot may be granted at once."""
    reroute: bool = True
    """Whether a robot evades by another way; if not, to a random neighbouring waypoint."""
    patience_s: float = pydantic.Field(30.0, ge=0)
    """How long a robot stands still before it evades in any case."""
    wait_s: float = pydantic.Field(2.0, gt=0)
    """How long a robot waits that is blocked, or has evaded."""
    avoid_evading_back: bool = True
    """Whether a robot evades to the same waypoint only once before it has moved on."""


class Far(PathPlanning[FarParameters]):
    """FAR: drives the next straight hop of the way as far as it is free, evades when blocked."""

    parameters_model = FarParameters
    planner = "far"
