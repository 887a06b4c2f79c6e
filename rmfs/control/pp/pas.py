"""PP PAS: parallel agent search."""

from __future__ import annotations

import pydantic

from rmfs.control.pp import PathPlanning, RollingParameters


class PasParameters(RollingParameters):
    """The window, and how hard agents push."""

    window_s: float = pydantic.Field(30.0, gt=0)
    """How far ahead robots keep clear of each other."""
    wait_s: float = pydantic.Field(2.0, gt=0)
    """How long a robot waits that decides to wait."""
    priorities: int = pydantic.Field(2, ge=0)
    """Highest priority of a robot for which nothing is left; then it begins at 0 again."""
    steps_per_robot: int = pydantic.Field(40, ge=1)
    """Decisions that may be taken in a call for each robot, on average."""


class Pas(PathPlanning[PasParameters]):
    """PAS: all ways grow together in the order of time; who has none left makes others go back."""

    parameters_model = PasParameters
    planner = "pas"
