"""PP PIBT: priority inheritance with backtracking, one straight run at a time."""

from __future__ import annotations

import pydantic

from rmfs.control.pp import PathPlanning, RollingParameters


class PibtParameters(RollingParameters):
    """What a robot tries."""

    runs_granted: int = pydantic.Field(1, ge=1)
    """Straight runs that a robot may be granted at once; PIBT plans no more than one."""
    detour_s: float = pydantic.Field(30.0, gt=0)
    """How much longer than the best way the way over a run may take."""
    choices: int = pydantic.Field(8, ge=1)
    """Straight runs that a robot tries, the best first."""


class Pibt(PathPlanning[PibtParameters]):
    """PIBT: the next run of each robot; who stands in its way has to leave first, if it can."""

    parameters_model = PibtParameters
    planner = "pibt"
