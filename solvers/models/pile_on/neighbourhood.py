"""A search for large inputs: re-optimises two stations at a time, while all others stay fixed.

The search starts from a decision and re-optimises, in rounds, pairs of stations that are close to
each other. For each pair, CP-SAT decides anew on the orders placed at the pair, the waiting
orders, and the pods and robots that no other station uses. The result is never worse than the
start, and `deterministic_s` limits the total work.
"""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np

from rmfs.solvers.models.checks import require
from rmfs.solvers.models.pile_on import cp_sat
from rmfs.solvers.models.pile_on.candidates import Candidates, everything
from rmfs.solvers.models.pile_on.data import Integers, PileOn
from rmfs.solvers.models.pile_on.partial_assignment import assign_robots
from rmfs.solvers.models.pile_on.restrict import compact, part
from rmfs.solvers.models.pile_on.values import Assignment, nothing, objective, violations
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, Status

WIDTH = 2
"""Number of stations that are re-optimised together."""

DEFAULT_WORK = 1.0
"""Deterministic seconds if the limits give none; the search does not end by itself."""


def solve(
    data: PileOn,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Assignment | None = None,
    candidates: Candidates | None = None,
) -> Solution[Assignment]:
    """Improve a decision by re-optimising one *part* (pair of stations) after another.

    Parameters
    ----------
    data, seed, start
        As for every method (see `Methods`). Default of `start`: the empty decision.
    limits
        ``deterministic_s`` limits the work on all parts together (default: one deterministic
        second); ``iterations`` limits the number of re-optimisations; ``gap`` applies to each
        re-optimisation.
    candidates
        The pairs of pod and station, order and station, and robot and pod that may be used.
        Default: all.

    Returns
    -------
    The decision. Its bound is -inf if there is more than one part, or if candidates are given.

    Raises
    ------
    ModelError
        If the start is not feasible.
    """
    left = DEFAULT_WORK if limits.deterministic_s is None else limits.deterministic_s
    limits = replace(limits, deterministic_s=left)
    values = nothing(data) if start is None else start
    pairs = everything(data) if candidates is None else candidates
    groups = station_groups(data)
    if len(groups) <= 1:
        return cp_sat.solve(data, limits, seed=seed, start=start, candidates=candidates)
    began = time.perf_counter()
    broken = violations(data, values)
    require(not broken, "start", "; ".join(broken))
    small = compact(data, pairs.including(values))
    current = small.shrink(values)
    build_s, built, work, idle, turn = 0.0, 0.0, 0.0, 0, 0
    most = limits.iterations if limits.iterations is not None else len(groups) * 1000
    # Once every part has been tried since the last change, nothing more is to be found.
    while turn < most and left - work > 0 and idle < len(groups):
        stage = part(small.data, small.candidates, current, groups[turn % len(groups)])
        turn += 1
        idle += 1
        if stage is None:
            continue
        before = stage.start()
        if data.variant.many_stations and violations(stage.data, before):
            continue
        found = cp_sat.solve(
            stage.data,
            replace(limits, deterministic_s=left - work, iterations=None),
            seed=seed,
            start=before,
            candidates=stage.candidates,
        )
        work += found.work
        build_s += found.build_s
        built += found.built
        if found.objective < objective(stage.data, before):
            merged = stage.merge(found.required)
            if not data.variant.many_stations or not violations(small.data, merged):
                current, idle = merged, 0
    current = replace(current, pod_robot=assign_robots(small.data, current.pod_station))
    result = small.expand(current)
    return Solution(
        values=result,
        objective=objective(data, result),
        bound=float("-inf"),
        status=Status.FEASIBLE,
        backend="cp_sat",
        wall_s=time.perf_counter() - began,
        build_s=build_s,
        work=work,
        built=built,
    )


def station_groups(data: PileOn) -> list[Integers]:
    """Return the pairs of stations to decide together.

    The stations that have free slots or shortages are arranged in a ring, so that stations close to
    each other are neighbours. Every two neighbours in the ring form a pair. If there are only one
    or two such stations, these form a single group.

    Parameters
    ----------
    data
        The input.

    Returns
    -------
    The pairs, ordered so that the first half of the list (rounded up) contains every station.
    """
    stations = np.flatnonzero((data.slots > 0) | (data.shortage > 0).any(axis=1))
    if stations.size <= WIDTH:
        return [stations] if stations.size else []
    # Stations that the same pods are near to share orders and pods.
    order = stations[np.argsort(_position(data, stations), kind="stable")]
    starts = [*range(0, order.size, 2), *range(1, order.size, 2)]
    return [np.sort(np.take(order, [i, i + 1], mode="wrap")) for i in starts]


def _position(data: PileOn, stations: Integers) -> Integers:
    """Position of each station in a nearest-neighbour tour; near means similar travel of pods."""
    travel = data.travel[:, stations]
    tour = [0]
    while len(tour) < stations.size:
        apart = np.abs(travel - travel[:, tour[-1:]]).sum(axis=0)
        apart[tour] = np.inf
        tour.append(int(apart.argmin()))
    place = np.empty(stations.size, dtype=np.int64)
    place[tour] = np.arange(stations.size)
    return place
