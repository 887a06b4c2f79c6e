"""Base class of POA rules that score all pairs of station and order."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from rmfs.control.decisions import AssignOrder
from rmfs.control.poa.filling import FastLaneParameters, Filling
from rmfs.control.poa.ties import TieBreaker, first_row

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.world.stations import PickStation


class PairParameters(FastLaneParameters):
    """Parameters of POA rules that score pairs."""

    tie_breaker: TieBreaker = "due-time"
    """Which of several orders with the same score comes first: the one due first (`due-time`), the
    one that arrived first (`first-come`), or a random one (`random`)."""


Q = TypeVar("Q", bound=PairParameters)


class BestPair(Filling[Q]):
    """Base class of rules that repeatedly assign the pair of station and order that scores highest.

    Ties are broken by `tie_breaker`; remaining ties go to the order that arrived first, then to the
    station with the lowest number.
    """

    @abstractmethod
    def scores(self, stations: list[PickStation]) -> NDArray[np.int32]:
        """Return the scores (at least 0) of the B backlog orders at S stations, shape (S, B)."""

    def next_assignment(self, stations: list[PickStation]) -> AssignOrder | None:
        """Choose the pair with the highest score among the orders that stock can serve."""
        orders = self.view.orders
        servable = orders.servable(self.view.inventory.free_stock)
        if not np.count_nonzero(servable):
            return None
        scores = self.scores(stations)
        scores[:, ~servable] = -1
        best = np.maximum.reduce(scores, axis=0)  # a method's wrapper would take longer
        rows = (best == np.maximum.reduce(best)).nonzero()[0]
        row = first_row(rows, orders, self.parameters.tie_breaker, self.draw)
        return AssignOrder(orders.at_row[row], stations[int(scores[:, row].argmax())].index)
