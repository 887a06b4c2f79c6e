"""Distances between a waypoint and all storage locations."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.control.travel import Metric
    from rmfs.control.view import View


class PlaceDistances:
    """Distances between waypoints and the L storage locations, for a loaded robot.

    Parameters
    ----------
    metric
        Measure of distance (`rmfs.control.travel.Metric`): `time` in s, the others in m.
    """

    def __init__(self, view: View, metric: Metric) -> None:
        self._travel = view.travel
        self._places = view.storage.places
        self._metric: Metric = metric
        self._kept: dict[int, NDArray[np.float64]] = {}

    def away(self, waypoint: int) -> NDArray[np.float64]:
        """Return the distances from a waypoint to all locations, shape (L,)."""
        distances = self._kept.get(waypoint)
        if distances is None:
            everywhere = self._travel.distances_from(waypoint, self._metric, keep=False)
            distances = self._kept[waypoint] = everywhere[self._places]
        return distances

    def to_nearest(self, waypoints: list[int]) -> NDArray[np.float64]:
        """Return each location's distance to the nearest of the given waypoints, shape (L,)."""
        least = np.full(len(self._places), np.inf)
        for waypoint in waypoints:
            to = self._travel.distances_to(waypoint, self._metric)[self._places]
            np.minimum(least, to, out=least)
        return least
