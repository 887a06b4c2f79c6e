r"""Routes by column generation: a bound over whole routes, and a choice among those generated.

The linear program over all routes of all robots (`master`) is solved by adding routes that are
cheap at its dual prices (`pricing`). For any prices :math:`v_t` of tasks and :math:`w_l \ge 0` of
places, no plan costs less than

.. math::

    \sum_t \min(v_t, skip_t) - \sum_l w_l + \sum_r \min_{p \in r} cost_p(v, w)

where p runs over the routes of robot r, and :math:`cost_p(v, w)` is the cost of route p at these
prices (a Lagrangian bound; Desaulniers, Desrosiers, Solomon 2005, Column Generation, chapter 1).
Prices are rounded to parts of a tick (a tick is a millisecond), and `pricing` uses them in exact
integer arithmetic, so the bound has no rounding error. The bound holds even if the search for a
cheapest route ends early, because the search then returns a lower bound on the cost of that route.
All costs are whole ticks, so the bound is rounded up to a whole tick.

At the end, HiGHS chooses one route per robot among the known routes. If a gap remains between the
plan and the bound, further routes are listed for each robot: all routes whose cost, at the prices
of the best bound, exceeds that of the robot's cheapest route by less than the gap. No other route
can be part of a better plan (Baldacci, Christofides, Mingozzi 2008). So the best choice among the
listed routes and those of the best known plan is an optimum.
"""

from __future__ import annotations

import math
from dataclasses import replace
from time import perf_counter
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from rmfs.solvers.models.backends.outcome import NUMERICAL_TOLERANCE
from rmfs.solvers.models.checks import require
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, Status, WallGuardError
from rmfs.solvers.models.tasks.sequence import greedy
from rmfs.solvers.models.tasks.sequence.bound import relaxed_bound
from rmfs.solvers.models.tasks.sequence.data import TICKS_PER_S, Routes, TaskSequence
from rmfs.solvers.models.tasks.sequence.master import Master, Relaxed
from rmfs.solvers.models.tasks.sequence.pricing import PARTS, Prices, Pricing
from rmfs.solvers.models.tasks.sequence.schedule import objective, violations
from rmfs.solvers.models.tasks.sequence.ticks import NEVER, Route, Ticks, joined, split

if TYPE_CHECKING:
    from numpy.typing import NDArray

ENTRY_S = 4e-8
"""Deterministic seconds per entry examined by the pricing."""

ITERATION_S = 8e-5
"""Deterministic seconds per simplex iteration."""

NODE_S = 0.05
"""Deterministic seconds per node of HiGHS, to convert a limit to a number of nodes."""

ROUTES = 10
"""Maximum number of routes added per robot in a round."""

LABELS = 2_000
"""Limit of partial routes per robot in a round; quadrupled whenever it is too small."""

LISTED = 20_000
"""Limit of partial routes per robot when all routes within the gap are listed."""


def solve(
    data: TaskSequence,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Routes | None = None,
) -> Solution[Routes]:
    """Find routes and a lower bound by column generation.

    Parameters
    ----------
    data
        The problem.
    limits
        `deterministic_s` and `gap` apply. Default: none; the routes are then optimal, unless there
        are too many routes to list (see the module).
    seed
        Seed of HiGHS. Default 0.
    start
        Feasible routes to start from. Default: those of `greedy`, if it finds any.

    Returns
    -------
    The routes, never worse than the start, and the bound. Work is counted in deterministic seconds.

    Raises
    ------
    ModelError
        If the start is not feasible.
    WallGuardError
        If the solve took longer than the wall-clock guard allows.
    """
    began = perf_counter()
    if start is not None:
        broken = violations(data, start)
        require(not broken, "start", "; ".join(broken))
    else:
        start = greedy.solve(data).values
    least = relaxed_bound(data)
    search = _Search(data, limits, seed, start, began)
    if math.isfinite(least):
        search.run()
    routes = search.routes
    bound = max(least, search.bound_s)
    wall_s = perf_counter() - began
    if routes is None:
        status = Status.INFEASIBLE if math.isinf(bound) else Status.LIMIT
        return Solution(None, math.inf, bound, status, "columns", wall_s, work=search.work)
    value = objective(data, routes)
    bound = min(bound, value)
    proven = value - bound <= max(limits.gap, 2 * NUMERICAL_TOLERANCE) * abs(value)
    status = Status.OPTIMAL if proven else Status.FEASIBLE
    return Solution(routes, value, bound, status, "columns", wall_s, work=search.work)


class _Priced(NamedTuple):
    """The prices that gave the best bound.

    Attributes
    ----------
    prices
        Of tasks and places.
    least
        Cost of the cheapest route of each robot, at least, in parts.
    bound
        The bound, in parts.
    """

    prices: Prices
    least: list[int]
    bound: int


