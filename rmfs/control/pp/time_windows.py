"""PP time windows: prioritised planning over continuous time windows."""

from __future__ import annotations

import pydantic

from rmfs.control.base import Parameters
from rmfs.control.pp import PathPlanning


class TimeWindowsParameters(Parameters):
    """Parameters of PP time-windows: effort spent on a search."""

    labels: int = pydantic.Field(50_000, ge=1)
    """Maximum number of labels in a search before the robot waits until all planned motion is
    over."""
    improve_labels: int = pydantic.Field(0, ge=0)
    """Labels per robot for replanning a late plan and those in front of it; 0: never."""
    swift: bool = False
    """Whether to use faster searches, whose paths may be slightly later than the earliest."""
    swift_from: int = pydantic.Field(300, ge=0)
    """Mean number of labels per plan above which faster searches are used anyway; 0: never."""


class TimeWindows(PathPlanning[TimeWindowsParameters]):
    """Plans legs first come, first served, around the time windows that other robots reserved."""

    parameters_model = TimeWindowsParameters
    planner = "time-windows"
