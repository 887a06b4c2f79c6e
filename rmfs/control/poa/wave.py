"""POA wave: orders of the first departure first, and of those the ones that match pods best."""

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
    """Orders due within so many seconds of the first one are of its wave; 0: due when it is, as
    those are that go with one truck."""
    missed_last: bool = False
    """Whether orders past their due time, whose truck has left, come after all others; otherwise
    they are the first wave."""
    fast_lane: bool = True
    """Whether one slot of each station is kept for orders that the pod being served there can
    complete."""


class Wave(BestPair[WaveParameters]):
    """Fills free slots wave by wave, within a wave by pod match.

    A wave are the orders that are due together, as those are that go with one truck. Of the first
    wave that stock can serve, the pair of order and station is assigned that shares most units with
    pods on their way to the station; when the wave has none left, the next begins. Ties: the
    tie-breaker, then the order that arrived first, then the station with the lowest number.
    """

    parameters_model = WaveParameters

    def scores(self, stations: list[PickStation]) -> NDArray[np.int32]:
        """Units matched, and for orders of the first wave more than others can have."""
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
