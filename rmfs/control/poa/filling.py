"""Filling free slots order by order: shared by most POA rules."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, TypeVar

from rmfs.control.base import Parameters
from rmfs.control.poa import PickOrderAssignment
from rmfs.control.poa.fast_lane import FastLane
from rmfs.control.poa.ties import TieBreaker, order_rank
from rmfs.world.news import Follower

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np
    from numpy.typing import NDArray

    from rmfs.control.decisions import AssignOrder
    from rmfs.control.view import View
    from rmfs.world.orders import Order
    from rmfs.world.stations import PickStation


class FastLaneParameters(Parameters):
    """Parameters of POA rules with a fast lane."""

    fast_lane: bool = False
    """Whether one slot of each station is reserved for orders that the pod being served there can
    complete."""
    fast_lane_tie_breaker: TieBreaker = "due-time"
    """Tie-breaker among such orders: earliest due time, earliest arrival, or random."""


P = TypeVar("P", bound=Parameters)


class Filling(PickOrderAssignment[P]):
    """Assigns orders to free slots, one after another.

    The fast lane, for rules that have one, comes first. At stations with more than one slot, one is
    reserved for it. Stock can serve an order if all its units are available on pods and not needed
    by an order at a station.
    """

    def __init__(self, parameters: P, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._lane: FastLane | None = None
        if isinstance(parameters, FastLaneParameters) and parameters.fast_lane:
            self._lane = FastLane(view, order_rank(parameters.fast_lane_tie_breaker, rng))
        self._kept_slots = [
            int(self._lane is not None and station.slots > 1) for station in view.pick_stations
        ]
        self._news = Follower(view.slot_news)
        self._to_fill: set[int] = set()

    @abstractmethod
    def next_assignment(self, stations: list[PickStation]) -> AssignOrder | None:
        """Choose an order of the backlog that stock can serve, and one of the given stations.

        None if no order should be assigned now.

        Parameters
        ----------
        stations
            Stations with a slot to fill, ascending; at least one.
        """

    def decide(self) -> Iterator[AssignOrder]:
        """Yield orders for the fast lane, then orders for the other slots."""
        if self._lane is not None:
            yield from self._lane.decide()
        while len(self.view.orders):
            stations = self._stations_to_fill()
            chosen = self.next_assignment(stations) if stations else None
            if chosen is None:
                return
            yield chosen

    def _stations_to_fill(self) -> list[PickStation]:
        """Stations with a slot to fill, ascending; only those with news are checked."""
        stations, to_fill = self.view.pick_stations, self._to_fill
        changed = self._news.take()
        if not changed and not to_fill:
            return []
        for index in changed:
            station = stations[index]
            if station.active and station.free_slots > self._kept_slots[index]:
                to_fill.add(index)
            else:
                to_fill.discard(index)
        return [stations[index] for index in sorted(to_fill)]

    def servable_rows(self) -> NDArray[np.intp]:
        """Return the rows of the backlog whose orders stock can serve, each considered alone."""
        return self.view.orders.servable(self.view.inventory.free_stock).nonzero()[0]

    def oldest_order(self) -> Order | None:
        """Find the order that arrived first among those that stock can serve; None if none can."""
        orders, rows = self.view.orders, self.servable_rows()
        return orders.at_row[rows[orders.index[rows].argmin()]] if len(rows) else None
