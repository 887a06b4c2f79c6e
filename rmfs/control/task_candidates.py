"""The tasks that robots could do, as candidates for a decision of TA."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.control.answers import Candidates
from rmfs.control.decisions import MovePod, Rest, Store, WorkFor
from rmfs.world.stations import PickStation

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.control.answers import Columns
    from rmfs.control.view import View
    from rmfs.world.robots import Robot

WORK, STORE, MOVE, REST = range(4)
"""Values of the column `kind` of `tasks`: the kinds of task."""

_KIND_OF: dict[type, int] = {WorkFor: WORK, Store: STORE, MovePod: MOVE, Rest: REST}


def tasks(
    view: View, refused: Sequence[Any] = (), robots: Sequence[Robot] | None = None
) -> Candidates:
    """List the possible tasks of robots that need a task or are at rest.

    Each row of the candidates is a task. The decision for it (for example, `WorkFor`) is created
    only when the row is accessed, since of most rows only the columns are needed.

    Parameters
    ----------
    refused
        Earlier decisions that could not be carried out; they are left out.
    robots
        The robots whose tasks are listed. Default: all that need a task or are at rest.
    """
    if robots is None:
        robots = [*view.asking.values(), *view.resting.values()]
    rows = _rows(view, robots)
    if refused:
        out = {_key(one) for one in refused}
        rows = [(at, kind, to) for at, kind, to in rows if (robots[at].index, kind, to) not in out]
    columns: Columns = {
        "robot": np.array([robots[at].index for at, _, _ in rows], np.int64),
        "kind": np.array([kind for _, kind, _ in rows], np.int64),
        "station": np.array([station for _, _, station in rows], np.int64),
        "pick": np.zeros(len(rows), np.bool_),
        "away_s": np.zeros(len(rows)),
        "units": np.zeros(len(rows), np.int64),
        "robots": np.zeros(len(rows), np.int64),
    }
    _measure(view, robots, columns, rows)

    if view.batteries is not None:
        columns["level_share"] = view.batteries.shares()[columns["robot"]]

    def answer(row: int) -> Any:
        place, kind, station = rows[row]
        return _decision(robots[place], kind, station)

    return Candidates(columns, answer)


def has_tasks(view: View) -> bool:
    """Return whether there is more for TA to decide than which idle pods to move.

    This is so if a robot needs a task, or if one at rest could work for a station or store its pod.
    """
    if view.asking:
        return True
    busy = any(station.has_open_work for station in view.stations)
    return any(busy or robot.pod >= 0 for robot in view.resting.values())


def open_work(view: View, station: int) -> int:
    """Return the amount of a station's open work, that is, work for which no pod is under way.

    For a pick station, it is the number of units that its open orders need and that are not bound
    to a pod; for a replenishment station, the number of pods for which bundles wait.
    """
    target = view.stations[station]
    return target.requests.units if isinstance(target, PickStation) else len(target.waiting)


def _rows(view: View, robots: Sequence[Robot]) -> list[tuple[int, int, int]]:
    """List rows: index of the robot, kind of task, station or -1."""
    rows: list[tuple[int, int, int]] = []
    busy = [station.index for station in view.stations if station.has_open_work]
    for at, robot in enumerate(robots):
        if robot.pod >= 0:
            rows += [(at, WORK, station) for station in _served(view, robot.pod)]
            rows.append((at, STORE, -1))
        else:
            rows += [(at, WORK, station) for station in busy]
            rows.append((at, MOVE, -1))
            if robot.index in view.asking:
                rows.append((at, REST, -1))
    return rows


def _measure(
    view: View, robots: Sequence[Robot], columns: Columns, rows: Sequence[tuple[int, int, int]]
) -> None:
    """Fill in the attributes of work for stations."""
    works = [row for row, (_, kind, _) in enumerate(rows) if kind == WORK]
    if not works:
        return
    stations = [view.stations[rows[row][2]] for row in works]
    here = np.array([robots[rows[row][0]].waypoint for row in works])
    there = np.array([station.waypoint for station in stations])
    columns["pick"][works] = [isinstance(station, PickStation) for station in stations]
    columns["away_s"][works] = view.travel.estimate_s(here, there)
    columns["units"][works] = [open_work(view, station.index) for station in stations]
    columns["robots"][works] = [len(station.tasks) for station in stations]


def _served(view: View, pod: int) -> list[int]:
    """Find the stations that need something from a pod."""
    inventory = view.inventory
    skus = [sku for sku in inventory.skus_of(pod) if inventory.available[sku, pod] > 0]
    picks = np.flatnonzero(view.need[:, skus].any(axis=1)).tolist() if skus else []
    bundles = np.flatnonzero(view.bundles_waiting[:, pod])
    first = len(view.pick_stations)
    return [*picks, *(bundles + first).tolist()]


def _key(refused: Any) -> tuple[int, int, int]:
    """Return the robot, kind and station of a decision."""
    return refused.robot.index, _KIND_OF[type(refused)], getattr(refused, "station", -1)


def _decision(robot: Robot, kind: int, station: int) -> Any:
    if kind == WORK:
        return WorkFor(robot, station)
    if kind == REST:
        return Rest(robot, robot.waypoint)
    return Store(robot) if kind == STORE else MovePod(robot)
