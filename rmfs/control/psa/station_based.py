"""PSA station-based: chooses the empty storage location nearest to a station."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from rmfs.control.base import Parameters
from rmfs.control.psa import PodStorageAssignment
from rmfs.control.psa.distances import PlaceDistances
from rmfs.control.travel import Metric

if TYPE_CHECKING:
    import numpy as np

    from rmfs.control.view import View
    from rmfs.world.robots import Robot


class StationBasedParameters(Parameters):
    """Parameters of PSA station-based."""

    stations: Literal["pick", "replenishment"] = "pick"
    """Kind of station near which pods are stored: `pick` or `replenishment`."""
    metric: Metric = "time"
    """Measure of the distance from a storage location to a station: `euclidean` or `manhattan` (in
    m), `path` (length in m of a loaded robot's shortest path) or `time` (travel time in s of a
    loaded robot if no other robot delays it)."""


class StationBased(PodStorageAssignment[StationBasedParameters]):
    """Chooses the empty storage location with the shortest distance to the nearest pick station.

    With `stations` = "replenishment", replenishment stations are considered instead. The position
    of the pod has no effect. Ties go to the waypoint with the lowest number.
    """

    parameters_model = StationBasedParameters

    def __init__(
        self, parameters: StationBasedParameters, view: View, rng: np.random.Generator
    ) -> None:
        super().__init__(parameters, view, rng)
        pick = parameters.stations == "pick"
        stations = view.pick_stations if pick else view.replenishment_stations
        distances = PlaceDistances(view, parameters.metric)
        self._to_station = distances.to_nearest([station.waypoint for station in stations])

    def place(self, robot: Robot) -> int:
        """Find the empty storage location nearest to a station; -1 if there is none."""
        return self.least(self._to_station, self.view.storage.is_empty)
