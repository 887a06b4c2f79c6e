"""PP PAS (parallel agent search)."""

from __future__ import annotations

import pydantic

from rmfs.control.pp import PathPlanning, RollingParameters


class PasParameters(RollingParameters):
    """Parameters of PP PAS."""

    window_s: float = pydantic.Field(30.0, gt=0)
    """Horizon, in seconds, within which robots avoid each other."""
    wait_s: float = pydantic.Field(2.0, gt=0)
    """Duration, in seconds, of a single wait."""
    priorities: int = pydantic.Field(2, ge=0)
    """Highest priority of a robot. While a robot finds no free move and others need its place, its
    priority rises by 1 at a time. If it finds none at the highest priority, it stays where it is,
    and its priority restarts at 0."""
    steps_per_robot: int = pydantic.Field(40, ge=1)
    """Maximum number of decisions per call, divided by the number of robots."""


class Pas(PathPlanning[PasParameters]):
    """PAS: extends the paths of all robots in parallel.

    If a robot has no free move, its priority rises, and robots of lower priority take back those of
    their planned moves that are in its way.
    """

    parameters_model = PasParameters
    planner = "pas"
