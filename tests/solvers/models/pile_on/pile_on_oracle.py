"""Brute force for the pile-on models: every set of calls with every way to treat every order.

Written from the problem statement, on purpose in another way than the model: orders are options
with a demand, a number of slots and a gain, pods are stations, robots are permutations.
"""

from __future__ import annotations

from itertools import permutations, product

import numpy as np
from pile_on_sample import Size, snapshot

from rmfs.solvers.models.pile_on.data import PileOn
from rmfs.solvers.models.pile_on.variant import Variant, Weights


def tiny(seed: int, variant: Variant, *, fractions: bool = False) -> PileOn:
    """A random input of 1-2 stations, 0-3 orders, 1-4 pods, with all kinds of commitments."""
    rng = np.random.default_rng(seed)
    stations, pods, skus = int(rng.integers(1, 3)), int(rng.integers(1, 5)), 3
    orders = int(rng.integers(0, 4))
    lines = []
    for order in range(orders):
        for sku in sorted(rng.permutation(skus)[: rng.integers(1, 3)]):
            lines.append((order, sku, rng.integers(1, 4)))
    table = np.array(lines, dtype=np.int64).reshape(-1, 3)
    inbound = np.where(rng.random(pods) < 0.25, rng.integers(0, stations, pods), -1)
    robots = int(rng.integers(0, 4))
    bound = np.full(robots, -1)
    if robots and rng.random() < 0.5:
        bound[0] = rng.integers(0, pods)
    step = 0.125 if fractions else 1.0
    fetch = rng.integers(0, 20, (robots, pods)) * step if rng.random() < 0.6 else None
    return PileOn(
        slots=rng.integers(0, 3, stations),
        line_order=table[:, 0],
        line_sku=table[:, 1],
        line_units=table[:, 2],
        stock=rng.integers(0, 4, (pods, skus)) * (rng.random((pods, skus)) < 0.6),
        travel=rng.integers(0, 30, (pods, stations)) * step,
        available=(inbound < 0) & (rng.random(pods) < 0.9),
        inbound=inbound,
        open_units=rng.integers(0, 3, (stations, skus)) * (rng.random((stations, skus)) < 0.2),
        fetch=fetch,
        robot_pod=None if fetch is None else bound,
        worth=rng.integers(0, 30, orders) if rng.random() < 0.3 else None,
        variant=variant,
        weights=Weights(
            visit=float(rng.integers(0, 10)),
            empty_slot=float(rng.choice([5, 50, 1000])),
            complete=float(rng.choice([0, 15, 40])),
            prospects=bool(rng.random() < 0.6),
            open_unit=float(rng.choice([10, 200])),
            open_line=float(rng.choice([5, 100])),
            line=float(rng.choice([0, 10])),
            part=float(rng.choice([0, 20, 100])),
            unit=float(rng.choice([0, 0, 7])),
        ),
    )


def order_options(
    data: PileOn, order: int, *, as_printed: bool = False
) -> list[tuple[np.ndarray, np.ndarray, np.ndarray, float]]:
    """All ways to treat an order: (units taken (S, K), SKUs served (S, K), slots (S,), cost)."""
    weights, variant = data.weights, data.variant
    lines = np.flatnonzero(data.line_order == order)
    reward = weights.complete + weights.unit * float(data.line_units[lines].sum())
    shape = (data.stations, data.skus)
    zero = np.zeros(shape, dtype=np.int64)
    options = [(zero, zero > 0, np.zeros(data.stations, dtype=np.int64), 0.0)]
    if weights.prospects:
        for station in np.flatnonzero((data.slots > 0) | as_printed):
            taken = zero.copy()
            np.add.at(taken[station], data.line_sku[lines], data.line_units[lines])
            options.append((taken, zero > 0, options[0][2], -reward))
    seen = set()
    for where in product(range(-1, data.stations), repeat=lines.size):
        for own in range(data.stations):
            used = {station for station in where if station >= 0}
            if variant in (Variant.WHOLE, Variant.LATER, Variant.SPLIT_TIME):
                if not used <= {own}:
                    continue
                used = {own}
            everything = -1 not in where
            if variant in (Variant.WHOLE, Variant.SPLIT_STATIONS) and not everything:
                continue
            if variant is not Variant.LATER and set(where) == {-1}:
                continue
            if (where, frozenset(used)) in seen:
                continue
            seen.add((where, frozenset(used)))
            taken, slots = zero.copy(), np.zeros(data.stations, dtype=np.int64)
            for line, station in zip(lines, where, strict=True):
                if station >= 0:
                    taken[station, data.line_sku[line]] += data.line_units[line]
            slots[sorted(used)] = 1
            covered = sum(station >= 0 for station in where)
            cost = -weights.empty_slot * len(used) - weights.line * covered
            cost -= reward * everything
            cost -= 0.0 if data.worth is None else data.worth[order]
            cost += weights.part * (len(used) - 1)
            if variant is Variant.LATER:
                cost += weights.open_line * (lines.size - covered)
            options.append((taken, taken > 0, slots, float(cost)))
    return options


