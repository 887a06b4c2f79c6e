"""Cheapest insertion: each task, in order of urgency, is inserted where it adds the least cost.

When a task is inserted, a place is chosen for its pod, and a new place may be chosen for the pod
that the robot stores just before the task. Both choices take account of the robot's drive from the
place to the next pod.
"""

from __future__ import annotations

import math
from time import perf_counter
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.checks import require
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, solution_of_rule
from rmfs.solvers.models.tasks.sequence.bound import relaxed_bound
from rmfs.solvers.models.tasks.sequence.data import NONE, Routes, TaskSequence
from rmfs.solvers.models.tasks.sequence.schedule import (
    approach_s,
    follow,
    lateness_s,
    objective,
    violations,
)
from rmfs.solvers.models.tasks.sequence.starts import without_tasks


def solve(
    data: TaskSequence,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Routes | None = None,
) -> Solution[Routes]:
    """Insert tasks one by one: mandatory tasks before optional ones, in each group by urgency.

    The urgency is given by the due time or the end of the time window, whichever is earlier. An
    optional task is inserted only if this costs less than postponing it.

    Parameters
    ----------
    data
        The problem.
    limits, seed
        Not used.
    start
        Feasible routes into which the remaining tasks are inserted. Default: robots only store the
        pods that they carry.

    Returns
    -------
    The routes; ties are broken by the indices of robots and places. If a task that must be done
    cannot be inserted, there are no routes; the status is then INFEASIBLE if the bound is infinite,
    otherwise LIMIT. The bound is that of `relaxed_bound`.

    Raises
    ------
    ModelError
        If the start is not feasible.
    """
    begin = perf_counter()
    if start is not None:
        broken = violations(data, start)
        require(not broken, "start", "; ".join(broken))
    bound = relaxed_bound(data)
    plan = _Plan.of(data, start)
    if plan is not None:
        pressing = np.minimum(data.due_s, data.latest_s)
        for task in np.lexsort((pressing, np.isfinite(data.skip_s))).tolist():
            if plan.place[task] == NONE:
                plan.insert(task)
    routes = None if plan is None else plan.routes()
    work = 0.0 if plan is None else float(plan.scored)
    return solution_of_rule(
        None if routes is None or violations(data, routes) else routes,
        lambda values: objective(data, values),
        bound=bound,
        work=work,
        began=begin,
    )


class _Gap(NamedTuple):
    """A position in a route: after `before` (`NONE`: the robot itself), ahead of `after`."""

    robot: int
    position: int
    before: int
    after: int


class _Change(NamedTuple):
    """An insertion: where the pod before and the pod of the task are stored."""

    gap: _Gap
    before_place: int
    place: int


