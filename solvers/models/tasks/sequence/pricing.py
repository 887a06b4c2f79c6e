r"""Cheapest routes of each robot, given prices of tasks and places, in exact integers.

If doing task t earns the price :math:`v_t`, and using place l costs the price :math:`w_l \ge 0`, a
route costs

.. math:: driving + lateness - \sum_{t \in route} v_t + \sum_{l \in route} w_l

Places may repeat within a route unless they are *remembered*. This is a relaxation: the cheapest
route found never costs more than the cheapest feasible one.

The search extends partial routes task by task, the most promising first (A*). The estimate of the
remaining cost allows tasks to be repeated and rounds times down to steps, so it is never too high.
A partial route is dropped if another partial route to the same task arrives no later, costs no
more, and has used only tasks and remembered places that the dropped route has used, too. Then every
completion of the dropped route also completes the other, at no higher cost. Between two tasks, a
place is ignored if there is another place, not remembered, via which the drive takes no longer and
costs no more.

All prices and costs are integers, in parts of a tick (1 tick = 1 ms = 1024 parts), so their sums
are exact.
"""

from __future__ import annotations

import heapq
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.tasks.sequence.data import NONE, TICKS_PER_S
from rmfs.solvers.models.tasks.sequence.ticks import NEVER, Route, Ticks

PARTS = 1024
"""Number of parts per tick, the unit of prices and costs."""

LABEL_ENTRIES = 2000
"""Table entries counted as work per partial route, in addition to one per way to continue it."""

_NEVER = NEVER * PARTS
_STEPS = 100
"""Number of time steps of the estimates."""

_LONGEST_S = 3600.0
"""Latest time that the estimates cover if no time window or due time limits it, in s."""


class Prices(NamedTuple):
    """Prices of tasks and places, in parts of a tick.

    Attributes
    ----------
    task
        Reward for doing each task, shape (T,).
    place
        Price of using each place, shape (L,), not negative.
    """

    task: NDArray[np.int64]
    place: NDArray[np.int64]


class Found(NamedTuple):
    """Result of a search.

    Attributes
    ----------
    bound
        Lower bound on the cost of every route of the robot, in parts of a tick.
    routes
        Routes that cost less than the limit `below` of the search, the cheapest first.
    complete
        Whether the search considered all routes; False if a limit ended it.
    """

    bound: int
    routes: list[Route]
    complete: bool


class _Onward(NamedTuple):
    """Arcs from an owner to next tasks: one entry per task and place worth considering.

    `uses` has the bit of the task and that of the place.
    """

    task: NDArray[np.int64]
    place: NDArray[np.int64]
    takes: NDArray[np.int64]
    cost: NDArray[np.int64]
    uses: list[int]


class _Label(NamedTuple):
    """A partial route, up to the arrival at its last task."""

    cost: int
    time: int
    last: int
    used: int
    tasks: tuple[int, ...]
    places: tuple[int, ...]


class _Next(NamedTuple):
    """A continuation of a partial route: to a next task or, if `way` is `NONE`, to its end.

    Ordered by estimate, then by age.
    """

    estimate: int
    number: int
    label: _Label
    way: int
    place: int
    cost: int
    time: int


