"""POA wave: assigns orders in waves by due time; in a wave, the best matches with pods first."""

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
    """Length of a wave in seconds: the wave consists of the orders that are due at most this long
    after the first of them. With 0, all orders of a wave are due at the same time."""
    missed_last: bool = False
    """Whether orders that are past their due time come last, since their truck has left. If false,
    they belong to the first wave."""
    fast_lane: bool = True
    """Whether orders that the pod at the head of a station's queue can complete are assigned to the
    station before other orders (fast lane). Stations with several slots reserve one of them for
    such orders."""


class Wave(BestPair[WaveParameters]):
    """Fills free slots wave by wave; within a wave, orders that match the pods best come first.

    A wave consists of the orders that are due together (`wave_s`), as for one truck. The rule
    starts with the earliest wave that has an order which stock can serve. Within the wave, it
    assigns orders as POA `pod-match` does: the pair of order and station for which pods at the
    station, or on their way to it, can supply the most units comes first. When no further order of
    the wave can be assigned, the next wave begins. Ties are broken by `tie_breaker`; remaining ties
    go to the order that arrived first, then to the station with the lowest number.
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