class _Plan:
    """Routes under construction."""

    def __init__(self, data: TaskSequence, routes: Routes) -> None:
        self._data = data
        self._tasks = [list(tasks) for tasks in routes.tasks]
        self.place = routes.place.copy()
        self._robot_place = routes.robot_place.copy()
        self._free = np.ones(data.places, bool)
        for used in (self.place, self._robot_place):
            self._free[used[used != NONE]] = False
        self.scored = 0

    @classmethod
    def of(cls, data: TaskSequence, start: Routes | None) -> _Plan | None:
        """Begin with given routes, or with the cheapest places for what robots carry."""
        if start is not None:
            return cls(data, start)
        empty = without_tasks(data)
        return None if empty is None else cls(data, empty)

    def routes(self) -> Routes:
        """Return what has been built."""
        return Routes(tuple(tuple(tasks) for tasks in self._tasks), self.place, self._robot_place)

    def insert(self, task: int) -> None:
        """Insert a task where it adds least, unless leaving it costs less."""
        best, best_cost = None, float(self._data.skip_s[task])
        gaps = self._gaps()
        driving_s, before_place, place = self._score(task, gaps)
        for which in np.argsort(driving_s, kind="stable").tolist():
            # lateness only adds to driving
            if math.isinf(driving_s[which]) or driving_s[which] >= best_cost:
                break
            change = _Change(gaps[which], int(before_place[which]), int(place[which]))
            cost = self._added(task, change)
            if cost < best_cost:
                best, best_cost = change, cost
        if best is not None:
            self._apply(task, best)

    def _gaps(self) -> list[_Gap]:
        return [
            _Gap(robot, position, before, after)
            for robot, tasks in enumerate(self._tasks)
            for position, (before, after) in enumerate(
                zip([NONE, *tasks], [*tasks, NONE], strict=True)
            )
        ]

    def _score(
        self, task: int, gaps: list[_Gap]
    ) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]:
        """Return the least driving that each insertion adds, and the two places that it uses."""
        data = self._data
        free = np.flatnonzero(self._free)
        self.scored += len(gaps) * len(free)
        driving_s = np.full(len(gaps), math.inf)
        moved, place = np.full(len(gaps), NONE, np.int64), np.full(len(gaps), NONE, np.int64)
        fetch_s = data.fetch_s[free, task]
        for which, gap in enumerate(gaps):
            inward_s, taken, now = self._approach(task, gap, free, fetch_s)
            # the place that the pod before gives up, if it does
            places = free if taken == now else np.append(free[free != taken], now)
            outward_s = data.store_s[task, places]
            saved_s = 0.0
            if gap.after != NONE:
                outward_s = outward_s + data.fetch_s[places, gap.after]
                saved_s = approach_s(data, gap.robot, now, gap.after)
            if not len(places):
                continue
            best = int(outward_s.argmin())
            driving_s[which] = inward_s + data.bring_s[task] + outward_s[best] - saved_s
            moved[which], place[which] = taken, places[best]
        return driving_s, moved, place

    def _approach(
        self, task: int, gap: _Gap, free: NDArray[np.int64], fetch_s: NDArray[np.float64]
    ) -> tuple[float, int, int]:
        """Return the time that the drive to the task adds, and places of the pod stored before it.

        The first place is the one chosen now, the second the one chosen so far.
        """
        data = self._data
        if gap.before != NONE:
            now, store_s = int(self.place[gap.before]), data.store_s[gap.before]
        elif data.carrying[gap.robot]:
            now, store_s = int(self._robot_place[gap.robot]), data.stow_s[gap.robot]
        else:
            return float(data.reach_s[gap.robot, task]), NONE, NONE
        added_s, taken = float(data.fetch_s[now, task]), now
        if len(free):
            other_s = store_s[free] - store_s[now] + fetch_s
            best = int(other_s.argmin())
            if other_s[best] < added_s:
                added_s, taken = float(other_s[best]), int(free[best])
        return added_s, taken, now

    def _added(self, task: int, change: _Change) -> float:
        """Return the cost that an insertion adds."""
        gap = change.gap
        before = self._cost(gap.robot, self._tasks[gap.robot])
        kept = self.place.copy(), self._robot_place.copy()
        self._set_places(task, change)
        tasks = self._tasks[gap.robot]
        after = self._cost(gap.robot, [*tasks[: gap.position], task, *tasks[gap.position :]])
        self.place, self._robot_place = kept
        return after - before

    def _cost(self, robot: int, tasks: list[int]) -> float:
        stowed = int(self._robot_place[robot])
        driving_s, arrivals = follow(self._data, robot, tuple(tasks), self.place, stowed)
        late = (lateness_s(self._data, one, at) for one, at in zip(tasks, arrivals, strict=True))
        return driving_s + sum(late)

    def _set_places(self, task: int, change: _Change) -> None:
        self.place[task] = change.place
        if change.gap.before != NONE:
            self.place[change.gap.before] = change.before_place
        else:
            self._robot_place[change.gap.robot] = change.before_place

    def _apply(self, task: int, change: _Change) -> None:
        self._set_places(task, change)
        self._tasks[change.gap.robot].insert(change.gap.position, task)
        self._free[:] = True
        for used in (self.place, self._robot_place):
            self._free[used[used != NONE]] = False
