"""PP time-windows: prioritised planning over continuous time windows."""

from __future__ import annotations

from typing import Annotated

import pydantic

from rmfs.control.base import Parameters
from rmfs.control.pp import PathPlanning


class TimeWindowsParameters(Parameters):
    """Parameters of PP time-windows."""

    labels: int = pydantic.Field(50_000, ge=1)
    """Maximum number of labels (partial paths) in a search; if no path is found by then, the robot
    waits until all planned motion is over."""
    improve_labels: int = pydantic.Field(0, ge=0)
    """Maximum number of labels in each search when plans are improved: if a new plan delays its
    robot by more than 2 s, the robot and those directly in front of it are planned again. 0: plans
    are never improved."""
    swift: bool = False
    """Whether to use faster searches; robots may then arrive slightly later than necessary."""
    swift_from: int = pydantic.Field(300, ge=0)
    """Mean number of labels per plan from which the run changes to faster searches even if `swift`
    is false; 0: never."""
    guidance: Annotated[str, pydantic.Field(min_length=1)] | None = None
    """Path of a file with extra costs of edges, written by `rmfs traffic guide`. With it, plans
    minimise arrival time plus extra cost. Default: no extra costs."""


class TimeWindows(PathPlanning[TimeWindowsParameters]):
    """Plans each trip once, first come, first served, around the reservations of other robots."""

    parameters_model = TimeWindowsParameters
    planner = "time-windows"
