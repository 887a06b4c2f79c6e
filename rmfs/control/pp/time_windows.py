"""PP time windows: prioritised planning over continuous time windows."""

from __future__ import annotations

from rmfs.control.base import NoParameters
from rmfs.control.pp import PathPlanning


class TimeWindows(PathPlanning[NoParameters]):
    """Plans each leg once, first come first served, around the windows others have reserved."""
