"""PP BCP: biased cost pathfinding."""

from __future__ import annotations

import pydantic

from rmfs.control.pp import PathPlanning, RollingParameters


class BcpParameters(RollingParameters):
    """What a clash costs."""

    bias_m: float = pydantic.Field(1.0, gt=0)
    """Metres by which a waypoint becomes dearer for a robot whose way clashes there."""
    rounds: int = pydantic.Field(20, ge=1)
    """Rounds of planning in a call, if ways clash."""


class Bcp(PathPlanning[BcpParameters]):
    """BCP: quickest ways through space, on which clashes make waypoints dearer, and no waits."""

    parameters_model = BcpParameters
    planner = "bcp"
