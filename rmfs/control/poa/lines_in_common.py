"""POA lines-in-common: assigns the order with the most SKUs in common with a station's orders."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.control.poa.pairs import BestPair, PairParameters

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.world.stations import PickStation


class LinesInCommon(BestPair[PairParameters]):
    """Groups orders for the same SKUs at a station; the best pair of order and station comes first.

    The score of a pair is the sum, over the lines of the order, of the number of orders at the
    station with a line for the same SKU, even if that line has been picked. The pair with the
    highest score is assigned, then the next, until no order can be assigned. Ties are broken by the
    tie-breaker, then by arrival, then by station number.
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
