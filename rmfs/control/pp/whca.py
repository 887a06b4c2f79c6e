"""PP WHCA* (windowed hierarchical cooperative A*), in two variants."""

from __future__ import annotations

import pydantic

from rmfs.control.pp import PathPlanning, RollingParameters


class WhcaParameters(RollingParameters):
    """Parameters of both variants of WHCA*."""

    window_s: float = pydantic.Field(20.0, gt=0)
    """Horizon, in seconds, within which robots avoid each other."""
    labels: int = pydantic.Field(2_000, ge=1)
    """Maximum number of labels (partial paths) in the search for the path of one robot."""


class WhcaVolatileParameters(WhcaParameters):
    """Parameters of the volatile variant."""

    wait_s: float = pydantic.Field(2.0, gt=0)
    """Unit of waiting time, in seconds: a robot of higher priority first waits for a multiple of
    this time, so that others can make room."""
    rounds: int = pydantic.Field(10, ge=1)
    """Maximum number of planning rounds per call; after the last round, robots without a path
    wait."""
    restart_at_once: bool = True
    """Whether a planning round ends as soon as no path is found for one robot. If false, paths of
    the remaining robots are planned first."""


class WhcaVolatile(PathPlanning[WhcaVolatileParameters]):
    """WHCA*v (volatile): plans new paths for all robots in every call.

    WHCA* stands for windowed hierarchical cooperative A*. If no path is found for a robot, its
    priority rises, and new paths are planned for all robots in another round.
    """

    parameters_model = WhcaVolatileParameters
    planner = "whca-v"


class WhcaPersistent(PathPlanning[WhcaParameters]):
    """WHCA*n (non-volatile): plans only for robots without a path, around reservations of others.

    WHCA* stands for windowed hierarchical cooperative A*.
    """

    parameters_model = WhcaParameters
    planner = "whca-n"
