"""Neighbourhood search: visits are taken out of a plan, and others put in (Shaw 1998).

Each step replaces a visit of a station, moves or adds one, or lets visits of two stations change
places. The pod that comes is the best, by a quick estimate, of a few that are drawn among those
that serve something. Plans a little worse are allowed at first (threshold accepting, Dueck and
Scheuer 1990). What the other stations serve stays with them, so that a step costs the same however
many there are. The steps are compiled: `rmfs/traffic/src/visits`.
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
"""Steps if the limits name none."""


def solve(
    data: Planning,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Plan | None = None,
    pods: Sequence[Sequence[int]] = (),
    bound_steps: int = 0,
) -> Solution[Plan]:
    """Search from the plan of the start rule.

    Parameters
    ----------
    data
        The problem.
    limits
        `iterations` are the steps. Default: 1000.
    seed
        Seed of the search. Default 0.
    start
        A feasible plan. Default: none.
    pods
        Visits per station of an earlier plan, which go on as far as they are possible; `start` goes
        before. Default: none.
    bound_steps
        Steps for the bound (`prices`). Default: no bound.

    Returns
    -------
    The plan; not worse than the start, nor than what the start rule finds from the same start.
    """
    began = time.perf_counter()
    known = first_visits(data, start, pods)
    steps = STEPS if limits.iterations is None else limits.iterations
    plan = found(visits(data).searched(known, steps, seed))
    return solution(data, plan, start, bound_steps, began)
