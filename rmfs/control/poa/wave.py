"""POA wave: assigns orders by due time and, if due together, by how well they match the pods."""

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
    """Orders due within this many seconds after the first one belong to its wave. With 0, these are
    only the orders due at the same time, as for one truck."""
    missed_last: bool = False
    """Whether orders past their due time, whose truck has left, come last. Otherwise they belong to
    the first wave."""
    fast_lane: bool = True
    """Whether there is a fast lane: orders that the pod at the station can complete are assigned
    first. Stations with several slots reserve one for the fast lane."""


class Wave(BestPair[WaveParameters]):
    """Fills free slots wave by wave, and within a wave by pod match.

    A wave consists of the orders that are due together, as for one truck. The rule takes the first
    wave with an order that stock can serve, and assigns its orders as POA `pod-match` does: the
    pair of order and station for which pods at the station, or on their way there, can supply the
    most units comes first. When no order of the wave can be assigned any more, the next wave
    begins. Ties are broken by the tie-breaker, then by arrival, then by station number.
    """

    parameters_model = WaveParameters

    def scores(self, stations: list[PickStation]) -> NDArray[np.int32]:
        """Return the scores of POA `pod-match`, with a bonus for the first wave, shape (S, B).

        With the bonus, orders of the first wave score above all others.
        """
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
