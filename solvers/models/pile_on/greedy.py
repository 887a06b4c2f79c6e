"""Pod match: the best call first, over all stations at once.

Orders are placed wherever stock already covers them; then, again and again, the pod (or the set of
pods for one order) with the greatest gain of all stations is called, and its station filled. Gains
shrink while orders and pods go to other stations, so a station is scored again only when it comes
first (lazy evaluation). Deterministic: ties go to the lower station and pod.
"""

from __future__ import annotations

import heapq
import time

from solvers.models.pile_on.candidates import Candidates, everything
from solvers.models.pile_on.data import PileOn
from solvers.models.pile_on.draft import Call, Draft, finish
from solvers.models.pile_on.partial import cover_rest
from solvers.models.pile_on.values import Assignment, objective
from solvers.models.solution import NO_LIMITS, Limits, Solution, Status

NAME = "greedy"


def solve(
    data: PileOn,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Assignment | None = None,
    candidates: Candidates | None = None,
) -> Solution[Assignment]:
    """Decide by greatest gain.

    Parameters
    ----------
    data
        The input.
    limits
        ``iterations`` limits the calls of pods. Default: none.
    seed
        Not used: nothing is drawn.
    start
        Not used: the rule builds from nothing.
    candidates
        The pairs to use. Default: all.

    Returns
    -------
    A feasible decision without a bound.
    """
    began = time.perf_counter()
    draft = Draft(data, candidates or everything(data))
    build(draft, limits.iterations)
    values = cover_rest(data, finish(draft))
    ended = time.perf_counter()
    return Solution(
        values=values,
        objective=objective(data, values),
        bound=float("-inf"),
        status=Status.FEASIBLE,
        backend=NAME,
        wall_s=ended - began,
        work=float(draft.scored),
    )


def build(draft: Draft, most: int | None = None) -> None:
    """Call pods and place orders until nothing gains any more.

    Parameters
    ----------
    draft
        The draft to complete.
    most
        Most calls to make. Default: no limit.
    """
    queue: list[tuple[float, int, int, Call | None]] = []
    calls = 0
    for station in range(draft.data.stations):
        draft.fill(station)
        # Never scored: it comes first, and is scored then.
        heapq.heappush(queue, (float("-inf"), station, -1, None))
    while queue and (most is None or calls < most):
        _, station, scored_at, call = heapq.heappop(queue)
        if scored_at < calls:
            call = draft.best_call(station)
            if call is not None:
                heapq.heappush(queue, (-call.gain, station, calls, call))
        elif call is not None:
            draft.call(call)
            draft.fill(station)
            calls += 1
            heapq.heappush(queue, (float("-inf"), station, -1, None))
