"""From the world to the arrays of the planning model."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from rmfs.control.asks import Ask
from rmfs.solvers.control.items import servable
from rmfs.solvers.control.planning.question import Question, solve
from rmfs.solvers.control.workload import excess_s
from rmfs.solvers.models.planning import Planning
from rmfs.solvers.models.solution import Limits

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.solvers.control.items import Item
    from rmfs.solvers.control.planning.parameters import PlanningParameters
    from rmfs.solvers.control.planning.plan import Plan
    from rmfs.world.orders import Order, OrderLine
    from rmfs.world.stations import PickStation

NONE = -1


@dataclass(frozen=True)
class Memo:
    """What the numbers of a question mean.

    Attributes
    ----------
    stations
        The pick stations that are planned for.
    items
        The waiting order, or line of an order that may be split, of each number of an order; None
        for orders that are open.
    lines, order_of
        The line of each number, and the number of its order.
    under_way
        Pods under way to each of the stations, in the order in which they come.
    """

    stations: Sequence[PickStation]
    items: Sequence[Item | None]
    lines: Sequence[OrderLine]
    order_of: Sequence[int]
    under_way: Sequence[Sequence[int]]


@dataclass
class _Rows:
    """Orders and lines as they are collected."""

    items: list[Item | None] = field(default_factory=list)
    orders: list[Order] = field(default_factory=list)
    station: list[int] = field(default_factory=list)
    until: list[int] = field(default_factory=list)
    lines: list[OrderLine] = field(default_factory=list)
    order_of: list[int] = field(default_factory=list)

    def open(self, order: Order, station: int, until: int) -> None:
        """Add an order that a station has."""
        self._add(order, order.lines, station, until)
        self.items.append(None)

    def waiting(self, item: Item) -> None:
        """Add what waits."""
        self._add(item.order, item.lines, NONE, NONE)
        self.items.append(item)

    def _add(self, order: Order, lines: Sequence[OrderLine], station: int, until: int) -> None:
        for line in lines:
            if line.open_units:
                self.lines.append(line)
                self.order_of.append(len(self.station))
        self.orders.append(order)
        self.station.append(station)
        self.until.append(until)


def under_way(view: View, station: PickStation) -> list[int]:
    """Pods at, or on their way to, a pick station, in the order in which they should come."""
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
) -> Ask[Question] | None:
    """Ask for a plan; None if there is nothing to plan.

    Waiting orders that the stock cannot serve are left out, and what is planned for other stations.

    Parameters
    ----------
    stations
        Those that are planned for.
    plan
        The last plan, from which this one goes on.
    seed
        Seed of the search.
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
        # of orders that visits serve alike the first takes them
        items.sort(key=lambda item: item.order.due_s)
    for item in items:
        if item.key not in taken and (item.order.index, -1) not in taken:
            rows.waiting(item)
    if not rows.lines:
        return None
    may_come = view.storage.is_at_hand.copy()
    kept = tuple(tuple(pod for pod in plan.pods[s.index] if may_come[pod]) for s in stations)
    may_come[[pod for station in others for pod in plan.pods[station]]] = False
    data = _planning(view, given, stations, rows, coming, may_come)
    steps = given.steps * len(stations)
    limits = Limits(iterations=steps, deterministic_s=given.work_s, gap=given.gap)
    question = Question(data, kept, given.method, limits, seed, given.bound_steps)
    sizes = {
        "stations": data.stations,
        "orders": data.orders,
        "lines": data.lines,
        "pods": int(may_come.sum()),
    }
    return Ask(
        solve, question, sizes, Memo(stations, rows.items, rows.lines, rows.order_of, coming)
    )


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
    is_open = station >= 0
    return Planning(
        slots=np.array([one.slots for one in stations], np.int64),
        coming=np.array([pod for pods in coming for pod in pods], np.int64),
        coming_to=np.repeat(np.arange(len(coming)), [len(pods) for pods in coming]),
        order_station=station,
        order_until=np.array(rows.until, np.int64),
        order_worth=_order_worth(view, given, rows.orders, is_open),
        line_order=order_of,
        line_sku=sku,
        line_units=units,
        line_worth=given.unit_s * units + given.open_s * is_open[order_of],
        stock=np.ascontiguousarray(view.inventory.available[wanted].T, np.int64),
        cost=_cost(view, given, stations, may_come),
        visits=given.visits,
        decay=given.decay,
    )


def _order_worth(
    view: View,
    given: PlanningParameters,
    orders: Sequence[Order],
    is_open: NDArray[np.bool_],
) -> NDArray[np.float64]:
    """Worth of closing orders, shape (O,), s: by the time they have waited, and by due times."""
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
    """Time of a robot for a visit, the way there and back, less its worth, shape (P, S), s."""
    at = view.storage.pod_waypoint
    cost = np.full((len(at), len(stations)), np.inf)
    uneven = given.balance * excess_s(view, stations) if given.balance else np.zeros(len(stations))
    for number, station in enumerate(stations):
        if station.active:
            way_s = view.travel.to(station.waypoint, loaded=True)[at]
            cost[may_come, number] = (2 * way_s - given.visit_s + uneven[number])[may_come]
    return cost