class _Search:
    """The state of one solve."""

    def __init__(
        self,
        data: TaskSequence,
        limits: Limits,
        seed: int,
        start: Routes | None,
        began: float,
    ) -> None:
        self._data, self._limits, self._seed, self._began = data, limits, seed, began
        self._ticks = Ticks(data)
        self._master = Master(self._ticks)
        self._remembered = np.zeros(data.places, bool)
        self._best: _Priced | None = None
        self._listed = -math.inf
        self.routes = start
        self.work = 0.0

    @property
    def bound_s(self) -> float:
        """The best bound, in s."""
        priced = -math.inf if self._best is None else -(-self._best.bound // PARTS)
        ticks = max(priced, self._listed)
        return ticks / TICKS_PER_S if math.isfinite(ticks) else ticks

    def run(self) -> None:
        """Generate routes, choose among them, and list the others that may matter."""
        for robot in np.flatnonzero(~self._data.carrying).tolist():
            self._master.add(Route(robot, (), ()))
        self._add_start()
        self._generate()
        if self._apart() > 0 and self._best is not None:
            self._choose()
        if self._is_open() and self._list():
            self._listed = max(self._listed, self._choose())

    def _add_start(self) -> None:
        if self.routes is not None:
            for route in split(self._data, self.routes):
                self._master.add(route)

    def _left_s(self) -> float:
        limit = self._limits.deterministic_s
        guard = self._limits.wall_guard_s
        if guard is not None and perf_counter() - self._began > guard:
            raise WallGuardError(f"column generation was stopped after {guard:g} s")
        return math.inf if limit is None else limit - self.work

    def _value(self) -> int | None:
        """Return the value of the best routes known, in ticks."""
        if self.routes is None:
            return None
        return round(objective(self._data, self.routes) * TICKS_PER_S)

    def _apart(self) -> float:
        """Return the gap between value and bound, in ticks; 0 if it is within the gap limit."""
        value = self._value()
        if value is None:
            return math.inf
        apart = value - self.bound_s * TICKS_PER_S
        return 0.0 if apart <= max(0.5, self._limits.gap * value) else apart

    def _is_open(self) -> bool:
        """Whether work is left, and a gap."""
        return self._left_s() > 0 and self._apart() > 0

    # --- column generation ----------------------------------------------------------------------

    def _generate(self) -> None:
        """Add routes until the relaxation is solved, or work or gap are used up."""
        labels = LABELS
        while self._is_open():
            relaxed = self._master.relaxed()
            self.work += ITERATION_S * relaxed.iterations
            new, complete = self._price(relaxed, labels)
            if new:
                continue
            if not complete:
                labels *= 4
            elif not self._remember(relaxed):
                return

    def _price(self, relaxed: Relaxed, labels: int) -> tuple[bool, bool]:
        """Look for cheaper routes of all robots.

        Returns
        -------
        Whether there are new ones, and whether all searches came to their end.
        """
        ticks = self._ticks
        prices = Prices(_parts(relaxed.task), np.maximum(0, _parts(-relaxed.place)))
        pricing = Pricing(ticks, prices, self._remembered)
        new, complete, least = False, True, []
        for robot, dual in enumerate(_parts(relaxed.robot).tolist()):
            found = pricing.cheapest(robot, dual, ROUTES, labels)
            least.append(found.bound)
            complete &= found.complete or bool(found.routes)
            for route in found.routes:
                new |= self._master.add(route)
        self.work += ENTRY_S * pricing.entries
        skip = np.minimum(0, ticks.skip * PARTS - prices.task)
        bound = int(prices.task.sum() + skip.sum() - prices.place.sum()) + sum(least)
        if self._best is None or bound > self._best.bound:
            self._best = _Priced(prices, least, bound)
        return new, complete

    def _remember(self, relaxed: Relaxed) -> bool:
        """Remember the places that the relaxation repeats; return whether there are any."""
        used = np.flatnonzero(relaxed.used > 1e-9).tolist()
        repeated = set[int]().union(*(self._master.routes[index].repeats for index in used))
        new = {place for place in repeated if not self._remembered[place]}
        self._remembered[list(new)] = True
        self._master.forbid_repeats(new)
        return bool(new)

    # --- whole routes ---------------------------------------------------------------------------

    def _choose(self) -> float:
        """Choose whole routes; return the bound on all choices, in ticks."""
        left = self._left_s()
        nodes = None if math.isinf(left) else 1 + math.ceil(max(0.0, left) / NODE_S)
        limits = replace(NO_LIMITS, nodes=nodes, wall_guard_s=self._limits.wall_guard_s)
        start = [] if self.routes is None else list(split(self._data, self.routes))
        chosen = self._master.whole(start, limits, self._seed)
        self.work += ITERATION_S * chosen.iterations
        if chosen.routes is not None:
            routes = joined(self._data, chosen.routes)
            value = self._value()
            if value is None or objective(self._data, routes) * TICKS_PER_S < value - 0.5:
                self.routes = routes
        value = self._value()
        return min(chosen.bound, math.inf if value is None else value)

    def _list(self) -> bool:
        """List every route that a better plan may have; false if there are too many."""
        value, best = self._value(), self._best
        if value is None or best is None:
            return False
        # a better plan costs a tick less
        gap = (value - 1) * PARTS - best.bound
        pricing = Pricing(self._ticks, best.prices, self._remembered, every=True)
        for robot, least in enumerate(best.least):
            found = pricing.cheapest(robot, least + gap + 1, LISTED, LISTED)
            if not found.complete:
                self.work += ENTRY_S * pricing.entries
                return False
            for route in found.routes:
                self._master.add(route)
        self.work += ENTRY_S * pricing.entries
        self._add_start()
        return True


def _parts(dual: NDArray[np.float64]) -> NDArray[np.int64]:
    """Round duals, in ticks, to parts."""
    bounded = np.clip(np.nan_to_num(dual), -float(NEVER), float(NEVER))
    parts: NDArray[np.int64] = np.rint(bounded * PARTS).astype(np.int64)
    return parts
