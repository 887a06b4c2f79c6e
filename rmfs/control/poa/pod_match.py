"""POA pod-match: assigns the order with the most units on pods that come to the station anyway."""

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
    """Whether orders that are past their due time come before all others."""
    fast_lane: bool = True
    """Whether there is a fast lane: orders that the pod at the station can complete are assigned
    first. Stations with several slots reserve one for the fast lane."""


class PodMatch(BestPair[PodMatchParameters]):
    """Matches orders with pods that are coming anyway, for a high pile-on.

    The score of a pair of order and station is the number of the order's units that pods at the
    station, or on their way there, can supply in addition to what orders at the station still need.
    The pair with the highest score is assigned, then the next, until no order can be assigned. Ties
    are broken by the tie-breaker, then by arrival, then by station number.
    """

    parameters_model = PodMatchParameters

    def scores(self, stations: list[PickStation]) -> NDArray[np.int32]:
        """Return how many units of each order the pods of each station can supply, shape (S, B).

        With `late_first`, the scores of late orders are raised above those of all others.
        """
        scores = matches(self.view, stations)
        if self.parameters.late_first:
            late = self.view.orders.due_s < self.view.now_s
            scores += late * (scores.max() + 1)
        return scores
