"""Converts the state of the world to arrays of the planning model."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from rmfs.control.asks import Ask
from rmfs.solvers.control.items import servable
from rmfs.solvers.control.planning.parameters import STEPS_PER_STATION
from rmfs.solvers.control.planning.question import Question, solve
from rmfs.solvers.control.workload import excess_s
from rmfs.solvers.models.planning import Planning
from rmfs.solvers.models.solution import Limits

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.solvers.control.items import Item
    from rmfs.solvers.control.planning.expected import ExpectedLine, ExpectedOrder
    from rmfs.solvers.control.planning.parameters import PlanningParameters
    from rmfs.solvers.control.planning.plan import Plan
    from rmfs.world.orders import Order, OrderLine
    from rmfs.world.stations import PickStation

NONE = -1


@dataclass(frozen=True)
class Memo:
    """The objects behind the indices of a question.

    Attributes
    ----------
    stations
        The pick stations for which the question asks for a plan.
    items
        What each order index stands for: a waiting order, or one line of a waiting order that may
        be split. None for open orders and for future orders.
    expected
        Index of the first future order.
    lines, order_of
        The line behind each line index, and the index of its order.
    under_way
        Pods under way to each of the stations, in order of arrival.
    """

    stations: Sequence[PickStation]
    items: Sequence[Item | None]
    expected: int
    lines: Sequence[OrderLine | ExpectedLine]
    order_of: Sequence[int]
    under_way: Sequence[Sequence[int]]


@dataclass
class _Rows:
    """Orders and lines while they are collected."""

    items: list[Item | None] = field(default_factory=list)
    orders: list[Order | ExpectedOrder] = field(default_factory=list)
    share: list[float] = field(default_factory=list)
    station: list[int] = field(default_factory=list)
    until: list[int] = field(default_factory=list)
    lines: list[OrderLine | ExpectedLine] = field(default_factory=list)
    order_of: list[int] = field(default_factory=list)

    def open(self, order: Order, station: int, until: int) -> None:
        """Add an order that is open at a station."""
        self._add(order, order.lines, station, until)
        self.items.append(None)

    def waiting(self, item: Item) -> None:
        """Add a waiting item."""
        self._add(item.order, item.lines, NONE, NONE)
        self.items.append(item)

    def expect(self, order: ExpectedOrder, split: bool, share: float) -> None:
        """Add a future order, whose value is this share of the value of a waiting order."""
        for lines in [(line,) for line in order.lines] if split else [order.lines]:
            self._add(order, lines, NONE, NONE, share)
            self.items.append(None)

    def _add(
        self,
        order: Order | ExpectedOrder,
        lines: Sequence[OrderLine | ExpectedLine],
        station: int,
        until: int,
        share: float = 1.0,
    ) -> None:
        for line in lines:
            if line.open_units:
                self.lines.append(line)
                self.order_of.append(len(self.station))
        self.orders.append(order)
        self.share.append(share)
        self.station.append(station)
        self.until.append(until)


def under_way(view: View, station: PickStation) -> list[int]:
    """Return pods at, or on their way to, a pick station, in expected order of arrival."""
    head = view.robots[station.robot].pod if station.robot >= 0 else NONE
    bring_s = view.travel.to(station.waypoint, loaded=True)
    coming = []
    for pod, task in station.tasks.items():
        if pod == head:
            continue
        at = view.travel.robot_waypoint(task.robot)
        place = view.storage.place_of[pod]
        if place < 0:
            way_s = bring_s.item(at)
        else:
            reach_s = view.travel.estimate_s(at, view.storage.pod_waypoint[[pod]])
            way_s = float(reach_s[0]) + bring_s.item(place)
        coming.append((way_s, pod))
    coming.sort()
    return [pod for pod in (head, *(pod for _, pod in coming)) if pod >= 0]


def ask(
    view: View,
    given: PlanningParameters,
    stations: Sequence[PickStation],
    plan: Plan,
    seed: int,
    expected: Sequence[Sequence[ExpectedOrder]] = (),
) -> Ask[Question] | None:
    """Return a question about the next plan; None if there is nothing to plan.

    Waiting orders that stock cannot serve are omitted, and so are orders, or lines, that are
    planned for stations other than `stations`.

    Parameters
    ----------
    stations
        The stations whose next visits are to be planned.
    plan
        The previous plan, from which the new one starts.
    seed
        Seed of the search.
    expected
        Future orders, draw by draw (`ExpectedOrders.draw`). Default: none.
    """
    coming = [under_way(view, station) for station in stations]
    others = [station.index for station in view.pick_stations if station not in stations]
    rows = _Rows()
    for number, station in enumerate(stations):
        _add_open(rows, station, number, coming[number])
    taken = plan.keys_of(others)
    splitting = plan.splitting(others)
    items = servable(view, given.split, splitting)
    if given.late_s:
        # of orders that visits serve equally well, the first takes them
        items.sort(key=lambda item: item.order.due_s)
    for item in items:
        if item.key not in taken and (item.order.index, -1) not in taken:
            rows.waiting(item)
    if not rows.lines:
        return None
    known = len(rows.orders)
    for orders in expected:
        for order in orders:
            rows.expect(order, given.split, given.expected_worth / len(expected))
    may_come = view.storage.is_at_hand.copy()
    kept = tuple(tuple(pod for pod in plan.pods[s.index] if may_come[pod]) for s in stations)
    may_come[[pod for station in others for pod in plan.pods[station]]] = False
    data = _planning(view, given, stations, rows, coming, may_come)
    steps = given.steps
    if steps is None:
        steps = STEPS_PER_STATION * len(view.pick_stations)
    limits = Limits(iterations=steps * len(stations), deterministic_s=given.work_s, gap=given.gap)
    question = Question(data, kept, given.method, limits, seed, given.bound_steps)
    sizes = {
        "stations": data.stations,
        "orders": data.orders,
        "lines": data.lines,
        "pods": int(may_come.sum()),
    }
    memo = Memo(stations, rows.items, known, rows.lines, rows.order_of, coming)
    return Ask(solve, question, sizes, memo)


def _add_open(rows: _Rows, station: PickStation, number: int, coming: Sequence[int]) -> None:
    """Add the orders that are open at a station."""
    visit_of = {pod: visit for visit, pod in enumerate(coming)}
    until: dict[int, int] = {}
    for pod, task in station.tasks.items():
        for pick in task.picks:
            order_number = pick.line.order.index
            until[order_number] = max(until.get(order_number, NONE), visit_of[pod])
    for index, order in station.orders.items():
        rows.open(order, number, until.get(index, NONE))


def _planning(
    view: View,
    given: PlanningParameters,
    stations: Sequence[PickStation],
    rows: _Rows,
    coming: Sequence[Sequence[int]],
    may_come: NDArray[np.bool_],
) -> Planning:
    station = np.array(rows.station, np.int64)
    order_of = np.array(rows.order_of, np.int64)
    units = np.array([line.open_units for line in rows.lines], np.int64)
    wanted, sku = np.unique([line.sku for line in rows.lines], return_inverse=True)
    is_open, share = station >= 0, np.array(rows.share)
    return Planning(
        slots=np.array([one.slots for one in stations], np.int64),
        coming=np.array([pod for pods in coming for pod in pods], np.int64),
        coming_to=np.repeat(np.arange(len(coming)), [len(pods) for pods in coming]),
        order_station=station,
        order_until=np.array(rows.until, np.int64),
        order_worth=share * _order_worth(view, given, rows.orders, is_open),
        line_order=order_of,
        line_sku=sku,
        line_units=units,
        line_worth=share[order_of] * given.unit_s * units + given.open_s * is_open[order_of],
        stock=np.ascontiguousarray(view.inventory.available[wanted].T, np.int64),
        cost=_cost(view, given, stations, may_come),
        visits=given.visits,
        decay=given.decay,
    )


def _order_worth(
    view: View,
    given: PlanningParameters,
    orders: Sequence[Order | ExpectedOrder],
    is_open: NDArray[np.bool_],
) -> NDArray[np.float64]:
    """Return the value of completing each order, by waiting and due time, shape (O,), in s."""
    waited_s = view.now_s - np.array([order.created_s for order in orders])
    worth: NDArray[np.float64] = (
        given.order_s + given.age_reward * np.maximum(waited_s, 0.0) * ~is_open
    )
    if given.late_s:
        left_s = np.array([order.due_s for order in orders]) - view.now_s
        weight = np.array([order.weight for order in orders])
        urgency = np.exp(-np.maximum(left_s, 0.0) / given.late_within_s)
        worth = worth + given.late_s * weight * urgency
    return worth


def _cost(
    view: View,
    given: PlanningParameters,
    stations: Sequence[PickStation],
    may_come: NDArray[np.bool_],
) -> NDArray[np.float64]:
    """Return the robot time of a visit, there and back, minus its value, shape (P, S), in s."""
    at = view.storage.pod_waypoint
    cost = np.full((len(at), len(stations)), np.inf)
    uneven = given.balance * excess_s(view, stations) if given.balance else np.zeros(len(stations))
    for number, station in enumerate(stations):
        if station.active:
            way_s = view.travel.to(station.waypoint, loaded=True)[at]
            cost[may_come, number] = (2 * way_s - given.visit_s + uneven[number])[may_come]
    return cost
