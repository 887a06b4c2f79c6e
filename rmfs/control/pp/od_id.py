"""PP OD&ID (operator decomposition with independence detection)."""

from __future__ import annotations

import pydantic

from rmfs.control.pp import PathPlanning, RollingParameters


class OdIdParameters(RollingParameters):
    """Parameters of PP OD&ID."""

    window_s: float = pydantic.Field(15.0, gt=0)
    """Horizon, in seconds, within which robots avoid each other."""
    wait_s: float = pydantic.Field(2.0, gt=0)
    """Duration, in seconds, of one planned wait."""
    nodes_per_robot: int = pydantic.Field(100, ge=1)
    """Maximum number of joint states that are expanded when a group is planned, per robot of the
    group."""
    nodes: int = pydantic.Field(600, ge=1)
    """Maximum number of joint states that are expanded per call, over all groups."""
    choices: int = pydantic.Field(4, ge=1)
    """Maximum number of straight runs of the robot that moves next that are considered in each
    joint state, the best first."""
    labels: int = pydantic.Field(2_000, ge=1)
    """Maximum number of labels (partial paths) in the search for the path of a single robot."""


class OdId(PathPlanning[OdIdParameters]):
    """OD&ID: plans for robots with conflicting paths as a group, one move of one robot at a time.

    OD&ID stands for operator decomposition with independence detection.
    """

    parameters_model = OdIdParameters
    planner = "od-id"
