"""Workload of pick stations, for balancing it over the stations and their pickers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.world.stations import PickStation


def excess_s(view: View, stations: Sequence[PickStation]) -> NDArray[np.float64]:
    """Return by how much each station's work exceeds that of the least busy one, shape (S,), in s.

    The work of a station is the time that its current picker needs for the unpicked units of its
    orders. The least busy station is determined among the active ones.
    """
    work_s = np.array([_work_s(view, station) for station in stations])
    active = np.array([station.active for station in stations], np.bool_)
    if not active.any():
        return np.zeros(len(stations))
    least_s = float(work_s[active].min())
    excess: NDArray[np.float64] = np.maximum(work_s - least_s, 0.0)
    return excess


def _work_s(view: View, station: PickStation) -> float:
    units = sum(order.unpicked_units for order in station.orders.values())
    return units * view.unit_s(station.index)
