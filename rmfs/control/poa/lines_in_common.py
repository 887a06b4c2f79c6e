"""POA lines-in-common: the order that wants most of what orders at a station want."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.control.poa.pairs import BestPair, PairParameters

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.world.stations import PickStation


class LinesInCommon(BestPair[PairParameters]):
    """Puts orders together that want the same SKUs, whichever order and station fit best.

    The score of a pair of order and station is the sum, over the lines of the order, of the number
    of orders at the station with a line for the same SKU, picked or not. The pair with the highest
    score is assigned, until no slot is free. Ties: the tie-breaker, then the order that arrived
    first, then the station with the lowest number.
    """

    parameters_model = PairParameters

    def scores(self, stations: list[PickStation]) -> NDArray[np.int32]:
        """Lines in common."""
        orders = self.view.orders
        lines = self.view.lines[[station.index for station in stations]]
        common: NDArray[np.int32] = (lines[:, orders.sku] * (orders.units > 0)).sum(
            axis=2, dtype=np.int32
        )
        return common
