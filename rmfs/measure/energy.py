"""What is written down of energy: minute by minute, per robot, and what orders cost."""

from __future__ import annotations

from math import nan
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.observer import MotionCounts
    from rmfs.world.batteries import Batteries

WH = 3600.0
"""Joules of a watt-hour."""


class EnergyLog:
    """What robots draw, if that is counted.

    What a robot draws between two visits of pick stations is shared by the units that are picked in
    the second, so that way, wait, storing the pod before and charging are in it.

    Attributes
    ----------
    samples
        Every minute, J since the last reset: drawn and charged by all robots; and J in the mean,
        and the least, of the batteries, nan without batteries.
    per_order
        J of each order's units so far, by index.
    final
        What traffic counted; empty if energy is not counted.
    batteries
        Of the robots, if they have any.
    """

    def __init__(self) -> None:
        self._traffic: MotionCounts | None = None
        self._before: list[float] = []
        self._units: dict[int, list[int]] = {}
        self.batteries: Batteries | None = None
        self.samples: list[tuple[float, float, float, float]] = []
        self.per_order: dict[int, float] = {}
        self.final: dict[str, NDArray[Any]] = {}

    def begin(self, traffic: MotionCounts, robots: int, batteries: Batteries | None) -> None:
        """Count from now on."""
        self._traffic, self.batteries = traffic, batteries
        self._before = [0.0] * robots

    def sampled(self) -> None:
        """Add up what all robots drew."""
        if self._traffic is not None:
            now = self._traffic.energy()
            levels = now["level_j"]
            mean = least = nan
            if self.batteries is not None:
                mean, least = float(levels.mean()), float(levels.min())
            used, charged = float(now["used_j"].sum()), float(now["charged_j"].sum())
            self.samples.append((used, charged, mean, least))

    def picked(self, order: int, station: int) -> None:
        """Note a unit of the visit."""
        if self._traffic is not None:
            self._units.setdefault(station, []).append(order)

    def left(self, station: int, robot: int) -> None:
        """Divide what the robot has drawn among the units of its visit."""
        orders = self._units.pop(station, None)
        if self._traffic is None or not orders:
            return
        used = self._traffic.used_j(robot)
        each = (used - self._before[robot]) / len(orders)
        self._before[robot] = used
        for order in orders:
            self.per_order[order] = self.per_order.get(order, 0.0) + each

    def ended(self) -> None:
        """Take what traffic has counted."""
        if self._traffic is not None:
            self.final = self._traffic.energy()
            if self.batteries is None:
                self.final["level_j"] = np.full(len(self.final["level_j"]), nan)

    def per_interval_wh(self, which: int) -> NDArray[np.float64]:
        """Wh per minute: drawn (0) or charged (1)."""
        values = [0.0, *(sample[which] for sample in self.samples)]
        wh: NDArray[np.float64] = np.diff(np.array(values)) / WH
        return wh
