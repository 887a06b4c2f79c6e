"""PP PAS: parallel agent search."""

from __future__ import annotations

import pydantic

from rmfs.control.pp import PathPlanning, RollingParameters


class PasParameters(RollingParameters):
    """Parameters of PP PAS."""

    window_s: float = pydantic.Field(30.0, gt=0)
    """Horizon within which robots avoid each other."""
    wait_s: float = pydantic.Field(2.0, gt=0)
    """Duration of a wait."""
    priorities: int = pydantic.Field(2, ge=0)
    """Highest priority to which a robot without options can rise; after that it restarts at 0."""
    steps_per_robot: int = pydantic.Field(40, ge=1)
    """Maximum number of decisions per call for each robot, on average."""


class Pas(PathPlanning[PasParameters]):
    """PAS: all paths grow together in time; a robot without options makes others backtrack."""

    parameters_model = PasParameters
    planner = "pas"
