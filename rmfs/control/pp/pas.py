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
    """Highest priority to which a robot can rise, step by step, while it finds no free move and
    others need its place. If it finds none even then, it stays, and its priority restarts at 0."""
    steps_per_robot: int = pydantic.Field(40, ge=1)
    """Maximum number of decisions per call, divided by the number of robots."""


class Pas(PathPlanning[PasParameters]):
    """PAS: extends all paths in parallel; a robot that is stuck makes others take back moves."""

    parameters_model = PasParameters
    planner = "pas"
