"""PP PIBT: priority inheritance with backtracking, one straight run at a time."""

from __future__ import annotations

import pydantic

from rmfs.control.pp import PathPlanning, RollingParameters


class PibtParameters(RollingParameters):
    """Parameters of PP PIBT."""

    runs_granted: int = pydantic.Field(1, ge=1)
    """Maximum number of straight runs granted to a robot at once; PIBT plans no more than one."""
    detour_s: float = pydantic.Field(30.0, gt=0)
    """Maximum time by which the path over a run may exceed the best path."""
    choices: int = pydantic.Field(8, ge=1)
    """Maximum number of straight runs that a robot tries, the best first."""


class Pibt(PathPlanning[PibtParameters]):
    """PIBT: chooses each robot's next run; robots in its way have to leave first, if they can."""

    parameters_model = PibtParameters
    planner = "pibt"
