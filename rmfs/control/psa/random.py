"""PSA random: chooses an empty storage location at random."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.control.base import Parameters
from rmfs.control.psa import PodStorageAssignment

if TYPE_CHECKING:
    from rmfs.world.robots import Robot


class RandomPlaceParameters(Parameters):
    """Parameters of PSA random."""

    prefer_same_tier: bool = True
    """Whether other tiers are used only if the robot's tier has no empty storage location."""


class RandomPlace(PodStorageAssignment[RandomPlaceParameters]):
    """Chooses an empty storage location at random."""

    parameters_model = RandomPlaceParameters

    def place(self, robot: Robot) -> int:
        """Choose an empty storage location at random; -1 if there is none.

        With `prefer_same_tier`, the location is on the robot's tier if possible.
        """
        storage = self.view.storage
        places = storage.places[storage.is_empty]
        if self.parameters.prefer_same_tier and self.view.travel.tiers > 1:
            near = places[self.view.travel.tier[places] == robot.tier]
            places = near if len(near) else places
        return int(places[self.draw(len(places))]) if len(places) else -1
