"""What a decision chooses among, with the numbers that rules look at."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rmfs.control.ca.places import has_room
from rmfs.control.decisions import (
    AssignOrder,
    Charge,
    MovePod,
    PromiseBundle,
    ReleasePod,
    Rest,
    SendBundle,
    Store,
    SwitchStation,
    Unplug,
    WorkFor,
)
from rmfs.control.pps.candidates import pick_candidates, replenishment_candidates
from rmfs.control.problems import Problem
from rmfs.control.repositioning import Move
from rmfs.world.stations import PickStation, ReplenishmentStation

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    import pandas as pd
    from numpy.typing import NDArray

    from rmfs.control.questions import Question
    from rmfs.control.view import View
    from rmfs.world.orders import Order
    from rmfs.world.robots import Robot

    Columns = dict[str, NDArray[Any]]


class Candidates:
    """C possible answers, as a table: a row per answer, a column per number.

    `candidates[row]` is the answer itself, to be handed to `Decision.answer`.

    Attributes
    ----------
    columns
        Arrays of shape (C,) by name; `MEANINGS` says what each is.
    """

    def __init__(self, columns: Columns, answer: Callable[[int], Any]) -> None:
        self.columns = columns
        self._answer = answer

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    def __getitem__(self, row: int) -> Any:
        count = len(self)
        if not -count <= row < count:
            raise IndexError(f"there are {count} candidates, no row {row}")
        return self._answer(row % count)

    def __iter__(self) -> Iterator[Any]:
        return (self._answer(row) for row in range(len(self)))

    def frame(self) -> pd.DataFrame:
        """Return the columns as a data frame."""
        import pandas as pd

        return pd.DataFrame(self.columns)


class Meaning(NamedTuple):
    """Unit and meaning of a column."""

    unit: str
    text: str


MEANINGS = {
    "order": Meaning("", "ordinal of arrival of a pick order"),
    "bundle": Meaning("", "ordinal of arrival of a bundle"),
    "station": Meaning("", "number of a station, pick stations first"),
    "robot": Meaning("", "number of a robot"),
    "pod": Meaning("", "number of a pod"),
    "place": Meaning("", "waypoint of a storage place"),
    "lines": Meaning("lines", "lines of the order"),
    "units": Meaning("units", "units still wanted, or what the pod can serve of them"),
    "inbound_units": Meaning("units", "of these, on pods at the station or on their way there"),
    "in_stock": Meaning("", "1 if stock can serve the whole order, 0 if not"),
    "age_s": Meaning("s", "time since it arrived"),
    "due_in_s": Meaning("s", "time until it is due, negative if it is late"),
    "free_slots": Meaning("orders", "slots of the station without an order"),
    "orders": Meaning("orders", "orders the pod completes"),
    "bundles": Meaning("bundles", "bundles for the pod, or the station"),
    "space": Meaning("space units", "space the bundle takes"),
    "free_space": Meaning("space units", "room left on the pod, or at the station"),
    "reach_s": Meaning("s", "estimated time of the robot to the pod"),
    "bring_s": Meaning("s", "unhindered time from the pod to the station"),
    "away_s": Meaning("s", "unhindered time of the robot to the place or the station"),
    "back_s": Meaning("s", "unhindered time from the place to the nearest active pick station"),
    "distance_m": Meaning("m", "straight distance"),
    "robots": Meaning("robots", "robots at work for the station, or bound for it"),
    "level_share": Meaning("share", "what is in the robot's battery, of its capacity"),
    "active": Meaning("", "1 if the station takes new work, 0 if not"),
    "kind": Meaning("", "0 work for the station, 1 store the pod, 2 move a pod, 3 rest"),
}
"""What the columns of candidates are."""


def candidates_for(view: View, question: Question, refused: Sequence[Any] = ()) -> Candidates:
    """List the possible answers to a question.

    Parameters
    ----------
    refused
        Answers of the same turn that came to nothing.
    """
    if question.kind != "turn":
        return _OF_KIND[question.kind](view, view.robots[question.robot], question.stations)
    if question.problem is Problem.TA:
        return _tasks(view, refused)
    return _OF_TURN[question.problem](view)


# --- turns --------------------------------------------------------------------------------------


def _orders(view: View) -> Candidates:
    """Pairs of an order of the backlog and a station that can take it."""
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
    inbound = view.inventory.inbound[target[:, None], sku]
    here: NDArray[Any] = np.minimum(inbound, units).sum(axis=1)
    served: NDArray[np.bool_] = view.inventory.free_stock[sku] >= units
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
    """Pairs of a bundle and a pod with room; then, with bundle -1, pods whose bundles are held."""
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
    """Every station: switched to the other state."""
    stations = view.stations
    columns: Columns = {
        "station": np.arange(len(stations)),
        "active": np.array([station.active for station in stations], np.int64),
        "robots": np.array([len(station.tasks) for station in stations], np.int64),
    }
    return Candidates(columns, lambda row: SwitchStation(row, not stations[row].active))


def _charges(view: View) -> Candidates:
    """Pairs of a robot without pod and a station with room; then robots that could leave."""
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
    """None: which controllers could be installed is not known here."""
    return Candidates({"station": np.empty(0, np.int64)}, lambda row: row)


def _tasks(view: View, refused: Sequence[Any]) -> Candidates:
    """What each robot that needs a task, or is at rest, could do."""
    found: list[tuple[Any, int, int, float]] = []
    waypoints = np.array([station.waypoint for station in view.stations])
    open_work = [station.index for station in view.stations if view.has_open_work(station.index)]
    for robot in [*view.asking.values(), *view.resting.values()]:
        away = view.travel.estimate_s(robot.waypoint, waypoints)
        if robot.pod >= 0:
            useful = [s.index for s in view.stations if _can_serve(view, robot.pod, s.index)]
        else:
            useful = open_work
        found += [(WorkFor(robot, s), 0, s, float(away[s])) for s in useful]
        if robot.pod >= 0:
            found.append((Store(robot), 1, -1, 0.0))
        else:
            found.append((MovePod(robot), 2, -1, 0.0))
            if robot.index in view.asking:
                found.append((Rest(robot, robot.waypoint), 3, -1, 0.0))
    kept = [one for one in found if one[0] not in refused]
    numbers = [station for _, _, station, _ in kept]
    columns: Columns = {
        "robot": np.array([task[0].index for task, *_ in kept], np.int64),
        "kind": np.array([kind for _, kind, _, _ in kept], np.int64),
        "station": np.array(numbers, np.int64),
        "away_s": np.array([away_s for *_, away_s in kept], np.float64),
        "units": np.array([_open_work(view, s) if s >= 0 else 0 for s in numbers], np.int64),
        "robots": np.array([len(view.stations[s].tasks) if s >= 0 else 0 for s in numbers]),
    }
    return Candidates(columns, lambda row: kept[row][0])


def _can_serve(view: View, pod: int, station: int) -> bool:
    target = view.stations[station]
    if isinstance(target, PickStation):
        return view.inventory.serves(pod, list(target.requests.lines))
    return bool(view.bundles_waiting[target.number, pod])


def _open_work(view: View, station: int) -> int:
    """Units, or pods with bundles, for which nothing is under way yet."""
    target = view.stations[station]
    return target.requests.units if isinstance(target, PickStation) else len(target.waiting)


# --- what TA asks -------------------------------------------------------------------------------


def _pick_pods(view: View, robot: Robot, stations: tuple[int, ...]) -> Candidates:
    """Pods at hand with units that the station wants."""
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
    """Pods at hand for which bundles wait at the station."""
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
        "units": np.array([_open_work(view, station) for station in stations], np.int64),
        "robots": np.array([len(view.stations[station].tasks) for station in stations]),
    }
    return Candidates(columns, lambda row: stations[row])


def _places(view: View, robot: Robot, stations: tuple[int, ...]) -> Candidates:
    """Empty storage places."""
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
    """Pods at hand, each to the empty place nearest to it."""
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
