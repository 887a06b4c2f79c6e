"""Measurements of the true motion in an emulated room, unknown to the robots and the server."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.demonstrator.emulator.base import EmulatedBase
    from rmfs.layout.model import Layout

_DRIVING_M_S = 0.1
_TURNING_RAD_S = 0.3


@dataclass
class Truth:
    """Measurements of the robots' true motion on the floor.

    Attributes
    ----------
    lines_x_m, lines_y_m
        x coordinates of the lines parallel to the y axis, and y coordinates of the lines parallel
        to the x axis, in m.
    nearest_m
        Smallest distance so far between the centres of any two robots; every robot is assumed to
        move in a straight line from one measurement to the next.
    driven_m
        Total distance driven by all robots.
    lateral_mean_m, lateral_max_m
        Mean and maximum distance of robots from the nearest line parallel to their motion, while
        they drive without turning.
    """

    lines_x_m: list[float]
    lines_y_m: list[float]
    nearest_m: float = float("inf")
    driven_m: float = 0.0
    lateral_max_m: float = 0.0
    _lateral_sum: float = 0.0
    _looks: int = 0
    _before: list[tuple[float, float, float]] = field(default_factory=list)

    @classmethod
    def of(cls, layout: Layout) -> Truth:
        """Return a `Truth` without measurements; its lines are those through all waypoints."""
        return cls(np.unique(layout.x_m).tolist(), np.unique(layout.y_m).tolist())

    @property
    def lateral_mean_m(self) -> float:
        """Mean distance of driving robots from the nearest line; 0 without measurements."""
        return self._lateral_sum / self._looks if self._looks else 0.0

    def look(self, bases: Sequence[EmulatedBase], seconds: float) -> None:
        """Measure the motion of all robots in the `seconds` since the previous call."""
        now = [(base.x_m, base.y_m, base.heading_rad) for base in bases]
        before = self._before or now
        self._before = now
        for one, other in combinations(range(len(now)), 2):
            nearest = _closest(
                before[other][0] - before[one][0],
                before[other][1] - before[one][1],
                now[other][0] - now[one][0],
                now[other][1] - now[one][1],
            )
            self.nearest_m = min(self.nearest_m, nearest)
        for old, new in zip(before, now, strict=True):
            self._follow(old, new, seconds)

    def _follow(
        self, old: tuple[float, float, float], new: tuple[float, float, float], seconds: float
    ) -> None:
        dx, dy = new[0] - old[0], new[1] - old[1]
        moved = (dx * dx + dy * dy) ** 0.5
        self.driven_m += moved
        if moved < _DRIVING_M_S * seconds or abs(new[2] - old[2]) > _TURNING_RAD_S * seconds:
            return
        lines, at = (self.lines_y_m, new[1]) if abs(dx) > abs(dy) else (self.lines_x_m, new[0])
        lateral = min(abs(line - at) for line in lines)
        self._lateral_sum += lateral
        self._looks += 1
        self.lateral_max_m = max(self.lateral_max_m, lateral)


def _closest(x0: float, y0: float, x1: float, y1: float) -> float:
    """Return the minimum distance from the origin to the segment from (x0, y0) to (x1, y1)."""
    dx, dy = x1 - x0, y1 - y0
    length = dx * dx + dy * dy
    share = 0.0 if length == 0 else max(0.0, min(1.0, -(x0 * dx + y0 * dy) / length))
    x, y = x0 + share * dx, y0 + share * dy
    return float((x * x + y * y) ** 0.5)
