"""PSA nearest: the empty place that is reached soonest."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.control.base import NoParameters
from rmfs.control.psa import PodStorageAssignment

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.world.robots import Robot


class Nearest(PodStorageAssignment[NoParameters]):
    """Takes the empty place with the least unhindered travel time of a loaded robot.

    Ties: the place with the lowest waypoint.
    """

    def __init__(self, parameters: NoParameters, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._times: dict[int, NDArray[np.float64]] = {}

    def place(self, robot: Robot) -> int:
        """Find the least travel time from where the robot stands."""
        storage = self.view.storage
        times = np.where(storage.is_empty, self._times_from(robot.waypoint), np.inf)
        best = int(times.argmin())
        return int(storage.places[best]) if times[best] < np.inf else -1

    def _times_from(self, waypoint: int) -> NDArray[np.float64]:
        """Times from a waypoint to all storage places, shape (L,); robots park from stations."""
        times = self._times.get(waypoint)
        if times is None:
            all_times = self.view.travel.away(waypoint, loaded=True)
            times = self._times[waypoint] = all_times[self.view.storage.places]
        return times
