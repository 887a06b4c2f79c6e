"""The possible answers to each kind of question, with the attributes that rules compare.

The kinds of question are defined in `rmfs.control.questions`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.control.answers import MEANINGS as MEANINGS
from rmfs.control.answers import Candidates as Candidates
from rmfs.control.ca.places import has_room
from rmfs.control.decisions import (
    AssignOrder,
    Charge,
    PromiseBundle,
    ReleasePod,
    SendBundle,
    SwitchStation,
    Unplug,
)
from rmfs.control.pps.candidates import pick_candidates, replenishment_candidates
from rmfs.control.problems import Problem
from rmfs.control.repositioning import Move
from rmfs.control.task_candidates import open_work, tasks
from rmfs.world.stations import ReplenishmentStation

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from rmfs.control.answers import Columns
    from rmfs.control.questions import Question
    from rmfs.control.view import View
    from rmfs.world.orders import Order
    from rmfs.world.robots import Robot
    from rmfs.world.stations import PickStation


def candidates_for(view: View, question: Question, refused: Sequence[Any] = ()) -> Candidates:
    """Return the possible answers to a question; there are none if MM is asked for a decision.

    Parameters
    ----------
    refused
        Decisions already made in this turn that could not be carried out. If TA is asked for a
        decision, they are not offered again; for other questions, this parameter is ignored.
    """
    if question.kind != "turn":
        return _OF_KIND[question.kind](view, view.robots[question.robot], question.stations)
    if question.problem is Problem.TA:
        return tasks(view, refused)
    return _OF_TURN[question.problem](view)


# --- turns --------------------------------------------------------------------------------------


def _orders(view: View) -> Candidates:
    """Pairs of an order in the backlog and a station that can take it."""
    orders: list[Order] = []
    stations: list[PickStation] = []
    taking = [s for s in view.pick_stations if s.active and s.free_slots > 0]
    for order in view.orders:
        for station in taking:
            if order.queued_at in (-1, station.index):
                orders.append(order)
                stations.append(station)
    rows = {order.index: row for row, order in enumerate(view.orders.at_row)}
    row = np.array([rows[order.index] for order in orders], np.intp)
    target = np.array([station.index for station in stations], np.intp)
    sku = view.orders.sku[row]
    units: NDArray[np.int32] = view.orders.units[row]
    wanted: NDArray[Any] = np.asarray(units.sum(axis=1))
    spare = view.inventory.inbound[target[:, None], sku] - view.need[target[:, None], sku]
    here: NDArray[Any] = np.clip(spare, 0, units).sum(axis=1)
    # unused columns have 0 units of SKU 0, of which the free stock may be negative
    served: NDArray[np.bool_] = (view.inventory.free_stock[sku] >= units) | (units == 0)
    columns: Columns = {
        "order": np.array([order.index for order in orders], np.int64),
        "station": target,
        "lines": np.array([len(order.lines) for order in orders], np.int64),
        "units": wanted,
        "inbound_units": here,
        "in_stock": np.asarray(served.all(axis=1), np.int64),
        "age_s": view.now_s - np.array([order.created_s for order in orders]),
        "due_in_s": np.array([order.due_s for order in orders]) - view.now_s,
        "free_slots": np.array([station.free_slots for station in stations], np.int64),
    }
    return Candidates(columns, lambda row: AssignOrder(orders[row], stations[row].index))


def _bundles_to_stations(view: View) -> Candidates:
    """Pairs of a bundle and a replenishment station with room for it."""
    pairs = [
        (bundle, station)
        for bundle in view.bundles.without_station.values()
        for station in view.replenishment_stations
        if station.active and bundle.space <= station.free_space
    ]
    columns: Columns = {
        "bundle": np.array([bundle.index for bundle, _ in pairs], np.int64),
        "station": np.array([station.index for _, station in pairs], np.int64),
        "space": np.array([bundle.space for bundle, _ in pairs], np.float64),
        "free_space": np.array([station.free_space for _, station in pairs], np.float64),
        "bundles": np.array([station.bundles for _, station in pairs], np.int64),
        "age_s": np.array([view.now_s - bundle.created_s for bundle, _ in pairs], np.float64),
    }
    return Candidates(columns, lambda row: SendBundle(pairs[row][0], pairs[row][1].index))


def _bundles_to_pods(view: View) -> Candidates:
    """Pairs of a bundle and a pod with room; then pods with promised bundles, as bundle -1."""
    free = view.inventory.capacity - view.inventory.load
    waiting = list(view.bundles.without_pod.values())
    fits = [np.flatnonzero(free >= bundle.space) for bundle in waiting]
    held = list(view.bundles.unreleased)
    counts = [len(pods) for pods in fits]
    which = np.repeat(np.arange(len(waiting)), counts)
    pods = np.concatenate([*fits, np.array(held, np.intp)]).astype(np.intp)
    index = np.array([bundle.index for bundle in waiting], np.int64)
    space = np.array([bundle.space for bundle in waiting], np.float64)
    columns: Columns = {
        "bundle": np.concatenate([index[which], np.full(len(held), -1)]),
        "pod": pods,
        "space": np.concatenate([space[which], np.zeros(len(held))]),
        "free_space": free[pods],
    }

    def answer(row: int) -> PromiseBundle | ReleasePod:
        if row < len(which):
            return PromiseBundle(waiting[which[row]], int(pods[row]))
        return ReleasePod(int(pods[row]))

    return Candidates(columns, answer)


def _stations_to_switch(view: View) -> Candidates:
    """All stations, each switched to its other state."""
    stations = view.stations
    columns: Columns = {
        "station": np.arange(len(stations)),
        "active": np.array([station.active for station in stations], np.int64),
        "robots": np.array([len(station.tasks) for station in stations], np.int64),
    }
    return Candidates(columns, lambda row: SwitchStation(row, not stations[row].active))


def _charges(view: View) -> Candidates:
    """Pairs of a robot without a pod and a station with room; then robots that could leave."""
    batteries = view.batteries
    shares = [] if batteries is None else batteries.shares().tolist()
    robots = [*view.asking.values(), *view.resting.values()]
    found: list[tuple[Charge | Unplug, int, float]] = []
    full = 1.0 if batteries is None else batteries.given.full_share
    enough = 1.0 if batteries is None else batteries.enough_share
    leaving = {station.robot for station in view.recovery_stations}
    for station in view.recovery_stations:
        if has_room(view, station):
            away = view.travel.to(station.waypoint, loaded=False)
            found += [
                (Charge(robot, station.index, full), station.index, float(away[at]))
                for robot in robots
                if robot.pod < 0 and robot.index not in leaving
                for at in (view.travel.robot_waypoint(robot.index),)
            ]
    for station in view.chargers:
        if station.robot in station.tasks and shares[station.robot] >= enough:
            found.append((Unplug(view.robots[station.robot]), -1, 0.0))
    numbers = [station for _, station, _ in found]
    columns: Columns = {
        "robot": np.array([decision.robot.index for decision, *_ in found], np.int64),
        "station": np.array(numbers, np.int64),
        "level_share": np.array([shares[decision.robot.index] for decision, *_ in found]),
        "away_s": np.array([away_s for *_, away_s in found], np.float64),
        "robots": np.array(
            [len(view.all_stations[number].tasks) if number >= 0 else 0 for number in numbers],
            np.int64,
        ),
    }
    return Candidates(columns, lambda row: found[row][0])


def _exchanges(view: View) -> Candidates:
    """No options: the controllers that could be installed are not known here."""
    return Candidates({"station": np.empty(0, np.int64)}, lambda row: row)


# --- what TA asks -------------------------------------------------------------------------------


def _pick_pods(view: View, robot: Robot, stations: tuple[int, ...]) -> Candidates:
    """Available pods with units that the station needs."""
    station = view.pick_stations[stations[0]]
    found = pick_candidates(view, robot, station, "assigned-and-completable")
    done = found.completed() if len(found) else None
    at = found.waypoints()
    columns: Columns = {
        "pod": found.pods,
        "units": found.servable_units() if len(found) else np.empty(0, np.int64),
        "orders": done.flags.sum(axis=0) if done is not None else np.empty(0, np.int64),
        "reach_s": view.travel.estimate_s(robot.waypoint, at),
        "bring_s": view.travel.to(station.waypoint, loaded=True)[at],
    }
    return Candidates(columns, lambda row: int(found.pods[row]))


def _replenishment_pods(view: View, robot: Robot, stations: tuple[int, ...]) -> Candidates:
    """Available pods for which bundles wait at the station."""
    station = view.stations[stations[0]]
    assert isinstance(station, ReplenishmentStation)
    found = replenishment_candidates(view, robot, station)
    at = found.waypoints()
    columns: Columns = {
        "pod": found.pods,
        "bundles": view.bundles_waiting[station.number][found.pods],
        "reach_s": view.travel.estimate_s(robot.waypoint, at),
        "bring_s": view.travel.to(station.waypoint, loaded=True)[at],
    }
    return Candidates(columns, lambda row: int(found.pods[row]))


def _next_stations(view: View, robot: Robot, stations: tuple[int, ...]) -> Candidates:
    """Stations that the carried pod can serve."""
    waypoints = np.array([view.stations[station].waypoint for station in stations])
    columns: Columns = {
        "station": np.array(stations, np.int64),
        "away_s": view.travel.away(robot.waypoint, loaded=True)[waypoints],
        "units": np.array([open_work(view, station) for station in stations], np.int64),
        "robots": np.array([len(view.stations[station].tasks) for station in stations]),
    }
    return Candidates(columns, lambda row: stations[row])


def _places(view: View, robot: Robot, stations: tuple[int, ...]) -> Candidates:
    """Empty storage locations."""
    places = view.storage.places[view.storage.is_empty]
    active = [station for station in view.pick_stations if station.active] or view.pick_stations
    back = np.min(
        [view.travel.to(station.waypoint, loaded=True)[places] for station in active], axis=0
    )
    columns: Columns = {
        "place": places,
        "away_s": view.travel.away(robot.waypoint, loaded=True)[places],
        "back_s": back,
    }
    return Candidates(columns, lambda row: int(places[row]))


def _moves(view: View, robot: Robot, stations: tuple[int, ...]) -> Candidates:
    """Available pods, each with the empty place nearest to it."""
    pods = np.flatnonzero(view.storage.is_at_hand)
    places = view.storage.places[view.storage.is_empty]
    if not len(places):
        pods = pods[:0]
    at = view.storage.pod_waypoint[pods]
    away = [view.travel.metres(int(waypoint), places) for waypoint in at.tolist()]
    nearest = np.array([int(places[metres.argmin()]) for metres in away], np.int64)
    columns: Columns = {
        "pod": pods,
        "place": nearest,
        "distance_m": np.array([float(metres.min()) for metres in away], np.float64),
        "reach_s": view.travel.estimate_s(robot.waypoint, at),
    }
    return Candidates(columns, lambda row: Move(int(pods[row]), int(nearest[row])))


_OF_TURN: dict[Problem, Callable[[View], Candidates]] = {
    Problem.POA: _orders,
    Problem.ROA: _bundles_to_stations,
    Problem.RPS: _bundles_to_pods,
    Problem.SA: _stations_to_switch,
    Problem.MM: _exchanges,
    Problem.CA: _charges,
}

_OF_KIND: dict[str, Callable[[View, Robot, tuple[int, ...]], Candidates]] = {
    "pick pod": _pick_pods,
    "replenishment pod": _replenishment_pods,
    "next station": _next_stations,
    "place": _places,
    "move": _moves,
}
