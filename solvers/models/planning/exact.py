"""Shared part of the exact methods: solve the program, starting from the start rule's plan."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any, Protocol

from rmfs.solvers.models.planning import greedy
from rmfs.solvers.models.planning.outcome import better
from rmfs.solvers.models.planning.program import Programme
from rmfs.solvers.models.planning.values import objective
from rmfs.solvers.models.solution import Limits, Solution, Status

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.solvers.models.planning.data import Planning
    from rmfs.solvers.models.planning.values import Plan


class Backend(Protocol):
    """A back end of `rmfs.solvers.models.backends`."""

    @property
    def solve(self) -> Any:
        """The function that solves a program."""


def by_programme(
    backend: Backend,
    data: Planning,
    limits: Limits,
    *,
    seed: int,
    start: Plan | None,
    pods: Sequence[Sequence[int]],
) -> Solution[Plan]:
    """Solve the integer program; the plan is never worse than that of the start rule."""
    began = time.perf_counter()
    first = greedy.solve(data, start=start, pods=pods).required
    programme = Programme(data)
    build_s = time.perf_counter() - began
    found = backend.solve(programme.linear, limits, seed=seed, start=programme.columns(first))
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
        built=found.built,
    )
