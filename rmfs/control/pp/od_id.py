"""PP OD&ID: operator decomposition with independence detection."""

from __future__ import annotations

import pydantic

from rmfs.control.pp import PathPlanning, RollingParameters


class OdIdParameters(RollingParameters):
    """The limits of joint planning."""

    window_s: float = pydantic.Field(15.0, gt=0)
    """How far ahead robots keep clear of each other."""
    wait_s: float = pydantic.Field(2.0, gt=0)
    """How long a robot waits that decides to wait."""
    nodes_per_robot: int = pydantic.Field(100, ge=1)
    """Joint states of a group that may be looked at for each robot in it."""
    nodes: int = pydantic.Field(600, ge=1)
    """Joint states that may be looked at in a call, over all groups."""
    choices: int = pydantic.Field(4, ge=1)
    """Straight runs that a robot chooses among in joint planning, the most promising ones."""
    labels: int = pydantic.Field(2_000, ge=1)
    """Labels the search for one robot alone may look at."""


class OdId(PathPlanning[OdIdParameters]):
    """OD&ID: robots whose ways meet form a group, which is planned jointly, one move at a time."""

    parameters_model = OdIdParameters
    planner = "od-id"
