"""How well orders match the pods at a station or on their way there."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.traffic import _core as compiled  # the package has one compiled library

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.world.stations import PickStation


def matches(view: View, stations: list[PickStation]) -> NDArray[np.int32]:
    """Return how many units of the B backlog orders the pods of S stations can supply, (S, B).

    The pods of a station are at the station or on their way there. They can supply what they have
    available in addition to the units that orders at the station still need from pods.
    """
    sku, units = view.orders.sku, view.orders.units
    found = np.empty((len(stations), len(sku)), np.int32)
    for row, station in zip(found, stations, strict=True):
        inbound, need = view.inventory.inbound[station.index], view.need[station.index]
        row[:] = compiled.matches(sku, units, inbound, need)
    return found
