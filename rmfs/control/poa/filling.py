"""Base class of most POA rules, which fill free slots order by order."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Any, TypeVar

from rmfs.control.base import Parameters
from rmfs.control.poa import PickOrderAssignment
from rmfs.control.poa.fast_lane import FastLane
from rmfs.control.poa.ties import TieBreaker, order_rank
from rmfs.control.problems import Trigger
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
    """Whether there is a fast lane: an order is assigned to a station before other orders if the
    pod at the head of the station's queue can complete it. Stations with several slots reserve one
    of them for such orders."""
    fast_lane_tie_breaker: TieBreaker = "due-time"
    """Which of several orders suitable for the fast lane comes first: the one due first
    (`due-time`), the one that arrived first (`first-come`), or a random one (`random`)."""


P = TypeVar("P", bound=Parameters)


class Filling(PickOrderAssignment[P]):
    """Assigns orders to free slots, one after another.

    If the rule has a fast lane, orders for it come first, and one slot is reserved for it at each
    station with more than one slot. Stock can serve an order if, apart from the units that orders
    at stations need, enough units of each of the order's SKUs are available on the pods.
    """

    hears = frozenset({Trigger.ORDER_CUT})

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

    def hear(self, trigger: Trigger, subject: Any) -> None:
        """Let the fast lane check an order that has lost units."""
        if self._lane is not None:
            self._lane.cut(subject)

    @abstractmethod
    def next_assignment(self, stations: list[PickStation]) -> AssignOrder | None:
        """Choose the next assignment: a backlog order that stock can serve, and one of `stations`.

        Return None if no order should be assigned now.

        Parameters
        ----------
        stations
            One or more stations, each with a slot to fill, in order of their numbers.
        """

    def decide(self) -> Iterator[AssignOrder]:
        """Yield assignments of orders for the fast lane, then of other orders."""
        if self._lane is not None and (promising := self._lane.promising()):
            yield from self._lane.decide(promising)
        backlog = self.view.orders.orders
        while backlog:
            stations = self._stations_to_fill()
            chosen = self.next_assignment(stations) if stations else None
            if chosen is None:
                return
            yield chosen

    def _stations_to_fill(self) -> list[PickStation]:
        """Return the stations with a slot to fill, ascending; only changed ones are checked."""
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
        """Return the rows of backlog orders that stock can serve, each order considered alone."""
        return self.view.orders.servable(self.view.inventory.free_stock).nonzero()[0]

    def oldest_order(self) -> Order | None:
        """Find the oldest of the orders that stock can serve; None if stock can serve none."""
        orders, rows = self.view.orders, self.servable_rows()
        return orders.at_row[rows[orders.index[rows].argmin()]] if len(rows) else None
