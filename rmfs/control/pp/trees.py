"""PP CBS and PBS: searches of the tree of ways to resolve conflicts."""

from __future__ import annotations

import pydantic

from rmfs.control.pp import PathPlanning, RollingParameters


class TreeParameters(RollingParameters):
    """The limits of both searches."""

    nodes: int = pydantic.Field(60, ge=1)
    """Nodes of the tree that may be looked at in a call."""
    labels: int = pydantic.Field(2_000, ge=1)
    """Labels the search for one robot may look at."""


class PbsParameters(TreeParameters):
    """The horizon."""

    window_s: float = pydantic.Field(20.0, gt=0)
    """How far ahead robots keep clear of each other."""


class Cbs(PathPlanning[TreeParameters]):
    """CBS: of two robots in conflict one keeps away; the best of all such choices, no horizon."""

    parameters_model = TreeParameters
    planner = "cbs"


class Pbs(PathPlanning[PbsParameters]):
    """PBS: of two robots in conflict one plans around the other, within a rolling horizon."""

    parameters_model = PbsParameters
    planner = "pbs"