class Pricing:
    """Search for the cheapest routes at given prices.

    Parameters
    ----------
    ticks
        The problem, with times in ticks.
    prices
        Prices of tasks and places.
    remembered
        Whether each place is remembered, that is, may be used only once by a route, shape (L,).
    every
        Whether to find all routes below a cost. All places are then remembered, and a partial route
        is dropped only in favour of another with the same tasks and the same places. Default: no.

    Attributes
    ----------
    entries
        Number of table entries examined so far, a deterministic measure of work.
    """

    def __init__(
        self,
        ticks: Ticks,
        prices: Prices,
        remembered: NDArray[np.bool_],
        *,
        every: bool = False,
    ) -> None:
        self._ticks, self._prices, self._every = ticks, prices, every
        self._remembered = np.ones(ticks.places, bool) if every else remembered
        # the last entry, at `NONE`, is that of no place
        self._bit = [0] * (ticks.places + 1)
        for number, place in enumerate(np.flatnonzero(self._remembered).tolist()):
            self._bit[place] = 1 << (ticks.tasks + number)
        owners = range(ticks.robots + ticks.tasks)
        self._onward = [self._ways(owner) for owner in owners]
        self._ends = [self._last(owner) for owner in owners]
        self.entries = 0
        self._step, self._rest = self._estimates()

    # --- ways -----------------------------------------------------------------------------------

    def _ways(self, owner: int) -> _Onward:
        ticks, prices = self._ticks, self._prices
        own = owner - ticks.robots
        if own < 0 and not ticks.carrying[owner]:
            task = np.flatnonzero(ticks.reach[owner] < NEVER)
            takes = ticks.reach[owner, task] + ticks.bring[task]
            cost = takes * PARTS - prices.task[task]
            return self._onward_by(task, np.full(len(task), NONE), takes, cost)
        store = ticks.store[owner][:, np.newaxis]
        allowed = (store < NEVER) & (ticks.fetch < NEVER)
        if own >= 0:
            allowed[:, own] = False
        ways = np.where(allowed, store + ticks.fetch, NEVER)
        paid = np.where(allowed, ways * PARTS + prices.place[:, np.newaxis], _NEVER)
        order = np.lexsort((paid, ways), axis=0)
        in_order = np.take_along_axis(paid, order, axis=0)
        # a remembered place may have been used already, so it makes no other superfluous
        least = np.where(self._remembered[order], _NEVER, in_order)
        before = np.full_like(least, _NEVER)
        before[1:] = np.minimum.accumulate(least, axis=0)[:-1]
        rank, task = np.nonzero(in_order < before)
        place = order[rank, task]
        # tasks in order, as estimates are made of runs of ways
        takes = ways[place, task] + ticks.bring[task]
        cost = paid[place, task] + ticks.bring[task] * PARTS - prices.task[task]
        return self._onward_by(task, place, takes, cost)

    def _onward_by(
        self,
        task: NDArray[np.int64],
        place: NDArray[np.int64],
        takes: NDArray[np.int64],
        cost: NDArray[np.int64],
    ) -> _Onward:
        pairs = zip(task.tolist(), place.tolist(), strict=True)
        return _Onward(task, place, takes, cost, [1 << one | self._bit[at] for one, at in pairs])

    def _last(self, owner: int) -> list[tuple[int, int]]:
        """Return the costs and places of ends after an owner, the cheapest first."""
        ticks = self._ticks
        if owner < ticks.robots and not ticks.carrying[owner]:
            return [(0, NONE)]
        store = ticks.store[owner]
        allowed = np.flatnonzero(store < NEVER)
        paid = store[allowed] * PARTS + self._prices.place[allowed]
        ends = []
        for index in np.argsort(paid, kind="stable").tolist():
            place = int(allowed[index])
            ends.append((int(paid[index]), place))
            if not self._remembered[place]:
                break
        return ends

    # --- estimates ------------------------------------------------------------------------------

    def _estimates(self) -> tuple[int, NDArray[np.int64]]:
        """Return the length of a time step in ticks, and the estimates of the remaining cost.

        Entry (q, t) is a lower bound on the cost after an arrival at t in step q or later.
        """
        ticks, prices = self._ticks, self._prices
        until = self._until()
        horizon = until if until < NEVER else round(_LONGEST_S * TICKS_PER_S)
        length = max(1, -(-horizon // _STEPS))
        steps = horizon // length + 1
        ends = [one[0][0] if one else _NEVER for one in self._ends[ticks.robots :]]
        end = np.array(ends, np.int64)
        # no route can earn more than all tasks once
        least = -int(np.maximum(prices.task, 0).sum())
        rest = np.empty((steps + 1, ticks.tasks), np.int64)
        rest[steps] = end if until < NEVER else np.minimum(end, least)
        ways = self._onward[ticks.robots :]
        count = np.array([len(one.task) for one in ways], np.int64)
        some = np.flatnonzero(count)
        self.entries += (steps + 1) * int(count.sum())
        if not len(some):
            rest[:] = end
            return length, rest
        task = np.concatenate([one.task for one in ways])
        service = np.repeat(ticks.service, count)
        takes = np.concatenate([one.takes for one in ways]) + service
        cost = np.concatenate([one.cost for one in ways])
        begins = (np.cumsum(count) - count)[some]
        for step in range(steps - 1, -1, -1):
            arrive = np.maximum(step * length + takes, ticks.earliest[task])
            reached = np.minimum(arrive // length, steps)
            # a step that leads to itself is not known yet
            after = np.where(reached > step, rest[reached, task], least)
            total = cost + PARTS * ticks.late(task, arrive) + after
            total = np.where(arrive > ticks.latest[task], _NEVER, total)
            rest[step] = end
            rest[step, some] = np.minimum(end[some], np.minimum.reduceat(total, begins))
        return length, rest

    def _until(self) -> int:
        """Return a time after which an arrival at any task costs more than it earns, in ticks."""
        ticks, price = self._ticks, self._prices.task
        worthy = price > 0
        if not worthy.any():
            return 0
        last = ticks.latest[worthy]
        if ticks.weight:
            worth = -(-price[worthy] // (PARTS * ticks.weight))
            last = np.minimum(last, np.maximum(0, ticks.due[worthy] + worth))
        return int(last.max())

    # --- search ---------------------------------------------------------------------------------

    def cheapest(self, robot: int, below: int, most: int, labels: int) -> Found:
        """Find the cheapest routes of a robot.

        Parameters
        ----------
        robot
            Index of the robot.
        below
            Only routes that cost less than this are searched for; in parts of a tick.
        most
            Maximum number of routes; the search ends when it has found this number.
        labels
            Maximum number of partial routes; the search ends when it has extended this number.

        Returns
        -------
        The routes found, and a lower bound on the cost of every route of the robot. The bound is
        at most `below`.
        """
        start = _Label(0, int(self._ticks.ready[robot]), NONE, 0, (), ())
        heap = self._further(robot, start, below, 0)
        heapq.heapify(heap)
        number = len(heap)
        settled: list[list[_Label]] = [[] for _ in range(self._ticks.tasks)]
        found: list[Route] = []
        bound = below
        while heap:
            ahead = heapq.heappop(heap)
            if not found and (ahead.way == NONE or not labels):
                bound = min(below, ahead.estimate)
            before, place = ahead.label, ahead.place
            places = before.places if place == NONE else (*before.places, place)
            if ahead.way == NONE:
                found.append(Route(robot, before.tasks, places))
                if len(found) >= most:
                    return Found(bound, found, complete=not heap)
                continue
            if not labels:
                return Found(bound, found, complete=False)
            labels -= 1
            ways = self._onward[self._owner(robot, before)]
            task, used = int(ways.task[ahead.way]), before.used | ways.uses[ahead.way]
            label = _Label(ahead.cost, ahead.time, task, used, (*before.tasks, task), places)
            if self._superfluous(label, settled[task]):
                continue
            settled[task].append(label)
            for further in self._further(robot, label, below, number):
                heapq.heappush(heap, further)
                number += 1
        return Found(bound, found, complete=True)

    def _owner(self, robot: int, label: _Label) -> int:
        return robot if label.last == NONE else self._ticks.robots + label.last

    def _superfluous(self, label: _Label, settled: list[_Label]) -> bool:
        """Whether another partial route can replace this one, whatever its continuation."""
        self.entries += len(settled)
        for other in settled:
            if other.cost <= label.cost and other.time <= label.time:
                extra = other.used ^ label.used if self._every else other.used & ~label.used
                if not extra:
                    return True
        return False

    def _further(self, robot: int, label: _Label, below: int, number: int) -> list[_Next]:
        """Return the ends of a partial route and its continuations, numbered from `number` on."""
        ticks, owner = self._ticks, self._owner(robot, label)
        leaves = label.time + (0 if label.last == NONE else int(ticks.service[label.last]))
        further = []
        for paid, place in self._ends[owner]:
            total = label.cost + paid
            if total >= below:
                break
            if not self._bit[place] & label.used:
                further.append(_Next(total, number, label, NONE, place, total, leaves))
                number += 1
                if not self._every:
                    break
        ways = self._onward[owner]
        self.entries += LABEL_ENTRIES + len(ways.task)
        arrive = np.maximum(leaves + ways.takes, ticks.earliest[ways.task])
        cost = label.cost + ways.cost + PARTS * ticks.late(ways.task, arrive)
        step = np.minimum(arrive // self._step, len(self._rest) - 1)
        estimate = cost + self._rest[step, ways.task]
        good = np.flatnonzero((estimate < below) & (arrive <= ticks.latest[ways.task]))
        columns = (good, estimate[good], ways.place[good], cost[good], arrive[good])
        for way, least, at, so_far, time in zip(*(one.tolist() for one in columns), strict=True):
            if not ways.uses[way] & label.used:
                further.append(_Next(least, number, label, way, at, so_far, time))
                number += 1
        return further
