"""Pod match: a greedy heuristic that repeatedly calls the pod with the greatest gain.

1. Orders are *placed* (get a slot) at stations whose inbound pods cover them.
2. The pod (or the set of pods for one order) with the greatest gain over all stations is called,
   and free slots of its station are filled. This is repeated until no call has a positive gain.
3. Calls that are no longer needed are cancelled.
4. *Prospects* are added: orders that get no slot, although the pods of a station could serve them
   in full. Further pods are called for prospects whose value exceeds the cost of the call.

The best call of a station is computed again only when the station heads the list sorted by gain
(lazy evaluation), as its gain is assumed not to rise while orders and pods go to other stations.
Ties are broken by the lower number of the station, then of the pod, so the result is deterministic.
"""

from __future__ import annotations

import heapq
import time
from collections.abc import Callable

from rmfs.solvers.models.pile_on.candidates import Candidates, everything
from rmfs.solvers.models.pile_on.data import PileOn
from rmfs.solvers.models.pile_on.leftovers import cover_rest
from rmfs.solvers.models.pile_on.partial_assignment import (
    Call,
    PartialAssignment,
    decision,
    drop_idle,
)
from rmfs.solvers.models.pile_on.values import Assignment, objective
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, solution_of_rule


def solve(
    data: PileOn,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Assignment | None = None,
    candidates: Candidates | None = None,
) -> Solution[Assignment]:
    """Solve a pile-on model by pod match (see the module).

    `iterations` limits the number of calls made to fill slots and, separately, the number of calls
    made for prospects.

    Parameters
    ----------
    data, limits, seed, start
        As for every method (see `Methods`); `seed` and `start` are not used.
    candidates
        The pairs of pod and station, order and station, and robot and pod that may be used.
        Default: all.

    Returns
    -------
    A feasible decision without a bound.
    """
    began = time.perf_counter()
    partial = PartialAssignment(data, candidates or everything(data))
    fill_slots(partial, limits.iterations)
    drop_idle(partial)
    add_prospects(partial, limits.iterations)
    values = cover_rest(data, decision(partial))
    return solution_of_rule(
        values,
        lambda values: objective(data, values),
        bound=float("-inf"),
        work=float(partial.scored),
        began=began,
        built=partial.built,
    )


def fill_slots(partial: PartialAssignment, most: int | None = None) -> None:
    """Place orders and call pods until no call has a positive gain.

    Parameters
    ----------
    partial
        The partial assignment, changed in place.
    most
        Maximum number of calls. Default: no limit.
    """
    for station in range(partial.data.stations):
        partial.fill(station)
    _best_first(partial, partial.best_call, lambda call: partial.fill(call.station), most)


def add_prospects(partial: PartialAssignment, most: int | None = None) -> None:
    """Add prospects that leftover stock covers, then call pods for further prospects.

    A prospect is an order that gets no slot, although the pods of a station could serve it in full.
    A pod is called if the value of the prospects that it makes possible exceeds the cost of the
    call.

    Parameters
    ----------
    partial
        A partial assignment completed by `fill_slots`; changed in place.
    most
        Maximum number of calls. Default: no limit.
    """
    for station in range(partial.data.stations):
        partial.reserve(station)
    _best_first(partial, partial.best_prospect_call, partial.settle_prospects, most)


def _best_first(
    partial: PartialAssignment,
    score: Callable[[int], Call | None],
    use: Callable[[Call], None],
    most: int | None,
) -> None:
    """Repeatedly make the call with the greatest gain over all stations.

    `score` returns the best call of a station; `use` assigns orders after a call.
    """
    # A station that was never scored comes first.
    queue: list[tuple[float, int, int, Call | None]] = [
        (float("-inf"), station, -1, None) for station in range(partial.data.stations)
    ]
    calls = 0
    while queue and (most is None or calls < most):
        _, station, scored_at, call = heapq.heappop(queue)
        if scored_at < calls:
            call = score(station)
            if call is not None:
                heapq.heappush(queue, (-call.gain, station, calls, call))
        elif call is not None:
            partial.call(call)
            use(call)
            calls += 1
            heapq.heappush(queue, (float("-inf"), station, -1, None))
