"""Exactly, by HiGHS from the plan of the start rule; its relaxation is nearly whole."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from rmfs.solvers.models.backends import highs
from rmfs.solvers.models.planning import greedy
from rmfs.solvers.models.planning.outcome import better
from rmfs.solvers.models.planning.program import Programme
from rmfs.solvers.models.planning.values import objective
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, Status

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.solvers.models.planning.data import Planning
    from rmfs.solvers.models.planning.values import Plan


def solve(
    data: Planning,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Plan | None = None,
    pods: Sequence[Sequence[int]] = (),
    bound_steps: int = 0,
) -> Solution[Plan]:
    """Plan by branch and bound; `nodes` and `gap` apply.

    Parameters
    ----------
    data
        The problem.
    limits
        Default: to optimality.
    seed
        Seed of the solver. Default 0.
    start, pods
        As for `greedy`, from whose plan the solver starts.
    bound_steps
        Not needed.
    """
    began = time.perf_counter()
    first = greedy.solve(data, start=start, pods=pods).required
    programme = Programme(data)
    build_s = time.perf_counter() - began
    found = highs.solve(programme.linear, limits, seed=seed, start=programme.columns(first))
    plan = first if found.x is None else better(data, programme.plan(found.x), first)
    value = objective(data, plan)
    return Solution(
        values=plan,
        objective=value,
        bound=min(found.bound, value),
        status=Status.OPTIMAL if found.status is Status.OPTIMAL else Status.FEASIBLE,
        backend=found.backend,
        wall_s=time.perf_counter() - began,
        build_s=build_s + found.build_s,
        work=found.work,
    )
