"""PP CBS and PBS, tree searches that resolve conflicts between paths."""

from __future__ import annotations

import pydantic

from rmfs.control.pp import PathPlanning, RollingParameters


class TreeParameters(RollingParameters):
    """Parameters of PP CBS; `nodes` and `labels` limit the search."""

    nodes: int = pydantic.Field(60, ge=1)
    """Maximum number of nodes of the search tree per call."""
    labels: int = pydantic.Field(2_000, ge=1)
    """Maximum number of labels in the search for one robot."""


class PbsParameters(TreeParameters):
    """Parameters of PP PBS."""

    window_s: float = pydantic.Field(20.0, gt=0)
    """Horizon, in seconds, within which robots avoid each other."""


class Cbs(PathPlanning[TreeParameters]):
    """CBS (conflict-based search): of two conflicting robots, one gives way.

    A search tree branches on which of the two gives way; its most promising node is examined first.
    Paths are planned up to the destinations, without a horizon.
    """

    parameters_model = TreeParameters
    planner = "cbs"


class Pbs(PathPlanning[PbsParameters]):
    """PBS (priority-based search): of two conflicting robots, one plans around the other.

    A depth-first search tries out which of the two does so, the cheaper choice first. Only
    conflicts within a rolling horizon are resolved.
    """

    parameters_model = PbsParameters
    planner = "pbs"
