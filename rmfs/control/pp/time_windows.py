"""PP time windows: prioritised planning over continuous time windows."""

from __future__ import annotations

import pydantic

from rmfs.control.base import Parameters
from rmfs.control.pp import PathPlanning


class TimeWindowsParameters(Parameters):
    """How hard a way is looked for."""

    labels: int = pydantic.Field(50_000, ge=1)
    """Labels a search may look at before the robot waits until all planned motion is over."""
    improve_labels: int = pydantic.Field(0, ge=0)
    """Labels for each robot when a late plan and those in front of it are made anew; 0: never."""
    swift: bool = False
    """From the start: ways that may be a little later than the earliest, found much sooner."""
    swift_from: int = pydantic.Field(300, ge=0)
    """Labels a plan takes on average from which on ways are found sooner, too; 0: never."""


class TimeWindows(PathPlanning[TimeWindowsParameters]):
    """Plans each leg once, first come first served, around the windows others have reserved."""

    parameters_model = TimeWindowsParameters
    planner = "time-windows"
