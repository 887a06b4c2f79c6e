"""The robots' batteries: their levels, and how long charging takes."""

from __future__ import annotations

from math import inf, log
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from rmfs.scenario.parameters import Battery

J_PER_WH = 3600.0
"""Joules in a watt-hour."""


class Levels(Protocol):
    """Interface to the traffic model, which computes the energy in each robot's battery."""

    def energy(self) -> dict[str, NDArray[Any]]:
        """Return a dict of arrays of energies (J) and charging times (s), with one value per robot.

        The array `level_j` holds the energy in each battery, and `ever_used_j` the energy used by
        each robot since time zero.
        """
        ...

    def level_j(self, robot: int) -> float:
        """Return the energy in the battery of a robot, in J."""
        ...

    def exchange_battery(self, robot: int, level_j: float) -> None:
        """Exchange a robot's battery for one that contains the energy `level_j`, in J."""
        ...


class Batteries:
    """The batteries of all robots; all batteries are of the same kind.

    Parameters
    ----------
    given
        Parameters of the batteries.
    levels
        The traffic model, which computes the energy in each battery.

    Attributes
    ----------
    capacity_j, least_j, reserve_j
        Capacity of a battery, minimum level and additional reserve, in J.
    enough_share
        Level (share of capacity) that suffices for any task, with a margin; set at the start of a
        run.
    stranded
        Robots whose level fell below the minimum and that have not been rescued since.
    strandings
        Time (s) and robot of every stranding so far.
    """

    def __init__(self, given: Battery, levels: Levels) -> None:
        self.given = given
        self._levels = levels
        self.capacity_j = given.capacity_wh * J_PER_WH
        self.least_j = given.least_share * self.capacity_j
        self.reserve_j = given.reserve_share * self.capacity_j
        self.enough_share = 0.0
        self.stranded: set[int] = set()
        self.strandings: list[tuple[float, int]] = []

    def usable_j(self, robot: int) -> float:
        """Return by how much a battery's energy exceeds minimum level plus reserve, in J.

        The result may be negative.
        """
        return self._levels.level_j(robot) - self.least_j - self.reserve_j

    def levels_j(self) -> NDArray[np.float64]:
        """Energy in each battery, shape (R,), in J."""
        levels: NDArray[np.float64] = self._levels.energy()["level_j"]
        return levels

    def share(self, robot: int) -> float:
        """Level of a robot's battery, as a share of its capacity."""
        return self._levels.level_j(robot) / self.capacity_j

    def shares(self) -> NDArray[np.float64]:
        """Levels of all batteries, as shares of the capacity, shape (R,)."""
        shares: NDArray[np.float64] = self.levels_j() / self.capacity_j
        return shares

    def mean_draw_w(self, now_s: float) -> float:
        """Return the mean power drawn per robot since time zero, in W; 0 at time zero."""
        used_j = float(self._levels.energy()["ever_used_j"].mean())
        return used_j / now_s if now_s > 0 else 0.0

    def exchange(self, robot: int, share: float) -> None:
        """Exchange a robot's battery for one with the level `share`, a share of the capacity."""
        self._levels.exchange_battery(robot, share * self.capacity_j)

    def strand(self, robot: int, now_s: float) -> None:
        """Record that a robot is stranded because its level fell below the minimum."""
        self.stranded.add(robot)
        self.strandings.append((now_s, robot))

    def rescue(self, robot: int) -> None:
        """End the stranding of a robot; raise its level to at least `Battery.rescue_share`."""
        self.stranded.discard(robot)
        self.exchange(robot, max(self.given.rescue_share, self.share(robot)))

    def seconds(self, from_share: float, to_share: float, power_w: float) -> float:
        """Return the time to charge from one level to another, in s; inf if this is impossible.

        Levels are shares of the capacity. This function is the inverse of `charged`, the Python
        counterpart of `Battery::charged` in rmfs/traffic/src/energy.rs.
        """
        if to_share <= from_share:
            return 0.0
        if power_w <= 0 or to_share > 1:
            return inf
        bend = self.given.taper_from_share
        pace = power_w / self.capacity_j
        constant = max(min(to_share, bend) - from_share, 0.0) / pace
        if to_share <= bend:
            return constant
        if to_share >= 1:
            return inf
        begun = max(from_share, bend)
        return constant + (1 - bend) / pace * log((1 - begun) / (1 - to_share))

    def charged(self, from_share: float, power_w: float, seconds: float) -> float:
        """Return the level after charging for `seconds`; levels are shares of the capacity."""
        bend = self.given.taper_from_share
        pace = power_w / self.capacity_j
        constant_for = max((bend - from_share) / pace, 0.0)
        if seconds <= constant_for:
            return from_share + pace * seconds
        if bend >= 1:
            return max(1.0, from_share)
        begun = min(max(from_share, bend), 1.0)
        return 1 - (1 - begun) * float(np.exp(-(seconds - constant_for) * pace / (1 - bend)))


def initial_j(given: Battery, robots: int, draw: Callable[[int], NDArray[np.float64]]) -> Any:
    """Draw the initial energy in each battery, shape (R,), in J.

    Parameters
    ----------
    draw
        Function that draws n random numbers, uniformly from [0, 1); n is its argument.
    """
    low, high = given.initial_least_share, given.initial_most_share
    return (low + (high - low) * draw(robots)) * given.capacity_wh * J_PER_WH
