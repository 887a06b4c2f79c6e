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
    """Return each station's work minus the least work of all stations, shape (S,), in s.

    Work is the unpicked units of orders at the station, in seconds of its current picker. Inactive
    stations are excluded from the comparison.
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
