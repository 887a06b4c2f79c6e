"""PP WHCA*: windowed hierarchical cooperative A*, in two variants."""

from __future__ import annotations

import pydantic

from rmfs.control.pp import PathPlanning, RollingParameters


class WhcaParameters(RollingParameters):
    """The window of both variants."""

    window_s: float = pydantic.Field(20.0, gt=0)
    """How far ahead robots keep clear of each other."""
    labels: int = pydantic.Field(2_000, ge=1)
    """Labels the search for one robot may look at."""


class WhcaVolatileParameters(WhcaParameters):
    """The rounds of the volatile variant."""

    wait_s: float = pydantic.Field(2.0, gt=0)
    """Unit of the time that a robot of higher priority waits until others have made room."""
    rounds: int = pydantic.Field(10, ge=1)
    """Rounds of planning in a call; after the last, robots without a way stand and wait."""
    restart_at_once: bool = True
    """Whether a round ends as soon as one robot finds no way."""


class WhcaVolatile(PathPlanning[WhcaVolatileParameters]):
    """WHCA*v: plans all robots anew in every call, and again with other priorities if one fails."""

    parameters_model = WhcaVolatileParameters
    planner = "whca-v"


class WhcaPersistent(PathPlanning[WhcaParameters]):
    """WHCA*n: plans those that need it around the reservations that others made before."""

    parameters_model = WhcaParameters
    planner = "whca-n"
