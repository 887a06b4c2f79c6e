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
from rmfs.control.turns import Turn

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np

    from rmfs.control.poa.criteria import Scores
    from rmfs.control.view import View
    from rmfs.world.orders import Order
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
        return Steps(self)

    def completed_by_pod(self, pod: int, station: PickStation) -> int:
        """Choose an order that a pod completes, preferably of the station's pool; -1 if none."""
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

    def from_pool(self, station: PickStation) -> int:
        """Choose an order of a station's pool for a slot; -1 if there is no order or no slot."""
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


class Pools:
    """Fills the pools, choosing one pair of order and station at a time."""

    def __init__(self, rule: Queue) -> None:
        self._rule = rule
        self._length = rule.parameters.queue_length
        self._contests: list[Contest] = []
        self._first: list[Scores] = []
        self._chosen: tuple[PickStation, int] | None = None
        view, orders = rule.view, rule.view.orders
        stations = [s for s in view.pick_stations if s.active and len(s.queued) < self._length]
        if not stations:
            return
        servable = orders.servable(view.inventory.free_stock)
        rows = (servable & (orders.queued_at < 0)).nonzero()[0]
        if len(rows):
            contest = Contest.of(view, stations[0], rows, for_pool=True)
            self._contests = [contest.at(station) for station in stations]
            self._first = [self._first_scores(contest) for contest in self._contests]

    def next(self) -> QueueOrder | None:
        """Choose the next order to join a pool; None if there is none."""
        if self._chosen is not None:
            self._go_on(*self._chosen)
        found = None
        if self._contests:
            rule = self._rule
            found = best(self._contests, rule.parameters.queue_criteria, rule.rng, self._first)
        if found is None:
            self._contests, self._chosen = [], None
            return None
        self._chosen = station, row = found[0].station, found[1]
        return QueueOrder(self._rule.view.orders.at_row[row], station.index)

    def _go_on(self, station: PickStation, row: int) -> None:
        """Take the order that has joined a pool out of the contests."""
        # rows do not change while orders only join pools
        others = [contest.rows != row for contest in self._contests]
        self._contests = [c.narrowed(to) for c, to in zip(self._contests, others, strict=True)]
        self._first = [scores[to] for scores, to in zip(self._first, others, strict=True)]
        place = [contest.station for contest in self._contests].index(station)
        if len(station.queued) < self._length:
            self._first[place] = self._first_scores(self._contests[place])
        else:
            del self._contests[place], self._first[place]

    def _first_scores(self, contest: Contest) -> Scores:
        rule = self._rule
        return rule.parameters.queue_criteria[0].score(contest, rule.rng)


class Slots:
    """Fills slots, first by the fast lane, then from the pools."""

    def __init__(self, rule: Queue) -> None:
        self._rule = rule
        stations = list(rule.view.pick_stations)
        self._lane = list(stations) if rule.parameters.fast_lane else []
        self._turns = stations
        self._round = iter(list(stations))

    def next(self) -> AssignOrder | None:
        """Choose the next order that gets a slot; None if there is none."""
        return self._by_lane() or self._in_turn()

    def _by_lane(self) -> AssignOrder | None:
        """Choose an order that the pod at the head of its station completes."""
        view = self._rule.view
        while self._lane:
            station = self._lane[0]
            if station.active and station.robot >= 0 and station.free_slots > 0:
                pod = view.robots[station.robot].pod
                row = self._rule.completed_by_pod(pod, station)
                if row >= 0:
                    return AssignOrder(view.orders.at_row[row], station.index)
            del self._lane[0]
        return None

    def _in_turn(self) -> AssignOrder | None:
        """Let the next station take an order of its pool; None if no station can."""
        while self._turns:
            for station in self._round:
                row = self._rule.from_pool(station)
                if row >= 0:
                    return AssignOrder(self._rule.view.orders.at_row[row], station.index)
                self._turns.remove(station)
            self._round = iter(list(self._turns))
        return None


class Steps(Turn[AssignOrder | QueueOrder]):
    """The decisions of one call of the rule: pools and slots are filled until nothing changes."""

    def __init__(self, rule: Queue) -> None:
        self._rule = rule
        self._leaving: Iterator[Order] | None = None
        self._pools: Pools | None = None
        self._slots: Slots | None = None
        self._free = 0

    def __next__(self) -> AssignOrder | QueueOrder:
        stations = self._rule.view.pick_stations
        if self._leaving is None:
            off = [station for station in stations if not station.active]
            self._leaving = iter([order for station in off for order in station.queued.values()])
        for order in self._leaving:
            return QueueOrder(order, -1)
        while True:
            if self._slots is None:
                self._pools = self._pools or Pools(self._rule)
                joining = self._pools.next()
                if joining is not None:
                    return joining
                self._slots, self._free = Slots(self._rule), sum(s.free_slots for s in stations)
            assigned = self._slots.next()
            if assigned is not None:
                return assigned
            if self._free == sum(station.free_slots for station in stations):
                raise StopIteration
            self._pools = self._slots = None
