"""Converts the state of the world to arrays of the pile-on models."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from rmfs.control.asks import Ask
from rmfs.solvers.control.items import Item, servable
from rmfs.solvers.control.pile_on.question import Question, solve
from rmfs.solvers.control.workload import excess_s
from rmfs.solvers.models.pile_on import Candidates, PileOn, everything
from rmfs.solvers.models.pile_on.candidates import whole_price
from rmfs.solvers.models.pile_on.partial_assignment import PartialAssignment

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.solvers.control.pile_on.parameters import JointParameters
    from rmfs.solvers.control.pile_on.plan import Plan
    from rmfs.world.orders import Order
    from rmfs.world.robots import Robot
    from rmfs.world.stations import PickStation

UNREACHABLE_S = 1e5
"""Time used where there is no path, in s."""


@dataclass(frozen=True)
class Snapshot:
    """Arrays for one instant, and the objects behind their indices.

    Attributes
    ----------
    items
        The order, or line, behind each order index of the model.
    robots
        The robot behind each robot index.
    """

    data: PileOn
    items: Sequence[Item]
    robots: Sequence[Robot] = ()

    def ask(self, given: JointParameters) -> Ask[Question]:
        """Return the question for the optimiser."""
        data = self.data
        sizes = {
            "stations": int((data.slots > 0).sum()),
            "orders": data.orders,
            "lines": data.lines,
            "pods": int(data.available.sum()),
            "skus": data.skus,
            "robots": data.robots,
        }
        question = Question(data, given.method, given.limits, given.pruning, given.bound_steps)
        return Ask(solve, question, sizes, self)


def take(
    view: View, plan: Plan, given: JointParameters, robots: Sequence[Robot] | None = None
) -> Snapshot | None:
    """Return a snapshot of what is to be decided now; None if there is nothing to decide.

    Orders that stock cannot serve are omitted. So are orders in the plan: their units count as
    demand of the station for which they are planned, and the pods that the plan calls count as
    under way. At each station, the model may fill one slot for each order (or line, if orders are
    split) that pods under way can serve on their own, and one further slot if a pod may be called
    to the station. With `when_needed = false`, it may fill all free slots for which nothing is
    planned.

    Parameters
    ----------
    robots
        Robots that are free to fetch pods; None if the model does not choose robots.
    """
    taken = plan.keys()
    open_units = _open_units(view, plan)
    splitting = plan.splitting(_worth_splitting(view, plan, given, open_units))
    items = [
        item
        for item in servable(view, given.split, splitting)
        if item.key not in taken and (item.order.index, -1) not in taken
    ]
    if not items and not open_units.any():
        return None
    data = _arrays(view, plan, given, items, open_units)
    if robots is not None:
        data = replace(data, fetch=_fetch(view, robots), robot_pod=np.full(len(robots), -1))
    if given.by_work:
        may_call = np.array([_runs_short(view, plan, given, s) for s in view.pick_stations])
    else:
        may_call = np.array([_needs_pod(view, plan, given, s) for s in view.pick_stations])
        may_call |= (data.shortage > 0).any(axis=1)
    if given.when_needed:
        slots = np.minimum(_coverable(data) + may_call, data.slots)
    else:
        free = [s.free_slots - len(plan.items[s.index]) for s in view.pick_stations]
        slots = np.minimum(np.maximum(free, 0), data.slots)
    if not slots.any() and not data.shortage.any():
        return None
    return Snapshot(replace(data, slots=slots, may_call=may_call), items, robots or ())


def _worth_splitting(
    view: View, plan: Plan, given: JointParameters, open_units: NDArray[np.int64]
) -> Callable[[Order], bool] | None:
    """Return a test of whether an order should be split; None if splitting costs nothing.

    The test is true if serving the whole order now would cost more than an additional tote.
    """
    if not given.split or not given.part_s:
        return None
    whole = [Item(order) for order in view.orders if len(order.lines) > 1 and not order.parts]
    if not whole:
        return None
    prices = whole_price(_arrays(view, plan, given, whole, open_units))
    dear = {
        item.order.index
        for item, price in zip(whole, prices.tolist(), strict=True)
        if price > given.part_s
    }
    return lambda order: order.index in dear


def _open_units(view: View, plan: Plan) -> NDArray[np.int64]:
    """Return open units of orders at stations and of planned ones, shape (S, K)."""
    open_units = view.need.astype(np.int64)
    for station, planned in enumerate(plan.items):
        for one in planned:
            for line in one.item.lines:
                open_units[station, line.sku] += line.units
    return open_units


def _arrays(
    view: View,
    plan: Plan,
    given: JointParameters,
    items: Sequence[Item],
    open_units: NDArray[np.int64],
) -> PileOn:
    """Build the input of the model; the slots limit how many orders may be planned ahead."""
    rows = [
        (number, line.sku, line.units)
        for number, item in enumerate(items)
        for line in sorted(item.lines, key=lambda line: line.sku)
    ]
    order, sku, units = np.array(rows, dtype=np.int64).reshape(-1, 3).T
    asked = np.zeros(open_units.shape[1], dtype=np.bool_)
    asked[sku] = True
    wanted = np.flatnonzero(asked | open_units.any(axis=0))
    pods = view.layout.pods
    inbound = np.full(pods, -1)
    for station in view.pick_stations:
        inbound[list(station.tasks)] = station.index
        inbound[list(plan.pods[station.index])] = station.index
    slots = [(s.slots - len(plan.items[s.index])) * s.active for s in view.pick_stations]
    waited = np.array([view.now_s - item.order.created_s for item in items])
    weight = np.array([item.order.weight for item in items])
    return PileOn(
        slots=np.maximum(slots, 0),
        line_order=order,
        line_sku=np.searchsorted(wanted, sku),
        line_units=units,
        stock=view.inventory.available[wanted].T.astype(np.int64),
        travel=_travel(view, given),
        available=view.storage.is_at_hand & (inbound < 0),
        inbound=inbound,
        open_units=open_units[:, wanted],
        worth=given.age_reward * np.maximum(waited, 0.0) * weight,
        variant=given.variant,
        weights=given.weights,
    )


def _travel(view: View, given: JointParameters) -> NDArray[np.float64]:
    """Return the time of a loaded robot from each pod to each pick station, shape (P, S), s.

    Includes the cost of stations with more work than others (`balance`).
    """
    at = view.storage.pod_waypoint
    times = [view.travel.to(s.waypoint, loaded=True)[at] for s in view.pick_stations]
    travel = np.minimum(np.stack(times, axis=1), UNREACHABLE_S)
    if given.balance:
        travel += given.balance * excess_s(view, view.pick_stations)
    return travel


def _fetch(view: View, robots: Sequence[Robot]) -> NDArray[np.float64]:
    """Return the estimated time of an empty robot to each pod's place, shape (R, P), s."""
    at = view.storage.pod_waypoint
    times = [view.travel.estimate_s(view.travel.robot_waypoint(r.index), at) for r in robots]
    found = np.array(times).reshape(len(robots), len(at))
    return np.minimum(np.where(np.isfinite(found), found, UNREACHABLE_S), UNREACHABLE_S)


