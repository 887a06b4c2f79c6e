"""POA pod-match: assigns the orders that best match the pods at, or coming to, a station."""

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
    """Whether orders that the pod at the head of a station's queue can complete are assigned to the
    station before other orders (fast lane). Stations with several slots reserve one of them for
    such orders."""


class PodMatch(BestPair[PodMatchParameters]):
    """Assigns orders that match the pods at a station or on their way to it, for a high pile-on.

    The score of a pair of order and station is the number of units of the order that pods at the
    station, or on their way to it, can supply. Units that orders already at the station still need
    are not counted. The pair with the highest score is assigned; this is repeated until no order
    can be assigned. Ties are broken by `tie_breaker`; remaining ties go to the order that arrived
    first, then to the station with the lowest number.
    """

    parameters_model = PodMatchParameters

    def scores(self, stations: list[PickStation]) -> NDArray[np.int32]:
        """Return how many units the pods of each station can supply for each order, shape (S, B).

        With `late_first`, the scores of late orders are raised above those of all others.
        """
        scores = matches(self.view, stations)
        if self.parameters.late_first:
            late = self.view.orders.due_s < self.view.now_s
            scores += late * (scores.max() + 1)
        return scores
