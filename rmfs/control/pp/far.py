"""PP FAR: flow annotation replanning, one straight hop at a time."""

from __future__ import annotations

import pydantic

from rmfs.control.base import Parameters
from rmfs.control.pp import PathPlanning


class FarParameters(Parameters):
    """Parameters of PP FAR."""

    period_s: float = pydantic.Field(1.0, gt=0)
    """Minimum simulated time between two calls of the planner."""
    runs_granted: int = pydantic.Field(1, ge=1)
    """Maximum number of hops of its path granted to a robot at once."""
    reroute: bool = True
    """Whether a robot evades by an alternative path; otherwise it evades to a random neighbouring
    waypoint."""
    patience_s: float = pydantic.Field(30.0, ge=0)
    """Time for which a robot stands still before it evades in any case."""
    wait_s: float = pydantic.Field(2.0, gt=0)
    """Waiting time of a robot that is blocked or has evaded."""
    avoid_evading_back: bool = True
    """Whether a robot evades to the same waypoint at most once before it makes progress."""


class Far(PathPlanning[FarParameters]):
    """FAR: drives the next straight hop of the path as far as it is free; evades if blocked."""

    parameters_model = FarParameters
    planner = "far"