def _needs_pod(view: View, plan: Plan, given: JointParameters, station: PickStation) -> bool:
    """Whether a station without called pods has less work than the horizon requires."""
    if not station.active:
        return False
    if not given.when_needed:
        return True
    if plan.pods[station.index]:
        return False
    bound = sum(len(task.picks) for task in station.tasks.values())
    planned = sum(line.units for one in plan.items[station.index] for line in one.item.lines)
    seconds = view.unit_s(station.index)
    return (bound + planned) * seconds < given.horizon_s


def _runs_short(view: View, plan: Plan, given: JointParameters, station: PickStation) -> bool:
    """Whether pods under way and called pods have less work than the horizon requires."""
    index, inventory = station.index, view.inventory
    units = sum(len(task.picks) for task in station.tasks.values())
    coming = inventory.inbound[index] + inventory.available[:, list(plan.pods[index])].sum(axis=1)
    units += int(np.minimum(view.need[index], coming).sum())
    seconds = view.unit_s(index)
    return station.active and units * seconds < given.horizon_s


def _coverable(data: PileOn) -> NDArray[np.int64]:
    """Return the number of orders each station can fill from pods under way alone, shape (S,)."""
    pairs = everything(data)
    partial = PartialAssignment(
        data, Candidates(np.zeros_like(pairs.calls), pairs.places, pairs.fetches)
    )
    for station in np.argsort(data.slots, kind="stable").tolist():
        partial.fill(station)
    placed = partial.order_station[partial.order_station >= 0]
    return np.bincount(placed, minlength=data.stations)
