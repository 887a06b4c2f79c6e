"""CA rules `threshold` and `to-full`: a robot charges when its battery level is low."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.control.ca.levels import ByLevel, LevelParameters, PlaceParameters, Share

if TYPE_CHECKING:
    from rmfs.world.robots import Robot


class Threshold(ByLevel[LevelParameters]):
    """Sends a robot whose battery level is below `below_share` to charge up to `until_share`.

    These two thresholds are called `threshold_soc` and `recharge_soc` in Open-RMF, and replenish
    and release points in DELMIA.
    """

    parameters_model = LevelParameters

    def wanted_share(self, robot: Robot, share: float) -> float:
        """Return `until_share` if the robot's level `share` is below `below_share`, else 0."""
        given = self.parameters
        return given.until_share if share < given.below_share else 0.0

    def target_share(self) -> float:
        """Return the level up to which robots charge, `until_share`."""
        return self.parameters.until_share


class ToFullParameters(PlaceParameters):
    """Parameters of the CA rule `to-full`."""

    below_share: Share = 0.3
    """A robot charges when its battery level falls below this share of the capacity."""


class ToFull(ByLevel[ToFullParameters]):
    """Sends a robot whose battery level is below `below_share` to charge fully."""

    parameters_model = ToFullParameters

    def wanted_share(self, robot: Robot, share: float) -> float:
        """Return `target_share()` if the robot's level `share` is below `below_share`, else 0."""
        return self.target_share() if share < self.parameters.below_share else 0.0

    def target_share(self) -> float:
        """Return the battery level (share of capacity) that counts as full."""
        batteries = self.view.batteries
        return 1.0 if batteries is None else batteries.given.full_share
