"""POA lines-in-common: assigns the order with the most SKUs in common with a station's orders."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.control.poa.pairs import BestPair, PairParameters

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.world.stations import PickStation


class LinesInCommon(BestPair[PairParameters]):
    """Groups orders for the same SKUs at the same station.

    The score of a pair of order and station is a sum over the lines of the order: for each line,
    the number of orders at the station that have a line for the same SKU, picked or not. The pair
    with the highest score is assigned; this is repeated until no order can be assigned. Ties are
    broken by `tie_breaker`; remaining ties go to the order that arrived first, then to the station
    with the lowest number.
    """

    parameters_model = PairParameters

    def scores(self, stations: list[PickStation]) -> NDArray[np.int32]:
        """Return the score of each pair of a station and an order of the backlog, shape (S, B)."""
        orders = self.view.orders
        lines = self.view.lines[[station.index for station in stations]]
        common: NDArray[np.int32] = (lines[:, orders.sku] * (orders.units > 0)).sum(
            axis=2, dtype=np.int32
        )
        return common
