"""The heuristic HADGS: alternates between orders and pods (Jiao et al. 2025, section 3).

For each station in turn, two steps alternate until no call is useful:

1. Place the orders that the pods of the station already cover, as long as slots are free (step OA
   of the paper).
2. Call the pod p that minimises (steps PS and TA)

       K(p) = -complete * (orders that p would complete) + travel * (d_rp + d_ps)     (eq. 23)

   where d_rp is the distance from the nearest robot r to the pod, and d_ps the distance from the
   pod to the station.

If no single pod completes an order (or eases a shortage), `SETS` sets of pods are sampled, each
covering a random order. The best set is improved by `SEARCHES` local searches, each of which
exchanges one pod. `SETS` and `SEARCHES` are the paper's l1 = 10 and l2 = 3.

The paper leaves some details open. Here, stations are processed in ascending order of the total
travel of their inbound pods, and orders are placed by decreasing `worth` and, if equal, by
increasing units. The paper considers neither the weights `unit` and `visit` nor shortages (units
that earlier orders of a station still lack). Here, K includes these two weights, and each unit of
shortage that a single pod eases lowers K by `open_unit`.
"""

from __future__ import annotations

import time

import numpy as np

from rmfs.solvers.models.pile_on.candidates import Candidates, everything
from rmfs.solvers.models.pile_on.columns import every
from rmfs.solvers.models.pile_on.data import Floats, Integers, PileOn
from rmfs.solvers.models.pile_on.leftovers import cover_rest
from rmfs.solvers.models.pile_on.partial_assignment import (
    Call,
    PartialAssignment,
    decision,
    drop_idle,
)
from rmfs.solvers.models.pile_on.values import Assignment, objective
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, solution_of_rule

SETS = 10
"""Number of pod sets sampled if no single pod completes an order (l1 in the paper)."""

SEARCHES = 3
"""Number of local searches on the best set (l2 in the paper)."""


def solve(
    data: PileOn,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Assignment | None = None,
    candidates: Candidates | None = None,
) -> Solution[Assignment]:
    """Solve a pile-on model by the heuristic HADGS; `iterations` limits the number of pod calls.

    Parameters
    ----------
    data, limits, seed, start
        As for every method (see `Methods`); `start` is not used.
    candidates
        The pairs of pod and station, order and station, and robot and pod that may be used.
        Default: all.

    Returns
    -------
    A feasible decision without a bound.
    """
    began = time.perf_counter()
    partial = PartialAssignment(data, candidates or everything(data))
    rng = np.random.default_rng(seed)
    calls = 0
    for station in _stations(data):
        partial.fill(station)
        while limits.iterations is None or calls < limits.iterations:
            call = _next_call(partial, station, rng)
            if call is None:
                break
            partial.call(call)
            partial.fill(station)
            calls += 1
    drop_idle(partial)
    for station in range(data.stations):
        partial.reserve(station)
    values = cover_rest(data, decision(partial))
    return solution_of_rule(
        values,
        lambda values: objective(data, values),
        bound=float("-inf"),
        work=float(partial.scored),
        began=began,
        built=partial.built,
    )


def _stations(data: PileOn) -> list[int]:
    """Return the stations in ascending order of total travel of their inbound pods, then index."""
    pods = np.flatnonzero(data.inbound >= 0)
    coming = data.travel[pods, data.inbound[pods]]
    total = np.bincount(data.inbound[pods], coming, minlength=data.stations)
    order: list[int] = np.argsort(total, kind="stable").tolist()
    return order


def _next_call(partial: PartialAssignment, station: int, rng: np.random.Generator) -> Call | None:
    """The pod of least K that completes an order or eases a shortage; else a sampled set."""
    weights = partial.data.weights
    pods = partial.free_pods(station)
    if not pods.size:
        return None
    eased = partial.easing(pods, station)
    done = units = np.zeros(pods.size)
    if partial.slots[station]:
        done, units = partial.completions(pods, station)
    gain = weights.complete * done + weights.unit * units + weights.open_unit * eased
    k = partial.call_costs(pods, station) - gain
    k[(done == 0) & (eased == 0)] = np.inf
    best = int(k.argmin())
    if np.isfinite(k[best]):
        return Call(float(-k[best]), station, (int(pods[best]),))
    return _sampled_set(partial, station, pods, rng) if partial.slots[station] else None


def _sampled_set(
    partial: PartialAssignment, station: int, pods: Integers, rng: np.random.Generator
) -> Call | None:
    """Sample pod sets that each cover a random open order, and improve the best by exchanges."""
    data = partial.data
    need = data.line_units - partial.stock_left[station, data.line_sku]
    enough = data.stock[np.ix_(pods, data.line_sku)] >= need
    can = every(enough.any(axis=0) | (need <= 0), data) & partial.open_orders
    orders = np.flatnonzero(can & partial.candidates.places[:, station])
    if not orders.size:
        return None
    cost = partial.call_costs(pods, station)
    best: tuple[float, Integers, Integers] | None = None
    for _ in range(SETS):
        order = int(orders[rng.integers(orders.size)])
        own = np.arange(data.first_line[order], data.first_line[order + 1])
        missing = own[need[own] > 0]
        chosen = np.array([_draw(np.flatnonzero(enough[:, line]), rng) for line in missing])
        best = _better(best, (_k(partial, station, pods, cost, chosen), chosen, missing))
    for _ in range(SEARCHES if best is not None else 0):
        assert best is not None
        _, chosen, missing = best
        swapped = chosen.copy()
        at = int(rng.integers(missing.size))
        swapped[at] = _draw(np.flatnonzero(enough[:, missing[at]]), rng)
        best = _better(best, (_k(partial, station, pods, cost, swapped), swapped, missing))
    if best is None or not np.isfinite(best[0]):
        return None
    return Call(-best[0], station, tuple(pods[np.unique(best[1])].tolist()))


def _k(
    partial: PartialAssignment, station: int, pods: Integers, cost: Floats, chosen: Integers
) -> float:
    """K of a set of pods; inf if there are not enough free robots for it."""
    data = partial.data
    members = np.unique(chosen)
    if data.fetch is not None and data.needs_robot[pods[members]].sum() > partial.robots.size:
        return float("inf")
    left = partial.stock_left[station] + data.stock[pods[members]].sum(axis=0)
    done = every(left[data.line_sku] >= data.line_units, data) & partial.open_orders
    partial.scored += data.orders
    return float(cost[members].sum() - data.reward[done].sum())


def _better(
    one: tuple[float, Integers, Integers] | None, other: tuple[float, Integers, Integers]
) -> tuple[float, Integers, Integers]:
    """The set of smaller K; the earlier one if equal."""
    return other if one is None or other[0] < one[0] else one


def _draw(items: Integers, rng: np.random.Generator) -> int:
    """One of the items, all equally likely."""
    return int(items[rng.integers(items.size)])
