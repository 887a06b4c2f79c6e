"""The start rule: visits are added one by one, each with the best of a few promising pods."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from rmfs.solvers.models.planning.compiled import found, visits
from rmfs.solvers.models.planning.outcome import solution
from rmfs.solvers.models.planning.start import first_visits
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
    """Build a plan by adding visits as long as they improve it.

    Parameters
    ----------
    data
        The problem.
    limits, seed
        Not used.
    start
        A feasible plan to which visits are added. Default: none.
    pods
        Pods of the new visits of an earlier plan, one sequence per station. Visits are added to
        those that are still possible. Not used if `start` is given. Default: none.
    bound_steps
        Number of subgradient steps of `prices.bound`. Default: 0, that is, no bound.

    Returns
    -------
    The plan, no worse than `start`. Which lines each visit serves is decided anew, and new visits
    that would serve nothing are left out.
    """
    began = time.perf_counter()
    known = first_visits(data, start, pods)
    plan = found(visits(data).by_rule(known))
    return solution(data, plan, start, bound_steps, began)
