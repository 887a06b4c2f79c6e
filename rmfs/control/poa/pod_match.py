"""POA pod-match: the order with the most units on pods on their way to the station."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.control.poa.matching import matches
from rmfs.control.poa.pairs import BestPair, PairParameters

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from rmfs.world.stations import PickStation


class PodMatchParameters(PairParameters):
    """Parameters of POA pod-match."""

    late_first: bool = False
    """Whether orders past their due time come before all others."""
    fast_lane: bool = True
    """Whether one slot of each station is reserved for orders that the pod being served there can
    complete."""


class PodMatch(BestPair[PodMatchParameters]):
    """Matches orders with pods that are coming anyway, for a high pile-on.

    The score of a pair of order and station is the number of its units that are available on pods
    inbound to the station; each available unit counts for one order only. The pair with the highest
    score is assigned until no slot is free. Ties are broken by the tie-breaker, then by arrival,
    then by station number.
    """

    parameters_model = PodMatchParameters

    def scores(self, stations: list[PickStation]) -> NDArray[np.int32]:
        """Units matched, (S, B); with `late_first`, late orders score higher than all others."""
        scores = matches(self.view, stations)
        if self.parameters.late_first:
            late = self.view.orders.due_s < self.view.now_s
            scores += late * (scores.max() + 1)
        return scores
