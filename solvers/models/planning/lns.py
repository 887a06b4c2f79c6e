"""Neighbourhood search: visits are removed from a plan, and others inserted (Shaw 1998).

Each step replaces, moves or adds a visit of a station, swaps visits of two stations, or
redistributes the lines that two stations serve. For a new visit, a few pods are drawn from those
that could serve something, and the pod that a quick estimate rates best is used. Slightly worse
plans are accepted at first (threshold accepting, Dueck and Scheuer 1990). A step changes only what
one or two stations serve, so its time does not depend on the number of stations. The code of the
steps is compiled: `rmfs/traffic/src/visits`.
"""

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

STEPS = 1000
"""Default number of steps, if the limits give none."""


def solve(
    data: Planning,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Plan | None = None,
    pods: Sequence[Sequence[int]] = (),
    bound_steps: int = 0,
) -> Solution[Plan]:
    """Improve the plan of the start rule by a neighbourhood search.

    Parameters
    ----------
    data
        The problem.
    limits
        `iterations` limits the number of steps. Default: 1000.
    seed
        Seed of the search. Default 0.
    start
        A feasible plan, to which the start rule adds visits. Default: none.
    pods
        Pods of the new visits of an earlier plan, one sequence per station. The start rule adds
        visits to those that are still possible. Not used if `start` is given. Default: none.
    bound_steps
        Number of subgradient steps of `prices.bound`. Default: 0, that is, no bound.

    Returns
    -------
    The plan, no worse than `start`, and no worse than the plan of the start rule.
    """
    began = time.perf_counter()
    known = first_visits(data, start, pods)
    steps = STEPS if limits.iterations is None else limits.iterations
    plan = found(visits(data).searched(known, steps, seed))
    return solution(data, plan, start, bound_steps, began)
