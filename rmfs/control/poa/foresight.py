"""POA foresight: pairs of station and order by two scores of one's choice."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from rmfs.control.base import Parameters
from rmfs.control.decisions import AssignOrder
from rmfs.control.poa.filling import Filling
from rmfs.control.poa.matching import matches

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.world.stations import PickStation

    Scores = NDArray[np.int32] | NDArray[np.float64]

Score = Literal["matches", "depletion", "surplus", "due-time"]


class ForesightParameters(Parameters):
    """Parameters of POA foresight."""

    score: Score = "matches"
    """What counts: units that spare stock on inbound pods can serve (`matches`); one more for each
    line of which an inbound pod has exactly the units wanted (`depletion`), or at least these
    (`surplus`); or how early the order is due (`due-time`)."""
    tie_breaker: Score = "due-time"
    """What counts among pairs with the same score."""


class Foresight(Filling[ForesightParameters]):
    """Assigns the pair of station and order with the highest score, then the next.

    Ties: the second score, then the station with most free slots, then the order that arrived
    first, then the station with the lowest number. Scores of matches count an available unit for
    one order only; the two bonuses look at each pod by itself, whatever else is wanted of it.
    """

    parameters_model = ForesightParameters

    def next_assignment(self, stations: list[PickStation]) -> AssignOrder | None:
        """Choose the best pair of a servable order and a station."""
        orders = self.view.orders
        rows = self.servable_rows()
        if not len(rows):
            return None
        # the first of equals is wanted: order rows and columns accordingly
        rows = rows[orders.index[rows].argsort()]
        stations = sorted(stations, key=lambda station: -station.free_slots)
        scores = self._scores(self.parameters.score, stations)[:, rows]
        best = scores == scores.max()
        if best.sum() > 1:
            scores = self._scores(self.parameters.tie_breaker, stations)[:, rows]
            best &= scores == scores[best].max()
        station, row = np.argwhere(best)[0].tolist()
        return AssignOrder(orders.at_row[int(rows[row])], stations[station].index)

    def _scores(self, score: Score, stations: list[PickStation]) -> Scores:
        """Score each order at each station, shape (S, B)."""
        if score == "due-time":
            due_s = self.view.orders.due_s
            return np.broadcast_to(-due_s, (len(stations), len(due_s)))
        units = matches(self.view, stations)
        return units if score == "matches" else units + self._bonus(stations, score == "depletion")

    def _bonus(self, stations: list[PickStation], exactly: bool) -> NDArray[np.int64]:
        """Lines of each order for which some inbound pod has exactly, or at least, what is wanted.

        Returns
        -------
        NDArray
            Shape (S, B).
        """
        orders = self.view.orders
        inventory = self.view.inventory
        bonus = np.zeros((len(stations), len(orders)), np.int64)
        for scores, station in zip(bonus, stations, strict=True):
            if station.tasks:
                # what all pods together do not have, none of them has
                enough = inventory.inbound[station.index][orders.sku] >= orders.units
                row, column = (enough & (orders.units > 0)).nonzero()
                wanted = orders.units[row, column][:, None]
                pods = np.array([*station.tasks])
                have = inventory.available[orders.sku[row, column][:, None], pods]
                hit = (have == wanted) if exactly else (have >= wanted)
                scores += np.bincount(row[hit.any(axis=1)], minlength=len(scores))
        return bonus
