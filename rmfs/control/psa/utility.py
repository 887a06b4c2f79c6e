"""PSA utility: the higher a pod's score, the nearer to a pick station it is stored."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.control.psa import PodStorageAssignment
from rmfs.control.psa.distances import PlaceDistances
from rmfs.control.psa.ranking import Ranking, RankParameters

if TYPE_CHECKING:
    import numpy as np

    from rmfs.control.view import View
    from rmfs.world.robots import Robot


class Utility(PodStorageAssignment[RankParameters]):
    """Chooses an empty storage location with a rank near the pod's target rank.

    Storage locations are ranked by prominence: the shorter the travel time to the nearest pick
    station, the better the rank. Pods are sorted by score, the weighted mean of a pod's utility
    (the number of its units that orders need) and its speed (how often its SKUs are ordered). A
    pod's target rank is the rank of the location that corresponds to the pod's position in this
    order (`rmfs.control.psa.ranking.Ranking`).

    Empty locations are sought rank by rank, outward from the target rank, until at least one is
    found and at least `corridor` ranks have been searched. Of the locations found, the one with the
    least travel time from the robot is chosen; ties go to the lowest waypoint number.
    """

    parameters_model = RankParameters

    def __init__(self, parameters: RankParameters, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._ranking = Ranking(view, parameters)
        self._distances = PlaceDistances(view, "time")

    def place(self, robot: Robot) -> int:
        """Find a storage location by searching outward from the pod's target rank."""
        seen = self._ranking.seen(self._ranking.target(robot.pod))
        return self.least(self._distances.away(robot.waypoint), seen)
