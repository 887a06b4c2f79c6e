"""The tasks that robots could do, as candidates for a decision of TA."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.control.answers import Candidates
from rmfs.control.decisions import MovePod, Rest, Store, WorkFor
from rmfs.world.stations import PickStation

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

    from rmfs.control.answers import Columns
    from rmfs.control.view import View
    from rmfs.world.robots import Robot

WORK, STORE, MOVE, REST = range(4)
"""Values of the column `kind` of `tasks`: the kinds of task."""

_KIND_OF: dict[type, int] = {WorkFor: WORK, Store: STORE, MovePod: MOVE, Rest: REST}


FEATURES = ("work", "pick", "store", "move", "rest", "away_s", "units", "robots")
"""Features by which a task is rated: its kind as four numbers, 1 or 0, and columns of `tasks`."""

_OF_OTHERS: dict[int, tuple[float, ...]] = {
    STORE: (0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    MOVE: (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0),
    REST: (0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0),
}
"""`FEATURES` of the tasks that are not work for a station, by kind."""


class TaskCandidates(Candidates):
    """The possible tasks of some robots.

    The columns are rarely needed, so they are created only when they are accessed.

    Parameters
    ----------
    robots
        The robots.
    rows
        For each task, the index of the robot in `robots`, the kind of task, and the station (-1 if
        the task is not work for a station).
    """

    def __init__(
        self, view: View, robots: Sequence[Robot], rows: Sequence[tuple[int, int, int]]
    ) -> None:
        super().__init__({}, lambda row: _decision(robots[rows[row][0]], *rows[row][1:]))
        self._view, self._robots, self._rows = view, robots, rows

    def __len__(self) -> int:
        return len(self._rows)

    @property
    def columns(self) -> Columns:
        """Arrays of shape (C,) by name; `rmfs.control.answers.MEANINGS` gives their meanings."""
        if not self._columns:
            self._columns = self._measured()
        return self._columns

    def _measured(self) -> Columns:
        view, robots, rows = self._view, self._robots, self._rows
        values = dict(zip(FEATURES, self.features(), strict=True))
        columns: Columns = {
            "robot": np.array([robots[at].index for at, _, _ in rows], np.int64),
            "kind": np.array([kind for _, kind, _ in rows], np.int64),
            "station": np.array([station for _, _, station in rows], np.int64),
            "pick": values["pick"] > 0,
            "away_s": values["away_s"],
            "units": values["units"].astype(np.int64),
            "robots": values["robots"].astype(np.int64),
        }
        if view.batteries is not None:
            columns["level_share"] = view.batteries.shares()[columns["robot"]]
        return columns

    def without_moves(self) -> list[int] | None:
        """Return the rows except those that move an idle pod; None if there are no such moves."""
        rows = [row for row, (_, kind, _) in enumerate(self._rows) if kind != MOVE]
        return rows if len(rows) < len(self._rows) else None

    def features(self, rows: Iterable[int] | None = None) -> NDArray[np.float64]:
        """Return the 8 `FEATURES` of C rows (default: all rows), shape (8, C)."""
        chosen = self._rows if rows is None else [self._rows[row] for row in rows]
        if not chosen:
            return np.empty((len(FEATURES), 0))
        robots = self._robots
        table = [
            _OF_OTHERS[kind] if kind != WORK else self._of_work(robots[at], station)
            for at, kind, station in chosen
        ]
        return np.array(table, np.float64).T

    def _of_work(self, robot: Robot, station: int) -> tuple[float, ...]:
        target = self._view.stations[station]
        is_pick = isinstance(target, PickStation)
        away_s = self._view.travel.one_estimate_s(robot.waypoint, target.waypoint)
        units = open_work(self._view, station)
        return 1.0, is_pick, 0.0, 0.0, 0.0, away_s, units, len(target.tasks)


def tasks(
    view: View, refused: Sequence[Any] = (), robots: Sequence[Robot] | None = None
) -> TaskCandidates:
    """List the possible tasks of robots that need a task or are at rest.

    Each row of the candidates is a task. The decision for it (for example, `WorkFor`) is created
    only when the row is accessed.

    Parameters
    ----------
    refused
        Earlier decisions that could not be carried out; their tasks are left out.
    robots
        The robots whose tasks are listed. Default: all that need a task or are at rest.
    """
    if robots is None:
        robots = [*view.asking.values(), *view.resting.values()]
    rows = _rows(view, robots)
    if refused:
        out = {_key(one) for one in refused}
        rows = [(at, kind, to) for at, kind, to in rows if (robots[at].index, kind, to) not in out]
    return TaskCandidates(view, robots, rows)


def lacks_tasks(view: View) -> bool:
    """Return whether TA has nothing to decide, except perhaps which idle pods to move.

    This is the case if no robot needs a task, and no robot at rest could work for a station or
    store its pod.
    """
    if view.asking:
        return False
    if any(station.has_open_work for station in view.stations):
        return not view.resting
    return all(robot.pod < 0 for robot in view.resting.values())


def open_work(view: View, station: int) -> int:
    """Return the amount of a station's open work, that is, work for which no pod is under way.

    For a pick station, this is the number of units that its open orders need and that are not yet
    bound to a pod. For a replenishment station, it is the number of pods for which bundles wait.
    """
    target = view.stations[station]
    return target.requests.units if isinstance(target, PickStation) else len(target.waiting)


def _rows(view: View, robots: Sequence[Robot]) -> list[tuple[int, int, int]]:
    """List rows: index of the robot, kind of task, station or -1."""
    rows: list[tuple[int, int, int]] = []
    busy: list[int] | None = None
    for at, robot in enumerate(robots):
        if robot.pod >= 0:
            rows += [(at, WORK, station) for station in _served(view, robot.pod)]
            rows.append((at, STORE, -1))
        else:
            if busy is None:
                busy = [station.index for station in view.stations if station.has_open_work]
            rows += [(at, WORK, station) for station in busy]
            rows.append((at, MOVE, -1))
            if robot.index in view.asking:
                rows.append((at, REST, -1))
    return rows


def _served(view: View, pod: int) -> list[int]:
    """Find the stations that need something from a pod."""
    inventory = view.inventory
    available = inventory.available.item
    skus = [sku for sku in inventory.skus_of(pod) if available(sku, pod) > 0]
    picks = [s.index for s in view.pick_stations if not s.requests.lines.keys().isdisjoint(skus)]
    bundles = [s.index for s in view.replenishment_stations if pod in s.waiting]
    return picks + bundles


def _key(refused: Any) -> tuple[int, int, int]:
    """Return the robot, kind and station of a decision."""
    return refused.robot.index, _KIND_OF[type(refused)], getattr(refused, "station", -1)


def _decision(robot: Robot, kind: int, station: int) -> Any:
    if kind == WORK:
        return WorkFor(robot, station)
    if kind == REST:
        return Rest(robot, robot.waypoint)
    return Store(robot) if kind == STORE else MovePod(robot)
