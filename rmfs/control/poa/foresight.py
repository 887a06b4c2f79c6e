"""POA foresight: assigns the station-order pair with the best score; a second score breaks ties."""

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
    """Score of a pair of station and order. `matches`: number of units of the order that pods at
    the station, or on their way to it, can supply from spare stock. `depletion`: `matches`, plus 1
    for each order line for which one of these pods has exactly the units needed. `surplus`:
    `matches`, plus 1 for each order line for which one of these pods has at least the units needed.
    `due-time`: the earlier the due time, the higher the score."""
    tie_breaker: Score = "due-time"
    """Second score, which is used for pairs with the same `score`. The values are those of
    `score`."""


class Foresight(Filling[ForesightParameters]):
    """Repeatedly assigns the pair of station and order with the highest score.

    Ties are broken by a second score (`tie_breaker`). Remaining ties go to the station with the
    most free slots, then to the station with the lowest number, then to the order that arrived
    first. Spare stock (see the parameter `score`) is stock that the open orders of the station do
    not need. For the additional points of `depletion` and `surplus`, however, all available units
    of a pod count, even those that other orders need.
    """

    parameters_model = ForesightParameters

    def next_assignment(self, stations: list[PickStation]) -> AssignOrder | None:
        """Choose the best pair of a station and an order that stock can serve."""
        orders = self.view.orders
        rows = self.servable_rows()
        if not len(rows):
            return None
        # the first of equals wins, so order rows and columns accordingly
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
        """Count lines for which some inbound pod has exactly, or at least, the units needed.

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
                # what all pods together lack, no single pod has
                enough = inventory.inbound[station.index][orders.sku] >= orders.units
                row, column = (enough & (orders.units > 0)).nonzero()
                wanted = orders.units[row, column][:, None]
                pods = np.array([*station.tasks])
                have = inventory.available[orders.sku[row, column][:, None], pods]
                hit = (have == wanted) if exactly else (have >= wanted)
                scores += np.bincount(row[hit.any(axis=1)], minlength=len(scores))
        return bonus
