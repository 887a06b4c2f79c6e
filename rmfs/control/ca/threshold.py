"""CA threshold and to-full: a robot goes for energy when its level is low."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.control.ca.levels import ByLevel, LevelParameters, PlaceParameters, Share

if TYPE_CHECKING:
    from rmfs.world.robots import Robot


class Threshold(ByLevel[LevelParameters]):
    """Sends a robot below one level, and lets it stay until another.

    What Open-RMF calls `threshold_soc` and `recharge_soc`, and DELMIA replenish and release points.
    """

    parameters_model = LevelParameters

    def wanted_share(self, robot: Robot, share: float) -> float:
        """The upper level, below the lower one."""
        given = self.parameters
        return given.until_share if share < given.below_share else 0.0

    def target_share(self) -> float:
        """The upper level."""
        return self.parameters.until_share


class ToFullParameters(PlaceParameters):
    """Parameters of CA to-full."""

    below_share: Share = 0.3
    """A robot goes for energy once its level is below."""


class ToFull(ByLevel[ToFullParameters]):
    """Sends a robot below a level, and lets it stay until it is full (capacitive charging)."""

    parameters_model = ToFullParameters

    def wanted_share(self, robot: Robot, share: float) -> float:
        """All there is room for, below the level."""
        return self.target_share() if share < self.parameters.below_share else 0.0

    def target_share(self) -> float:
        """What counts as full."""
        batteries = self.view.batteries
        return 1.0 if batteries is None else batteries.given.full_share
