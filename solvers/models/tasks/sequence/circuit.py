r"""The CP-SAT model of routes: circuits through robots, tasks and places.

The nodes are a depot, the robots, the tasks, and the pairs of a pod to be stored (the pod of a
task, or a pod that a robot carries) and a place where it may be stored. A route goes from the depot
to its robot, then alternately to tasks and places (a place comes first if the robot carries a pod),
and back to the depot. A node that is not used has an arc to itself. Every place is used at most
once. An arc to task t from the node at which the pod of task o is stored at place l imposes

.. math:: arrive_t \ge arrive_o + service_o + store_{ol} + fetch_{lt} + bring_t

so places need no time variables. Times are whole milliseconds, so the solver's integers are exact.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from ortools.sat.python import cp_model

from rmfs.solvers.models.tasks.sequence.candidates import Ways
from rmfs.solvers.models.tasks.sequence.data import NONE, TICKS_PER_S, Routes, TaskSequence
from rmfs.solvers.models.tasks.sequence.schedule import arrivals_s

_DEPOT = 0


class Circuit:
    """The CP-SAT model of one problem.

    Nodes are numbered in this order: the depot (0), the robots, the tasks, then the pairs of owner
    and place. So the robot or task with owner number n (see `Ways`) is node 1 + n.

    Parameters
    ----------
    data
        The problem.
    ways
        The arcs that routes may use.

    Attributes
    ----------
    model
        The model to be solved.
    """

    def __init__(self, data: TaskSequence, ways: Ways) -> None:
        self.model = cp_model.CpModel()
        self._data = data
        self._arcs: dict[tuple[int, int], cp_model.IntVar] = {}
        self._late: dict[int, cp_model.IntVar] = {}
        self._cost: list[tuple[cp_model.IntVar, int]] = []
        stored = np.unique(np.vstack([ways.onward[:, :2], ways.last]), axis=0)
        self._stored = [(owner, place) for owner, place in stored.tolist()]
        begin = 1 + data.robots + data.tasks
        self._node_of = {pair: begin + which for which, pair in enumerate(self._stored)}
        self._in_time = data.earliest_s <= data.latest_s
        self._arrive = self._make_arrivals()
        self._add_robots(ways.first)
        self._add_skips()
        self._add_places(ways.last)
        self._add_onward(ways.onward)
        self._reach_every_node()
        self.model.add_multiple_circuit([(*ends, arc) for ends, arc in self._arcs.items()])
        self._use_places_once()
        self._add_lateness()
        self.model.minimize(sum(weight * variable for variable, weight in self._cost))

    @property
    def arcs(self) -> int:
        """Number of arcs."""
        return len(self._arcs)

    # --- variables and constraints --------------------------------------------------------------

    def _make_arrivals(self) -> list[cp_model.IntVar]:
        data = self._data
        horizon = _horizon(data)
        latest = np.where(np.isinf(data.latest_s), horizon, _ticks(data.latest_s))
        # a task whose window is empty can only be left; its time means nothing then
        latest = np.maximum(latest, _ticks(data.earliest_s))
        windows = zip(_ticks(data.earliest_s).tolist(), latest.tolist(), strict=True)
        return [self.model.new_int_var(early, late, "") for early, late in windows]

    def _arc(self, tail: int, head: int, cost: int) -> cp_model.IntVar:
        literal = self.model.new_bool_var("")
        self._arcs[tail, head] = literal
        if cost:
            self._cost.append((literal, cost))
        return literal

    def _add_robots(self, first: NDArray[np.int64]) -> None:
        data = self._data
        for robot in range(data.robots):
            self.model.add(self._arc(_DEPOT, 1 + robot, 0) == 1)
            if not data.carrying[robot]:
                self._arc(1 + robot, _DEPOT, 0)
        way_s = data.reach_s[first[:, 0], first[:, 1]] + data.bring_s[first[:, 1]]
        ready = _ticks(data.ready_s)
        for (robot, task), way in zip(first.tolist(), _ticks(way_s).tolist(), strict=True):
            if self._in_time[task]:
                arc = self._arc(1 + robot, 1 + data.robots + task, way)
                arrival = int(ready[robot]) + way
                self.model.add(self._arrive[task] >= arrival).only_enforce_if(arc)

    def _add_skips(self) -> None:
        data = self._data
        for task in np.flatnonzero(np.isfinite(data.skip_s)).tolist():
            node = 1 + data.robots + task
            self._arc(node, node, int(_ticks(data.skip_s[task])))

    def _add_places(self, last: NDArray[np.int64]) -> None:
        for (owner, place), node in self._node_of.items():
            self._arc(1 + owner, node, int(_ticks(self._store_s(owner, place))))
            self._arc(node, node, 0)
        for owner, place in last.tolist():
            self._arc(self._node_of[owner, place], _DEPOT, 0)

    def _add_onward(self, onward: NDArray[np.int64]) -> None:
        data = self._data
        way_s = data.fetch_s[onward[:, 1], onward[:, 2]] + data.bring_s[onward[:, 2]]
        for (owner, place, task), way in zip(onward.tolist(), _ticks(way_s).tolist(), strict=True):
            if not self._in_time[task]:
                continue
            arc = self._arc(self._node_of[owner, place], 1 + data.robots + task, way)
            takes = int(_ticks(self._store_s(owner, place))) + way
            before = owner - data.robots
            if before < 0:
                leaves: cp_model.LinearExpr | int = int(_ticks(data.ready_s[owner]))
            else:
                leaves = self._arrive[before] + int(_ticks(data.service_s[before]))
            self.model.add(self._arrive[task] >= leaves + takes).only_enforce_if(arc)

    def _reach_every_node(self) -> None:
        """Give nodes without arcs an arc that may not be used: the solver requires arcs."""
        touched = {node for arc in self._arcs for node in arc}
        for node in range(1, 1 + self._data.robots + self._data.tasks):
            if node not in touched:
                self.model.add(self._arc(node, node, 0) == 0)

    def _store_s(self, owner: int, place: int) -> float:
        data = self._data
        if owner < data.robots:
            return float(data.stow_s[owner, place])
        return float(data.store_s[owner - data.robots, place])

    def _use_places_once(self) -> None:
        users: dict[int, list[cp_model.LiteralT]] = {}
        for (_, place), node in self._node_of.items():
            users.setdefault(place, []).append(~self._arcs[node, node])
        for literals in users.values():
            self.model.add_at_most_one(literals)

    def _add_lateness(self) -> None:
        data = self._data
        if not data.late_weight:
            return
        horizon = _horizon(data)
        for task in np.flatnonzero(np.isfinite(data.due_s)).tolist():
            due = int(_ticks(data.due_s[task]))
            late = self.model.new_int_var(0, max(0, horizon - due), "")
            later = self.model.add(late >= self._arrive[task] - due)
            node = 1 + data.robots + task
            if math.isfinite(data.skip_s[task]):
                later.only_enforce_if(~self._arcs[node, node])
            self._cost.append((late, data.late_weight))
            self._late[task] = late

    # --- in and out -----------------------------------------------------------------------------

    def hint(self, routes: Routes) -> None:
        """Give the solver routes to start from.

        Parameters
        ----------
        routes
            Feasible routes; arcs that the model lacks are left out of the hint.
        """
        used = self._arcs_of(routes)
        touched = {node for arc in used for node in arc}
        for ends, literal in self._arcs.items():
            alone = ends[0] == ends[1] and ends[0] not in touched
            self.model.add_hint(literal, ends in used or alone)
        for task, time_s in enumerate(arrivals_s(self._data, routes).tolist()):
            done = not math.isnan(time_s)
            time = round((time_s if done else self._data.earliest_s[task]) * TICKS_PER_S)
            self.model.add_hint(self._arrive[task], time)
            if task in self._late:
                late = time - int(_ticks(self._data.due_s[task]))
                self.model.add_hint(self._late[task], max(0, late) if done else 0)

    def _arcs_of(self, routes: Routes) -> set[tuple[int, int]]:
        used = set()
        for robot, tasks in enumerate(routes.tasks):
            path = [_DEPOT, 1 + robot]
            if self._data.carrying[robot]:
                path.append(self._node_of.get((robot, int(routes.robot_place[robot])), NONE))
            for task in tasks:
                owner = self._data.robots + task
                path.append(1 + owner)
                path.append(self._node_of.get((owner, int(routes.place[task])), NONE))
            used |= set(zip(path, [*path[1:], _DEPOT], strict=True))
        return used

    def read(self, solver: cp_model.CpSolver) -> Routes:
        """Return the routes along the arcs that the solver chose.

        Parameters
        ----------
        solver
            The solver after it found a solution.
        """
        data = self._data
        after = {
            tail: head
            for (tail, head), literal in self._arcs.items()
            if tail != _DEPOT and tail != head and solver.boolean_value(literal)
        }
        place, robot_place = np.full(data.tasks, NONE), np.full(data.robots, NONE)
        first_place = 1 + data.robots + data.tasks
        routes = []
        for robot in range(data.robots):
            tasks = []
            node = after[1 + robot]
            while node != _DEPOT:
                if node < first_place:
                    tasks.append(node - 1 - data.robots)
                else:
                    owner, where = self._stored[node - first_place]
                    if owner < data.robots:
                        robot_place[owner] = where
                    else:
                        place[owner - data.robots] = where
                node = after[node]
            routes.append(tuple(tasks))
        return Routes(tuple(routes), place, robot_place)


def _ticks(time_s: NDArray[np.float64] | float) -> NDArray[np.int64]:
    """Return times, which are whole milliseconds, as whole numbers; infinite ones as 0."""
    finite = np.where(np.isfinite(time_s), time_s, 0.0)
    ticks: NDArray[np.int64] = np.rint(finite * TICKS_PER_S).astype(np.int64)
    return ticks


def _horizon(data: TaskSequence) -> int:
    """Return a time by which all tasks can be done, one after another, in ticks."""
    ways = (data.reach_s, data.fetch_s, data.stow_s, data.store_s)
    longest = [int(_ticks(way_s).max(initial=0)) for way_s in ways]
    begin = int(_ticks(data.ready_s).max(initial=0)) + int(_ticks(data.earliest_s).max(initial=0))
    each = int(_ticks(data.bring_s).sum() + _ticks(data.service_s).sum())
    return begin + each + (data.tasks + 1) * sum(longest)
