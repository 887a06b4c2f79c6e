"""Recorded energy: per minute, per robot, and per order."""

from __future__ import annotations

from math import nan
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.observer import MotionCounts
    from rmfs.world.batteries import Batteries

WH = 3600.0
"""Joules per watt-hour."""


class EnergyLog:
    """Records the energy that robots draw, if the scenario models energy.

    The energy is attributed to the units picked. At the end of each visit in which units were
    picked, these units get equal shares of the energy that the robot has drawn since the end of its
    previous visit of this kind. This includes the energy for driving, waiting, storing the previous
    pod, and any trip to a charger.

    Attributes
    ----------
    samples
        The state at the end of each minute, in J: the energy drawn and the energy charged by all
        robots since the end of the warm-up, and the mean and the minimum of the energy in their
        batteries (nan without batteries).
    per_order
        Energy drawn for the units that have been picked for each order, in J, by index of the
        order.
    final
        Result of `Traffic.energy` at the end of the run; empty if energy is not modelled.
    batteries
        The robots' batteries, if there are any.
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
        """Start the log; called at the start of a run if its scenario models energy."""
        self._traffic, self.batteries = traffic, batteries
        self._before = [0.0] * robots

    def sampled(self) -> None:
        """Add the present state to `samples`."""
        if self._traffic is not None:
            now = self._traffic.energy()
            levels = now["level_j"]
            mean = least = nan
            if self.batteries is not None:
                mean, least = float(levels.mean()), float(levels.min())
            used, charged = float(now["used_j"].sum()), float(now["charged_j"].sum())
            self.samples.append((used, charged, mean, least))

    def picked(self, order: int, station: int) -> None:
        """Record that a unit was picked for an order during the visit in progress at a station."""
        if self._traffic is not None:
            self._units.setdefault(station, []).append(order)

    def left(self, station: int, robot: int) -> None:
        """Divide the energy drawn by a robot among the units picked in the visit that has ended."""
        orders = self._units.pop(station, None)
        if self._traffic is None or not orders:
            return
        used = self._traffic.used_j(robot)
        each = (used - self._before[robot]) / len(orders)
        self._before[robot] = used
        for order in orders:
            self.per_order[order] = self.per_order.get(order, 0.0) + each

    def ended(self) -> None:
        """Store the totals in `final`, at the end of the run."""
        if self._traffic is not None:
            self.final = self._traffic.energy()
            if self.batteries is None:
                self.final["level_j"] = np.full(len(self.final["level_j"]), nan)

    def per_interval_wh(self, which: int) -> NDArray[np.float64]:
        """Return the energy drawn or charged by all robots in each minute, in Wh.

        Parameters
        ----------
        which
            0 for the energy drawn, 1 for the energy charged.
        """
        values = [0.0, *(sample[which] for sample in self.samples)]
        wh: NDArray[np.float64] = np.diff(np.array(values)) / WH
        return wh
