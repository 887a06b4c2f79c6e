"""Exact planning by CP-SAT, starting from the plan of the start rule."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.solvers.models.backends import cp_sat
from rmfs.solvers.models.planning.exact import by_programme
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution

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
    """Plan by constraint programming; of the limits, `deterministic_s` and `gap` apply.

    Parameters
    ----------
    data
        The problem.
    limits
        Limits of the solver. Default: none, so that the plan is optimal.
    seed
        Seed of the solver. Default 0.
    start, pods
        Passed to `greedy`, from whose plan the solver starts.
    bound_steps
        Not used.
    """
    return by_programme(cp_sat, data, limits, seed=seed, start=start, pods=pods)
