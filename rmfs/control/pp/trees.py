"""PP CBS (conflict-based search) and PBS (priority-based search), two tree searches."""

from __future__ import annotations

import pydantic

from rmfs.control.pp import PathPlanning, RollingParameters


class TreeParameters(RollingParameters):
    """Parameters of PP CBS; `nodes` and `labels` limit the search."""

    nodes: int = pydantic.Field(60, ge=1)
    """Maximum number of nodes of the search tree that are expanded per call."""
    labels: int = pydantic.Field(2_000, ge=1)
    """Maximum number of labels (partial paths) in the search for the path of one robot."""


class PbsParameters(TreeParameters):
    """Parameters of PP PBS."""

    window_s: float = pydantic.Field(20.0, gt=0)
    """Horizon, in seconds, within which robots avoid each other."""


class Cbs(PathPlanning[TreeParameters]):
    """CBS (conflict-based search): if the paths of two robots conflict, one of them gives way.

    For each conflict, the search tree has two branches: in each of them, a different one of the two
    robots gives way. The most promising node of the tree is examined first. Paths are planned up to
    the destinations, without a horizon.
    """

    parameters_model = TreeParameters
    planner = "cbs"


class Pbs(PathPlanning[PbsParameters]):
    """PBS (priority-based search): if the paths of two robots conflict, one plans around the other.

    A depth-first search tries both possibilities (either robot may plan around the other), the
    cheaper one first. Only conflicts within a rolling horizon are resolved.
    """

    parameters_model = PbsParameters
    planner = "pbs"
