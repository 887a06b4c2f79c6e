"""Pod match: the best call first, over all stations at once.

Orders are placed wherever stock already covers them; then, again and again, the pod (or the set of
pods for one order) with the greatest gain of all stations is called, and its station filled. With
the slots full, pods whose prospects are worth more than their call follow in the same way. Gains
shrink while orders and pods go to other stations, so a station is scored again only when it comes
first (lazy evaluation). Deterministic: ties go to the lower station and pod.
"""

from __future__ import annotations

import heapq
import time
from collections.abc import Callable

from rmfs.solvers.models.pile_on.candidates import Candidates, everything
from rmfs.solvers.models.pile_on.data import PileOn
from rmfs.solvers.models.pile_on.draft import Call, Draft, decision, drop_idle
from rmfs.solvers.models.pile_on.partial import cover_rest
from rmfs.solvers.models.pile_on.values import Assignment, objective
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, Status

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
    fill_slots(draft, limits.iterations)
    drop_idle(draft)
    add_prospects(draft, limits.iterations)
    values = cover_rest(data, decision(draft))
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


def fill_slots(draft: Draft, most: int | None = None) -> None:
    """Place orders and call pods until nothing gains any more.

    Parameters
    ----------
    draft
        The draft to complete.
    most
        Most calls to make. Default: no limit.
    """
    for station in range(draft.data.stations):
        draft.fill(station)
    _best_first(draft, draft.best_call, lambda call: draft.fill(call.station), most)


def add_prospects(draft: Draft, most: int | None = None) -> None:
    """Count the orders that leftovers cover, and call pods that bring more of them than they cost.

    Parameters
    ----------
    draft
        A draft with its slots filled.
    most
        Most calls to make. Default: no limit.
    """
    for station in range(draft.data.stations):
        draft.reserve(station)
    _best_first(draft, draft.best_prospect_call, draft.settle_prospects, most)


def _best_first(
    draft: Draft,
    score: Callable[[int], Call | None],
    use: Callable[[Call], None],
    most: int | None,
) -> None:
    """Make the call of greatest gain over all stations, again and again.

    `score` finds the best call of a station; `use` takes what a call brought.
    """
    # A station that was never scored comes first.
    queue: list[tuple[float, int, int, Call | None]] = [
        (float("-inf"), station, -1, None) for station in range(draft.data.stations)
    ]
    calls = 0
    while queue and (most is None or calls < most):
        _, station, scored_at, call = heapq.heappop(queue)
        if scored_at < calls:
            call = score(station)
            if call is not None:
                heapq.heappush(queue, (-call.gain, station, calls, call))
        elif call is not None:
            draft.call(call)
            use(call)
            calls += 1
            heapq.heappush(queue, (float("-inf"), station, -1, None))
