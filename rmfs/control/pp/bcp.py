"""PP BCP: biased cost pathfinding."""

from __future__ import annotations

import pydantic

from rmfs.control.pp import PathPlanning, RollingParameters


class BcpParameters(RollingParameters):
    """Parameters of PP BCP."""

    bias_m: float = pydantic.Field(1.0, gt=0)
    """Cost in metres added to a waypoint for a robot whose path collides there."""
    rounds: int = pydantic.Field(20, ge=1)
    """Maximum number of planning rounds per call if paths collide."""


class Bcp(PathPlanning[BcpParameters]):
    """BCP: plans quickest paths in space; a collision makes its waypoint costlier for one robot."""

    parameters_model = BcpParameters
    planner = "bcp"
