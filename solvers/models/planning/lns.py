"""Large neighbourhood search: visits are taken out of a plan, and others put in (Shaw 1998)."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import numpy as np

from rmfs.solvers.models.planning.appeal import Appeal
from rmfs.solvers.models.planning.filling import Filling
from rmfs.solvers.models.planning.outcome import solution
from rmfs.solvers.models.planning.visits import extended, first_visits, with_visit
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.solvers.models.planning.data import Planning
    from rmfs.solvers.models.planning.filling import Draft
    from rmfs.solvers.models.planning.values import Plan

SWAPS = 0.3
"""Share of the steps that let two visits change places."""
MOST_TAKEN = 3
"""Most visits that are taken out at a time."""
LIST = 8
"""Pods that a new visit is drawn from, those that look best."""


STEPS = 100
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
        `iterations` are the steps. Default: 100.
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
    filling, appeal = Filling(data), Appeal(data)
    draft = extended(filling, appeal, first_visits(data, start, pods))
    steps = STEPS if limits.iterations is None else limits.iterations
    draft = improved(filling, appeal, draft, steps, np.random.default_rng(seed))
    return solution(data, draft.plan(), start, filling.work, bound_steps, began)


def improved(
    filling: Filling, appeal: Appeal, draft: Draft, steps: int, rng: np.random.Generator
) -> Draft:
    """Search from a draft; what is found is not worth less.

    Each step either lets two visits change places, or takes out up to three, and then draws pods
    for the gaps and the ends among those that look best, better ones more often. It is kept unless
    it is worth less.

    Parameters
    ----------
    steps
        How many changes are tried.
    """
    best = draft
    for _ in range(steps):
        visits = [(s, v) for s, pods in enumerate(best.pods) for v in range(len(pods))]
        if len(visits) > 1 and rng.random() < SWAPS:
            trial = _swapped(filling, best, visits, rng)
        else:
            trial = _renewed(filling, appeal, best, visits, rng)
        if trial is not None and trial.value >= best.value:
            best = trial
    return best


def _swapped(
    filling: Filling, draft: Draft, visits: list[tuple[int, int]], rng: np.random.Generator
) -> Draft | None:
    """Let two visits change places; None if a pod cannot come there."""
    first, second = rng.choice(len(visits), 2, replace=False).tolist()
    (station, visit), (other, its_visit) = visits[first], visits[second]
    pods = [list(one) for one in draft.pods]
    pod, its_pod = pods[station][visit], pods[other][its_visit]
    if not np.isfinite(filling.data.cost[[its_pod, pod], [station, other]]).all():
        return None
    pods[station][visit], pods[other][its_visit] = its_pod, pod
    return filling.draft(pods)


def _renewed(
    filling: Filling,
    appeal: Appeal,
    draft: Draft,
    visits: list[tuple[int, int]],
    rng: np.random.Generator,
) -> Draft:
    """Take out a few visits, and put others in their place and at the ends."""
    data = filling.data
    pods = [list(one) for one in draft.pods]
    gaps = []
    if visits:
        count = min(len(visits), 1 + int(rng.integers(MOST_TAKEN)))
        chosen = rng.choice(len(visits), count, replace=False).tolist()
        gaps = sorted((visits[number] for number in chosen), reverse=True)
        for station, visit in gaps:
            del pods[station][visit]
    trial = filling.draft(pods)
    rng.shuffle(gaps)
    for station, visit in [*gaps, *((s, data.visits) for s in range(data.stations))]:
        if len(trial.pods[station]) >= data.visits:
            continue
        pod = _drawn(appeal, trial, station, rng)
        if pod >= 0:
            longer = with_visit(filling, trial, station, visit, pod)
            if longer.value > trial.value:
                trial = longer
    return trial


def _drawn(appeal: Appeal, draft: Draft, station: int, rng: np.random.Generator) -> int:
    """Draw one of the pods that look best for a station, or -1."""
    scores = appeal.scores(draft, station)
    best = np.argsort(-scores, kind="stable")[:LIST]
    best = best[np.isfinite(scores[best])]
    return int(best[int(rng.random() ** 2 * len(best))]) if len(best) else -1
