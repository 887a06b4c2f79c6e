"""One way in: a plan by the start rule, by search, or exactly."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Literal

import numpy as np

from rmfs.solvers.models.backends import cp_sat
from rmfs.solvers.models.planning import greedy, prices, search
from rmfs.solvers.models.planning.appeal import Appeal
from rmfs.solvers.models.planning.filling import Filling
from rmfs.solvers.models.planning.program import Programme
from rmfs.solvers.models.planning.values import objective
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, Status

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.solvers.models.planning.data import Planning
    from rmfs.solvers.models.planning.values import Plan

Method = Literal["greedy", "lns", "exact"]

NAME = "visits"
"""Back end of the rule and of the search; its unit of work is a line looked at for a visit."""
STEPS = 100
"""Steps of the search if the limits name none."""


def solve(
    data: Planning,
    method: Method = "lns",
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Sequence[Sequence[int]] | None = None,
    bound_steps: int = 0,
) -> Solution[Plan]:
    """Plan visits.

    Parameters
    ----------
    data
        The input.
    method
        `greedy`: the start rule; `lns`: large neighbourhood search from there; `exact`: CP-SAT from
        there.
    limits
        `iterations` are the steps of the search (default 100); `deterministic_s` and `gap` those of
        CP-SAT.
    seed
        Seed of the search. Default 0.
    start
        New visits per station of an earlier plan, to go on with. Default: none.
    bound_steps
        Steps for the bound of `greedy` and `lns`. Default: no bound.

    Returns
    -------
    The plan. That of a search is not worse than that of the start rule from the same start.
    """
    began = time.perf_counter()
    filling, appeal = Filling(data), Appeal(data)
    draft = greedy.extended(filling, appeal, _known(data, start))
    if method == "exact":
        return _exact(data, draft.plan(), limits, seed, began)
    if method == "lns":
        if start is not None and any(start):
            fresh = greedy.extended(filling, appeal, [[] for _ in range(data.stations)])
            draft = max(draft, fresh, key=lambda one: one.value)
        steps = STEPS if limits.iterations is None else limits.iterations
        draft = search.improved(filling, appeal, draft, steps, np.random.default_rng(seed))
    plan = draft.plan()
    value = objective(data, plan)
    proven = prices.bound(data, value, bound_steps)
    return Solution(
        values=plan,
        objective=value,
        bound=proven,
        status=Status.OPTIMAL if proven == value else Status.FEASIBLE,
        backend=NAME,
        wall_s=time.perf_counter() - began,
        work=float(filling.filled * data.stations * max(data.lines, 1)),
    )


def _known(data: Planning, start: Sequence[Sequence[int]] | None) -> list[list[int]]:
    """Return the visits of a start that are still possible."""
    found: list[list[int]] = [[] for _ in range(data.stations)]
    seen: set[int] = set()
    for station, pods in enumerate(start or ()):
        for pod in pods:
            possible = np.isfinite(data.cost[pod, station]) and pod not in seen
            if possible and len(found[station]) < data.visits:
                found[station].append(pod)
                seen.add(pod)
    return found


def _exact(data: Planning, start: Plan, limits: Limits, seed: int, began: float) -> Solution[Plan]:
    programme = Programme(data)
    build_s = time.perf_counter() - began
    outcome = cp_sat.solve(programme.linear, limits, seed=seed, start=programme.columns(start))
    plan = start if outcome.x is None else programme.plan(outcome.x)
    if objective(data, start) < objective(data, plan):
        plan = start
    value = objective(data, plan)
    proven = outcome.status is Status.OPTIMAL
    return Solution(
        values=plan,
        objective=value,
        bound=min(outcome.bound, value),
        status=Status.OPTIMAL if proven else Status.FEASIBLE,
        backend=outcome.backend,
        wall_s=time.perf_counter() - began,
        build_s=build_s + outcome.build_s,
        work=outcome.work,
    )
