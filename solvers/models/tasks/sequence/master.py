r"""The restricted master program: choose one of the known routes for each robot.

.. math::

    \min \sum_p c_p x_p + \sum_t skip_t s_t, \quad
    \sum_{p \in r} x_p = 1, \quad \sum_{p \ni t} x_p + s_t = 1, \quad
    \sum_p n_{pl} x_p \le 1

Here :math:`x_p` is 1 if route p is chosen, and :math:`c_p` is its cost; :math:`s_t` is 1 if task t
is postponed. Route p uses place l :math:`n_{pl}` times. The sum over :math:`p \in r` covers the
routes of robot r, and the sum over :math:`p \ni t` covers the routes that contain task t. Costs are
in ticks (milliseconds).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import highspy  # type: ignore[import-untyped]
import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.backends import highs
from rmfs.solvers.models.program import ProgramBuilder
from rmfs.solvers.models.tasks.sequence.data import TICKS_PER_S
from rmfs.solvers.models.tasks.sequence.ticks import NEVER, Route, Ticks

if TYPE_CHECKING:
    from rmfs.solvers.models.solution import Limits

_MISSING = 100_000 * TICKS_PER_S
"""Cost of a robot without a route, and of leaving a task that must be done, in ticks."""


class Relaxed(NamedTuple):
    """A solution of the linear relaxation.

    Attributes
    ----------
    robot, task, place
        Duals of the rows of robots, tasks and places, in ticks.
    used
        Value of each route in the relaxation, from 0 to 1.
    iterations
        Number of simplex iterations.
    """

    robot: NDArray[np.float64]
    task: NDArray[np.float64]
    place: NDArray[np.float64]
    used: NDArray[np.float64]
    iterations: int


class Chosen(NamedTuple):
    """An integral choice among the known routes.

    Attributes
    ----------
    routes
        One route per robot; None if no feasible choice was found.
    bound
        Lower bound on the cost of every choice among the known routes, in ticks.
    iterations
        Number of simplex iterations.
    """

    routes: list[Route] | None
    bound: float
    iterations: int


class Master:
    """The master program, to which routes can be added.

    Parameters
    ----------
    ticks
        The problem, with times in ticks.

    Attributes
    ----------
    routes
        The routes added so far.
    """

    def __init__(self, ticks: Ticks) -> None:
        self._ticks = ticks
        self.routes: list[Route] = []
        self._cost: list[int] = []
        self._known: set[Route] = set()
        self._solver = highspy.Highs()
        for name, value in (("output_flag", False), ("threads", 1), ("parallel", "off")):
            self._solver.setOptionValue(name, value)
        once = ticks.robots + ticks.tasks
        for row in range(once + ticks.places):
            self._solver.addRow(1.0 if row < once else -highspy.kHighsInf, 1.0, 0, [], [])
        skip = np.where(ticks.skip < NEVER, ticks.skip, _MISSING)
        for row, cost in enumerate([*[_MISSING] * ticks.robots, *skip.tolist()]):
            self._solver.addCol(float(cost), 0.0, highspy.kHighsInf, 1, [row], [1.0])
        self._first = once

    def add(self, route: Route) -> bool:
        """Add a route unless it is known already; return whether it was added."""
        if route in self._known:
            return False
        self._known.add(route)
        self.routes.append(route)
        self._cost.append(self._ticks.cost(route))
        rows = self._rows(route)
        count, cost = len(rows), float(self._cost[-1])
        entries = [float(times) for times in rows.values()]
        self._solver.addCol(cost, 0.0, highspy.kHighsInf, count, list(rows), entries)
        return True

    def _rows(self, route: Route) -> dict[int, int]:
        """Return the coefficient of a route in each row."""
        ticks = self._ticks
        rows = {route.robot: 1}
        rows |= {ticks.robots + task: 1 for task in sorted(route.tasks)}
        first = ticks.robots + ticks.tasks
        return rows | {
            first + place: route.places.count(place) for place in sorted(set(route.places))
        }

    def forbid_repeats(self, places: set[int]) -> None:
        """Exclude known routes that use one of the given places more than once."""
        for which, route in enumerate(self.routes):
            if route.repeats & places:
                self._solver.changeColBounds(self._first + which, 0.0, 0.0)

    def relaxed(self) -> Relaxed:
        """Solve the linear relaxation over the known routes."""
        ticks, solver = self._ticks, self._solver
        solver.run()
        solution = solver.getSolution()
        dual = np.array(solution.row_dual)
        return Relaxed(
            dual[: ticks.robots],
            dual[ticks.robots : self._first],
            dual[self._first :],
            np.array(solution.col_value)[self._first :],
            max(0, int(solver.getInfo().simplex_iteration_count)),
        )

    def whole(self, start: list[Route], limits: Limits, seed: int) -> Chosen:
        """Solve the integer program over the known routes with HiGHS.

        Parameters
        ----------
        start
            Known routes to start from.
        limits
            `nodes` limits the branch and bound.
        seed
            Seed of the solver.
        """
        ticks = self._ticks
        which = [index for index, route in enumerate(self.routes) if not route.repeats]
        builder = ProgramBuilder()
        cost = np.array([self._cost[index] for index in which], np.float64) / TICKS_PER_S
        driven = builder.columns(len(which), cost=cost)
        may_skip = ticks.skip < NEVER
        skipped = builder.columns(
            ticks.tasks, cost=np.where(may_skip, ticks.skip / TICKS_PER_S, 0.0), upper=may_skip
        )
        rows = [list(self._rows(self.routes[index])) for index in which]
        row = np.array([one for route in rows for one in route], np.int64)
        column = np.repeat(driven, np.array([len(one) for one in rows], np.int64))
        lower = np.repeat([1.0, -np.inf], [self._first, ticks.places])
        tasks = ticks.robots + np.arange(ticks.tasks)
        count = self._first + ticks.places
        builder.rows(count, (row, column, 1), (tasks, skipped, 1), lower=lower, upper=1)
        program = builder.build()
        given = set(start)
        done = {task for route in start for task in route.tasks}
        point = [float(self.routes[index] in given) for index in which]
        point += [float(task not in done) for task in range(ticks.tasks)]
        outcome = highs.solve(program, limits, seed=seed, start=np.array(point))
        bound, iterations = outcome.bound * TICKS_PER_S, int(outcome.work)
        if outcome.x is None:
            return Chosen(None, bound, iterations)
        chosen = np.flatnonzero(outcome.x[: len(which)] > 0.5).tolist()
        return Chosen([self.routes[which[one]] for one in chosen], bound, iterations)
