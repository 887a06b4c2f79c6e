"""POA wave: orders of the earliest departure first, and of those the best match with pods."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import numpy as np
import pydantic

from rmfs.control.poa.matching import matches
from rmfs.control.poa.pairs import BestPair, PairParameters

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.world.stations import PickStation


class WaveParameters(PairParameters):
    """Parameters of POA wave."""

    wave_s: Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)] = 0.0
    """Orders due within this many seconds of the earliest one belong to its wave; 0: only orders
    due at the same time, as for one truck."""
    missed_last: bool = False
    """Whether orders past their due time, whose truck has left, come last; otherwise they are the
    first wave."""
    fast_lane: bool = True
    """Whether one slot of each station is reserved for orders that the pod being served there can
    complete."""


class Wave(BestPair[WaveParameters]):
    """Fills free slots wave by wave, and within a wave by pod match.

    A wave consists of the orders that are due together, as for one truck. From the first wave that
    stock can serve, the rule assigns the pair of order and station with the most units on pods
    inbound to the station; when the wave has no order left, the next one begins. Ties are broken by
    the tie-breaker, then by arrival, then by station number.
    """

    parameters_model = WaveParameters

    def scores(self, stations: list[PickStation]) -> NDArray[np.int32]:
        """Units matched, shape (S, B); orders of the first wave score higher than all others."""
        scores = matches(self.view, stations)
        orders = self.view.orders
        servable = orders.servable(self.view.inventory.free_stock)
        late = orders.due_s < self.view.now_s
        first = servable & ~late if self.parameters.missed_last else servable
        if not first.any():
            first = servable
        wave = first & (orders.due_s <= orders.due_s[first].min() + self.parameters.wave_s)
        if not self.parameters.missed_last:
            wave |= late
        scores += wave * (scores.max() + 1)
        return scores
