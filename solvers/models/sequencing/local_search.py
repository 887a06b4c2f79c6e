"""Local search on the sequence of visits: remove a visit, then repair the plan.

For a given sequence of visits, `still_open` decides at which visit to open each order, as in
interval scheduling. At each visit, it considers only orders whose completion would be delayed if
they were opened one visit later. Of these orders, it opens those that would be completed first. The
search removes the visit whose removal leaves the fewest orders incomplete. It then tries random
moves (exchange two visits, move a visit, or replace a pod) and keeps those that do not increase the
number of incomplete orders. When all orders are complete, a shorter plan has been found, and the
search removes another visit.
"""

from __future__ import annotations

import numpy as np

from rmfs.solvers.models.sequencing.data import (
    NEVER,
    Integers,
    Sequencing,
    VisitSequence,
    violations,
)
from rmfs.solvers.models.sequencing.sets import useful_pods

MOVES = 400
"""Default number of moves tried in total, removals included."""


def improve(
    data: Sequencing, plan: VisitSequence, moves: int | None = None, seed: int = 0
) -> tuple[VisitSequence, int]:
    """Shorten a plan by local search.

    Parameters
    ----------
    data
        The input.
    plan
        A feasible plan.
    moves
        Number of moves, removals included, after which the search ends. Default: `MOVES`.
    seed
        Seed of the moves. Default 0.

    Returns
    -------
    A feasible plan with at most as many visits as the given one, and the number of moves tried.
    """
    most = MOVES if moves is None else moves
    rng = np.random.default_rng(seed)
    pods = useful_pods(data)
    best, tried = merged(plan), 0
    while tried < most and best.pods.size > 1:
        # The visit whose loss hurts least is taken out.
        shorter = [np.delete(best.pods, visit) for visit in range(best.pods.size)]
        lost = [still_open(data, sequence)[1] for sequence in shorter]
        tried += len(shorter)
        current, missing = shorter[int(np.argmin(lost))], min(lost)
        while missing and tried < most:
            candidate = _moved(current, pods, rng)
            left = still_open(data, candidate)[1]
            tried += 1
            if left <= missing:
                current, missing = candidate, left
        if missing:
            break
        found = merged(VisitSequence(current, still_open(data, current)[0]))
        if violations(data, found) or found.pods.size >= best.pods.size:
            break
        best = found
    return best, tried


def still_open(data: Sequencing, pods: Integers) -> tuple[Integers, int]:
    """Decide at which visit to open each order, for a fixed sequence of visits.

    Parameters
    ----------
    data
        The input.
    pods
        Index of the visiting pod at each visit, shape (T,).

    Returns
    -------
    The index of the visit at which each order is opened, shape (O,), and the number of orders that
    stay incomplete. The index is -1 if the order is open before the first visit, and `NEVER` if it
    is not opened.
    """
    end = _ends(data, pods)
    start = np.where(data.open, -1, NEVER)
    leave = np.where(data.open, end[0], NEVER)
    begun = data.open.copy()
    for visit in range(pods.size):
        staying = np.count_nonzero(begun & (leave > visit))
        if staying >= data.capacity:
            continue
        now, later = end[visit], end[visit + 1]
        passing = ~begun & (now == visit)
        # An order that ends no later by waiting for the next visit waits.
        waiting = np.flatnonzero(~begun & (now > visit) & (now < later))
        chosen = waiting[np.argsort(now[waiting], kind="stable")][: data.capacity - staying]
        begun |= passing
        begun[chosen] = True
        fresh = np.append(np.flatnonzero(passing), chosen)
        start[fresh], leave[fresh] = visit, now[fresh]
    return start, int(np.count_nonzero(leave == NEVER))


def merged(plan: VisitSequence) -> VisitSequence:
    """Return the plan with consecutive visits of the same pod merged into one.

    Parameters
    ----------
    plan
        The plan.
    """
    new = np.diff(plan.pods, prepend=-1) != 0
    position = np.append(np.cumsum(new) - 1, -1)
    return VisitSequence(plan.pods[new], np.where(plan.start >= 0, position[plan.start], -1))


def _ends(data: Sequencing, pods: Integers) -> Integers:
    """When each order would be complete if opened at each visit, shape (T + 1, O)."""
    visits = pods.size
    coming = np.full((visits + 1, data.needs.shape[1]), NEVER)
    present = data.holds[pods]
    for visit in range(visits - 1, -1, -1):
        coming[visit] = np.where(present[visit], visit, coming[visit + 1])
    end = np.empty((visits + 1, data.orders), dtype=np.int64)
    for order in range(data.orders):
        end[:, order] = coming[:, data.needs[order]].max(axis=1)
    return end


def _moved(sequence: Integers, pods: Integers, rng: np.random.Generator) -> Integers:
    """The sequence after one random move."""
    moved = sequence.copy()
    i, j = rng.integers(moved.size, size=2)
    kind = rng.integers(3)
    if kind == 0:
        moved[i], moved[j] = moved[j], moved[i]
    elif kind == 1:
        moved = np.insert(np.delete(moved, i), min(j, moved.size - 1), sequence[i])
    else:
        moved[i] = pods[rng.integers(pods.size)]
    return moved
