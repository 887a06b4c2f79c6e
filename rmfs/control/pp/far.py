"""PP FAR (flow annotation replanning), which plans one straight run at a time."""

from __future__ import annotations

import pydantic

from rmfs.control.base import Parameters
from rmfs.control.pp import PathPlanning


class FarParameters(Parameters):
    """Parameters of PP FAR."""

    period_s: float = pydantic.Field(1.0, gt=0)
    """Minimum simulated time, in seconds, between two calls of the planner."""
    runs_granted: int = pydantic.Field(1, ge=1)
    """Maximum number of straight runs of a robot's path that are reserved for the robot at a
    time."""
    reroute: bool = True
    """Whether a robot that must evade takes another path. If false, it moves to a random free
    waypoint next to it."""
    patience_s: float = pydantic.Field(30.0, ge=0)
    """Time, in seconds, after which a robot that stands still evades in any case."""
    wait_s: float = pydantic.Field(2.0, gt=0)
    """Time, in seconds, for which a robot waits when it is blocked or, without `reroute`, after it
    has evaded."""
    avoid_evading_back: bool = True
    """Without `reroute`: whether a robot evades to the same waypoint at most once before it makes
    progress."""


class Far(PathPlanning[FarParameters]):
    """FAR (flow annotation replanning): moves robots along the free part of the next straight run.

    A robot evades (takes another path or moves to a neighbouring waypoint) if it is blocked for
    long, or if it is in a cycle of robots that wait for each other.
    """

    parameters_model = FarParameters
    planner = "far"
