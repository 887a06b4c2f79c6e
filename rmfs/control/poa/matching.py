"""How well orders match the pods at a station or on their way to it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.traffic import _core as compiled  # the package has one compiled library

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.world.stations import PickStation


def matches(view: View, stations: list[PickStation]) -> NDArray[np.int32]:
    """Return how many units the pods of each station can supply for each backlog order, (S, B).

    The pods of a station are those at the station and those on their way to it. Available units
    that the station's open orders still need are not counted.
    """
    sku, units = view.orders.sku, view.orders.units
    found = np.empty((len(stations), len(sku)), np.int32)
    for row, station in zip(found, stations, strict=True):
        inbound, need = view.inventory.inbound[station.index], view.need[station.index]
        row[:] = compiled.matches(sku, units, inbound, need)
    return found
