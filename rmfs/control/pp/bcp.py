"""PP BCP (biased cost pathfinding)."""

from __future__ import annotations

import pydantic

from rmfs.control.pp import PathPlanning, RollingParameters


class BcpParameters(RollingParameters):
    """Parameters of PP BCP."""

    bias_m: float = pydantic.Field(1.0, gt=0)
    """Cost, in metres, that a conflict adds to the waypoint of the conflict, for one of the two
    robots."""
    rounds: int = pydantic.Field(20, ge=1)
    """Maximum number of planning rounds per call. If paths conflict, another round follows."""


class Bcp(PathPlanning[BcpParameters]):
    """BCP (biased cost pathfinding): plans quickest paths; conflicts make waypoints costlier.

    If two paths conflict, the waypoint of the conflict becomes costlier for one of the two robots,
    and a new path is planned for this robot.
    """

    parameters_model = BcpParameters
    planner = "bcp"
