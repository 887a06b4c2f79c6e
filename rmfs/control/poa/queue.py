"""POA queue: every station has a pool of orders from which its slots are filled."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import pydantic

from rmfs.control.base import Parameters
from rmfs.control.decisions import AssignOrder, QueueOrder
from rmfs.control.poa import PickOrderAssignment
from rmfs.control.poa.contest import Contest
from rmfs.control.poa.criteria import (
    Completable,
    DueSoon,
    DueTime,
    FirstCome,
    InboundMatches,
    OrderCriterion,
    Related,
    Size,
    best,
)
from rmfs.control.problems import Trigger

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np

    from rmfs.control.poa.criteria import Scores
    from rmfs.control.view import View
    from rmfs.world.stations import PickStation

Criteria = Annotated[tuple[OrderCriterion, ...], pydantic.Field(min_length=1)]


class QueueParameters(Parameters):
    """Parameters of POA queue."""

    queue_length: Annotated[int, pydantic.Field(ge=1)] = 20
    """Maximum number of orders in the pool of each station. Orders in a pool are not available to
    other stations, so the number of orders in all pools together should be clearly smaller than the
    backlog."""
    queue_criteria: Criteria = (InboundMatches(), Related(), DueTime())
    """Criteria, in order of priority, for choosing which order joins the pool of which station
    next."""
    station_criteria: Criteria = (DueSoon(), Completable(), Completable(by="all-pods"))
    """Criteria, in order of priority, for choosing which order of a station's pool gets a slot
    next."""
    fast_lane: bool = True
    """Whether orders that the pod at the head of a station's queue can complete are assigned to the
    station before other orders (fast lane). Stations with several slots reserve one of them for
    such orders."""
    fast_lane_criteria: Criteria = (Size(), DueTime(), FirstCome())
    """Criteria, in order of priority, for choosing among several orders suitable for the fast
    lane."""


class Queue(PickOrderAssignment[QueueParameters]):
    """Assigns orders in two stages: first to the pool of a station, later to one of its slots.

    1. Pools are filled with orders that stock can serve, one at a time: of all pairs of an order
    and a station, the best by `queue_criteria` is chosen. Even before the orders of a pool have
    slots, pods may be fetched for them, and the units that they need may be bound to these pods.
    2. If there is a fast lane, each station with a free slot assigns it to an order that the pod at
    the head of the station's queue completes. Orders of the station's pool come before orders in no
    pool. This is repeated until there is no such order, or no free slot.
    3. Stations with a free slot that is not reserved for the fast lane take turns. In each turn, a
    station assigns a slot to an order of its pool that stock can serve. This ends when no station
    can assign another order.

    These steps are repeated until nothing changes. Only active stations have a pool. Units that the
    open orders of a station need do not count as available for further orders. Orders are chosen by
    the criteria in the parameters, which `rmfs.control.poa.criteria` describes. Remaining ties go
    to the order that arrived first, then to the station with the lowest number. In addition to the
    events after which every POA rule is called, the rule is called whenever a pod reaches the head
    of a queue, so that the orders for which the pod was fetched can get slots.
    """

    parameters_model = QueueParameters
    subscriptions = frozenset({Trigger.POD_AT_STATION})

    def __init__(self, parameters: QueueParameters, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._kept_slots = [
            int(parameters.fast_lane and station.slots > 1) for station in view.pick_stations
        ]

    def decide(self) -> Iterator[AssignOrder | QueueOrder]:
        """Empty the pools of inactive stations, then fill pools and slots step by step."""
        for station in self.view.pick_stations:
            if not station.active:
                for order in list(station.queued.values()):
                    yield QueueOrder(order, -1)
        yield from self._fill_pools()
        while True:
            slots = sum(station.free_slots for station in self.view.pick_stations)
            if self.parameters.fast_lane:
                yield from self._fast_lane()
            yield from self._take_turns()
            if slots == sum(station.free_slots for station in self.view.pick_stations):
                return
            yield from self._fill_pools()

    # --- pools ----------------------------------------------------------------------------------

    def _fill_pools(self) -> Iterator[QueueOrder]:
        """Assign orders to pools, pair by pair."""
        orders, length = self.view.orders, self.parameters.queue_length
        stations = [s for s in self.view.pick_stations if s.active and len(s.queued) < length]
        if not stations:
            return
        servable = orders.servable(self.view.inventory.free_stock)
        rows = (servable & (orders.queued_at < 0)).nonzero()[0]
        if not len(rows):
            return
        contest = Contest.of(self.view, stations[0], rows, for_pool=True)
        contests = [contest.at(station) for station in stations]
        first = [self._first_scores(contest) for contest in contests]
        while contests:
            found = best(contests, self.parameters.queue_criteria, self.rng, first)
            if found is None:
                return
            station, row = found[0].station, found[1]
            yield QueueOrder(orders.at_row[row], station.index)
            # rows do not change while orders only join pools
            others = [contest.rows != row for contest in contests]
            contests = [c.narrowed(to) for c, to in zip(contests, others, strict=True)]
            first = [scores[to] for scores, to in zip(first, others, strict=True)]
            place = [contest.station for contest in contests].index(station)
            if len(station.queued) < length:
                first[place] = self._first_scores(contests[place])
            else:
                del contests[place], first[place]

    def _first_scores(self, contest: Contest) -> Scores:
        return self.parameters.queue_criteria[0].score(contest, self.rng)

    # --- slots ----------------------------------------------------------------------------------

    def _fast_lane(self) -> Iterator[AssignOrder]:
        """Yield orders that the pod at the head of their station completes."""
        for station in self.view.pick_stations:
            while station.active and station.robot >= 0 and station.free_slots > 0:
                pod = self.view.robots[station.robot].pod
                row = self._completed_by(pod, station)
                if row < 0:
                    break
                yield AssignOrder(self.view.orders.at_row[row], station.index)

    def _completed_by(self, pod: int, station: PickStation) -> int:
        """Choose an order that the pod completes, preferably of the pool; -1 if there is none."""
        if pod not in station.tasks:
            return -1
        queued_at = self.view.orders.queued_at
        for rows in ((queued_at == station.index).nonzero()[0], (queued_at < 0).nonzero()[0]):
            contest = Contest.of(self.view, station, rows, for_pool=False)
            completed = contest.completed_by(pod)
            if completed.any():
                contests = [contest.narrowed(completed)]
                found = best(contests, self.parameters.fast_lane_criteria, self.rng)
                assert found is not None
                return found[1]
        return -1

    def _take_turns(self) -> Iterator[AssignOrder]:
        """Let the stations in turn take an order of their pool, as long as possible."""
        stations = list(self.view.pick_stations)
        while stations:
            for station in list(stations):
                row = self._from_pool(station)
                if row < 0:
                    stations.remove(station)
                else:
                    yield AssignOrder(self.view.orders.at_row[row], station.index)

    def _from_pool(self, station: PickStation) -> int:
        """Choose an order of a station's pool for a slot; -1 if there is none, or no slot."""
        if not station.active or station.free_slots <= self._kept_slots[station.index]:
            return -1
        if not station.queued:
            return -1
        orders = self.view.orders
        servable = orders.servable(self.view.inventory.free_stock)
        rows = (servable & (orders.queued_at == station.index)).nonzero()[0]
        contest = Contest.of(self.view, station, rows, for_pool=False)
        found = best([contest], self.parameters.station_criteria, self.rng)
        return -1 if found is None else found[1]