def combined_orders(
    data: PileOn, *, as_printed: bool = False
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """All combinations of the options of all orders, as arrays with a leading axis."""
    taken = np.zeros((1, data.stations, data.skus), dtype=np.int64)
    served = np.zeros((1, data.stations, data.skus), dtype=bool)
    slots = np.zeros((1, data.stations), dtype=np.int64)
    cost = np.zeros(1)
    for order in range(data.orders):
        options = order_options(data, order, as_printed=as_printed)
        t, v, n, c = (np.stack(part) for part in zip(*options, strict=True))
        taken = (taken[:, None] + t).reshape(-1, *taken.shape[1:])
        served = (served[:, None] | v).reshape(-1, *served.shape[1:])
        slots = (slots[:, None] + n).reshape(-1, data.stations)
        cost = (cost[:, None] + c).ravel()
        fits = (slots <= data.slots).all(axis=1)
        taken, served, slots, cost = taken[fits], served[fits], slots[fits], cost[fits]
    return taken, served, slots, cost


def robot_cost(data: PileOn, called: list[int]) -> float:
    """Least cost of sending robots to the called pods; inf if there are too few."""
    if data.fetch is None:
        return 0.0
    bound = set() if data.robot_pod is None else set(data.robot_pod.tolist())
    pods = [pod for pod in called if pod not in bound]
    free = [r for r in range(data.robots) if data.robot_pod is None or data.robot_pod[r] < 0]
    return min(
        (
            sum(data.weights.travel * data.fetch[r, p] for r, p in zip(chosen, pods, strict=True))
            for chosen in permutations(free, len(pods))
        ),
        default=np.inf,
    )


def optimum(data: PileOn, *, as_printed: bool = False) -> float:
    """The least objective over all decisions; as printed, stations without slots have prospects."""
    weights = data.weights
    taken, served, _, cost = combined_orders(data, as_printed=as_printed)
    coming = np.zeros((data.stations, data.skus), dtype=np.int64)
    for pod in range(data.pods):
        if data.inbound[pod] >= 0:
            coming[data.inbound[pod]] += data.stock[pod]
    lacking = np.maximum(data.open_units - coming, 0)
    spare = np.maximum(coming - data.open_units, 0)
    best = np.inf
    choices = [range(-1, data.stations) if ok else (-1,) for ok in data.available]
    for where in product(*choices):
        called = [pod for pod, station in enumerate(where) if station >= 0]
        price = robot_cost(data, called) + sum(
            weights.visit + weights.travel * data.travel[pod, where[pod]] for pod in called
        )
        if np.isinf(price):
            continue
        supply = spare.copy()
        useful = np.ones(cost.size, dtype=bool)
        for pod in called:
            station = where[pod]
            supply[station] += data.stock[pod]
            held = data.stock[pod] > 0
            if not (held & (lacking[station] > 0)).any():
                useful &= (served[:, station] & held).any(axis=1)
        allowed = useful & (taken <= supply).all(axis=(1, 2))
        left_open = np.maximum(lacking + taken - supply, 0).sum(axis=(1, 2))
        total = cost + weights.open_unit * left_open
        best = min(best, price + total[allowed].min(initial=np.inf))
    return float(best + weights.empty_slot * data.slots.sum())


def small_site(seed: int, variant: Variant = Variant.WHOLE, **weights: float) -> PileOn:
    """A site too big for brute force, small enough to be solved to optimality in a moment."""
    size = Size(stations=3, slots=2, pods=25, skus=20, orders=15, robots=6, skus_per_pod=4)
    return snapshot(size, seed, variant=variant, weights=Weights(**weights))
