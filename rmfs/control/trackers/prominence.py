"""Prominence of storage locations: their rank by travel time to the nearest pick station."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.control.trackers import Tracker

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.control.view import View


class Prominence(Tracker):
    """Storage locations ranked by a loaded robot's travel time to the nearest pick station.

    Rank 0 is the most prominent. Locations with equal times share a rank; no rank is skipped.

    Attributes
    ----------
    seconds
        Time in s from each of the L storage locations to its nearest pick station, shape (L,).
    rank
        Rank of each location, shape (L,).
    in_order
        Indices of the locations, the most prominent first; ties are in order of index, shape (L,).
    """

    def __init__(self, view: View) -> None:
        super().__init__(view)
        self.seconds: NDArray[np.float64] = np.min(
            [
                view.travel.to(station.waypoint, loaded=True)[view.storage.places]
                for station in view.pick_stations
            ],
            axis=0,
        )
        self.rank: NDArray[np.intp] = np.unique(self.seconds, return_inverse=True)[1]
        self.in_order: NDArray[np.intp] = np.argsort(self.seconds, kind="stable")
