"""PP PIBT (priority inheritance with backtracking), which plans one straight run at a time."""

from __future__ import annotations

import pydantic

from rmfs.control.pp import PathPlanning, RollingParameters


class PibtParameters(RollingParameters):
    """Parameters of PP PIBT."""

    runs_granted: int = pydantic.Field(1, ge=1)
    """Maximum number of straight runs that are reserved for a robot at a time. Values above 1 have
    no effect, since PIBT plans one straight run at a time."""
    detour_s: float = pydantic.Field(30.0, gt=0)
    """Maximum detour, in seconds: a straight run is tried only if the quickest path that starts
    with it takes at most this much longer than the quickest path of all."""
    choices: int = pydantic.Field(8, ge=1)
    """Maximum number of straight runs that a robot tries, the best first."""


class Pibt(PathPlanning[PibtParameters]):
    """PIBT (priority inheritance with backtracking): chooses each robot's next straight run.

    Robots that block this run move aside if possible.
    """

    parameters_model = PibtParameters
    planner = "pibt"
