"""Travel times between storage locations and stations."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.world.robots import Robot

UNREACHABLE_S = 1e5
"""Time used where there is no path, in s."""


class Ways:
    """Travel times of storing and fetching pods, for each of the L storage locations (places).

    Parameters
    ----------
    view
        The world.
    """

    def __init__(self, view: View) -> None:
        self._view = view
        self._stored: dict[int, NDArray[np.float64]] = {}

    @cached_property
    def fetch_s(self) -> NDArray[np.float64]:
        """Mean loaded travel time from each place to the pick stations, shape (L,), in s."""
        view = self._view
        places = view.storage.places
        times = [view.travel.to(s.waypoint, loaded=True)[places] for s in view.pick_stations]
        mean_s: NDArray[np.float64] = np.mean(times, axis=0)
        return np.minimum(mean_s, UNREACHABLE_S)

    @cached_property
    def home_s(self) -> NDArray[np.float64]:
        """Mean loaded travel time from the pick stations to each place, shape (L,), in s."""
        stations = [self.store_s(s.waypoint) for s in self._view.pick_stations]
        mean_s: NDArray[np.float64] = np.mean(stations, axis=0)
        return np.minimum(mean_s, UNREACHABLE_S)

    def store_s(self, waypoint: int) -> NDArray[np.float64]:
        """Return the loaded travel time from a waypoint to each place, shape (L,), in s.

        The time is inf for unreachable places.
        """
        times = self._stored.get(waypoint)
        if times is None:
            view = self._view
            times = view.travel.away(waypoint, loaded=True)[view.storage.places]
            self._stored[waypoint] = times
        return times

    def storing_s(self, robots: Sequence[Robot]) -> NDArray[np.float64]:
        """Return loaded travel times from robots' waypoints to the places, shape (R, L), in s."""
        return np.stack([self.store_s(robot.waypoint) for robot in robots])
