"""PP CBS and PBS: tree searches that resolve conflicts between paths."""

from __future__ import annotations

import pydantic

from rmfs.control.pp import PathPlanning, RollingParameters


class TreeParameters(RollingParameters):
    """Parameters of PP CBS: limits of the search."""

    nodes: int = pydantic.Field(60, ge=1)
    """Maximum number of tree nodes per call."""
    labels: int = pydantic.Field(2_000, ge=1)
    """Maximum number of labels in the search for one robot."""


class PbsParameters(TreeParameters):
    """Parameters of PP PBS."""

    window_s: float = pydantic.Field(20.0, gt=0)
    """Horizon within which robots avoid each other."""


class Cbs(PathPlanning[TreeParameters]):
    """CBS: of two conflicting robots, one avoids the other; seeks the best choices, no horizon."""

    parameters_model = TreeParameters
    planner = "cbs"


class Pbs(PathPlanning[PbsParameters]):
    """PBS: of two conflicting robots, one plans around the other, within a rolling horizon."""

    parameters_model = PbsParameters
    planner = "pbs"
