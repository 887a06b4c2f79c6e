"""Results of the start rule and the search."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from rmfs.solvers.models.planning import prices
from rmfs.solvers.models.planning.values import objective
from rmfs.solvers.models.solution import Solution, Status

if TYPE_CHECKING:
    from rmfs.solvers.models.planning.compiled import Found
    from rmfs.solvers.models.planning.data import Planning
    from rmfs.solvers.models.planning.values import Plan

NAME = "visits"
"""Name of the back end of the start rule and of the search. Its work is the number of stock entries
and lines examined."""


def better(data: Planning, plan: Plan, start: Plan | None) -> Plan:
    """Return the better of a plan and the start; without a start, the plan."""
    if start is not None and objective(data, start) < objective(data, plan):
        return start
    return plan


def solution(
    data: Planning, found: Found, start: Plan | None, bound_steps: int, began: float
) -> Solution[Plan]:
    """Return the better of the plan found and the start, as a `Solution`.

    A bound is computed if `bound_steps` is positive.
    """
    chosen = better(data, found.plan, start)
    value = objective(data, chosen)
    proven = prices.bound(data, value, bound_steps)
    return Solution(
        values=chosen,
        objective=value,
        bound=proven,
        status=Status.OPTIMAL if proven == value else Status.FEASIBLE,
        backend=NAME,
        wall_s=time.perf_counter() - began,
        work=float(found.work),
        built=float(data.stock.size + data.cost.size),
    )
