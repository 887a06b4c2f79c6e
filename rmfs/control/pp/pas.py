"""PP PAS (parallel agent search)."""

from __future__ import annotations

import pydantic

from rmfs.control.pp import PathPlanning, RollingParameters


class PasParameters(RollingParameters):
    """Parameters of PP PAS."""

    window_s: float = pydantic.Field(30.0, gt=0)
    """Horizon, in seconds, within which robots avoid each other."""
    wait_s: float = pydantic.Field(2.0, gt=0)
    """Duration, in seconds, of one planned wait."""
    priorities: int = pydantic.Field(2, ge=0)
    """Maximum priority of a robot. The priority rises by 1 each time the robot has no free move and
    cannot wait because others need its place. When the maximum is exceeded, the robot stays where
    it is, and its priority restarts at 0."""
    steps_per_robot: int = pydantic.Field(40, ge=1)
    """Maximum number of decisions (moves and waits) per call, divided by the number of robots."""


class Pas(PathPlanning[PasParameters]):
    """PAS (parallel agent search): extends the paths of all robots in parallel.

    If a robot has no free move and cannot wait, its priority rises, and robots of lower priority
    take back those of their planned moves that are in the way of this robot.
    """

    parameters_model = PasParameters
    planner = "pas"
