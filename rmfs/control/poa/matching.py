"""How well orders match the pods at a station or on their way there."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.world.stations import PickStation


def line_matches(view: View, station: int) -> NDArray[np.int32]:
    """Return how many units of each backlog order line can come from inbound pods, shape (B, L).

    Inbound pods are at the station or on their way there. They can supply what they have
    available in addition to the units that orders at the station still need from pods.
    """
    orders = view.orders
    by_sku: NDArray[np.int32] = view.inventory.inbound[station] - view.need[station]
    spare = by_sku.take(orders.sku)
    np.minimum(spare, orders.units, out=spare)
    np.maximum(spare, 0, out=spare)
    return spare


def matches(view: View, stations: list[PickStation]) -> NDArray[np.int32]:
    """Return how many units of each order can come from the inbound pods of each station, (S, B).

    `line_matches` explains which units count.
    """
    found = np.empty((len(stations), len(view.orders.at_row)), np.int32)
    for row, station in zip(found, stations, strict=True):
        row[:] = np.einsum("bl->b", line_matches(view, station.index))
    return found
