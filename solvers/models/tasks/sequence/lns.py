"""Neighbourhood search: tasks are taken out of the routes and inserted again (Shaw 1998).

Most steps take a few tasks out of the routes. Then these tasks, and those postponed so far, are
inserted in random order, each where it adds the least cost (a few positions are skipped at random).
The other steps choose new places for some pods. Slightly worse routes are accepted at first
(threshold accepting, Dueck and Scheuer 1990).

If no start is given, there are two initial plans: one has no tasks, and the other has at most one
task per robot, found by assignment. The remaining tasks are inserted into each initial plan by
urgency, and the search starts from the better result. The search is written in Rust
(`rmfs/traffic/src/sequences`).
"""

from __future__ import annotations

import math
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np

from rmfs.solvers.models.checks import require
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, Status
from rmfs.solvers.models.tasks.sequence.bound import relaxed_bound
from rmfs.solvers.models.tasks.sequence.data import Routes, TaskSequence
from rmfs.solvers.models.tasks.sequence.schedule import objective, violations
from rmfs.solvers.models.tasks.sequence.starts import first_tasks, without_tasks
from rmfs.solvers.models.tasks.sequence.ticks import NEVER, Ticks
from rmfs.traffic._core import Sequences  # the package has one compiled library

if TYPE_CHECKING:
    from numpy.typing import NDArray

STEPS_PER_TASK = 200
"""Default number of steps for each task, if the limits give none."""

NAME = "insertions"
"""Back end name; a unit of work is one position examined for a task."""


def solve(
    data: TaskSequence,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Routes | None = None,
) -> Solution[Routes]:
    """Find routes by neighbourhood search, from given routes or from two simple plans.

    Parameters
    ----------
    data
        The problem.
    limits
        `iterations` limits the number of steps. Default: 200 for each task.
    seed
        Seed of the search. Default 0.
    start
        Feasible routes, into which the remaining tasks are inserted before the search. Default: the
        two initial plans of the module docstring.

    Returns
    -------
    The routes, never worse than the start, with the bound of `relaxed_bound`. If the search finds
    no routes that contain all mandatory tasks, the solution has no routes; its status is then
    INFEASIBLE if the bound is infinite, otherwise LIMIT.

    Raises
    ------
    ModelError
        If the start is not feasible.
    """
    began = perf_counter()
    if start is not None:
        broken = violations(data, start)
        require(not broken, "start", "; ".join(broken))
    bound = relaxed_bound(data)
    starts = [without_tasks(data), first_tasks(data)] if start is None else [start]
    given = [_owned(plan) for plan in starts if plan is not None]
    steps = STEPS_PER_TASK * data.tasks if limits.iterations is None else limits.iterations
    compiled = _compiled(data)
    built = perf_counter()
    found = compiled.searched(given, steps, seed)
    routes = None if found is None or math.isinf(bound) else _routes(data, found)
    value = math.inf if routes is None else objective(data, routes)
    bound = min(bound, value)
    ended = Status.INFEASIBLE if math.isinf(bound) else Status.LIMIT
    return Solution(
        routes,
        value,
        bound,
        ended if routes is None else Status.FEASIBLE,
        NAME,
        perf_counter() - began,
        built - began,
        0.0 if found is None else float(found[2]),
        built=float((data.robots + data.tasks) * data.places * data.tasks),
    )


def _compiled(data: TaskSequence) -> Sequences:
    """Pass a problem to the compiled search."""
    ticks = Ticks(data)
    return Sequences(
        ticks.ready.tolist(),
        ticks.carrying.tolist(),
        ticks.reach.ravel(),
        ticks.store.ravel(),
        ticks.fetch.ravel(),
        ticks.bring.tolist(),
        ticks.service.tolist(),
        ticks.earliest.tolist(),
        ticks.latest.tolist(),
        ticks.due.tolist(),
        ticks.skip.tolist(),
        min(ticks.weight, NEVER),
    )


def _owned(plan: Routes) -> tuple[list[list[int]], list[int]]:
    """Return the tasks of each robot, and the place of each owner's pod (robots before tasks)."""
    place: NDArray[np.int64] = np.concatenate([plan.robot_place, plan.place])
    return [list(tasks) for tasks in plan.tasks], place.tolist()


def _routes(data: TaskSequence, found: tuple[list[list[int]], list[int], int]) -> Routes:
    """Turn the result of the compiled search into routes."""
    tasks, owned, _ = found
    place = np.array(owned, np.int64)
    return Routes(tuple(map(tuple, tasks)), place[data.robots :], place[: data.robots])
