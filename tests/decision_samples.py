"""Small random questions of every family, as files have them."""

from __future__ import annotations

import numpy as np
import pile_on_sample
from planning_sample import planning
from rack_allocation_sample import site
from sequencing_sample import station

from rmfs.solvers.decisions.files import Decision
from rmfs.solvers.decisions.models import plain_data
from rmfs.solvers.models.charging import AWAY, Charging
from rmfs.solvers.models.pile_on import Variant, Weights
from rmfs.solvers.models.replenishment import Replenishment
from rmfs.solvers.models.run_bound import Orders, PickStations, Refill, RunBound, Stock
from rmfs.solvers.models.storage.placement import Placement
from rmfs.solvers.models.storage.stays import Stays
from rmfs.solvers.models.storage.zones import Zones
from rmfs.solvers.models.tasks.balance import Balance
from rmfs.solvers.models.tasks.matching import Matching
from rmfs.solvers.models.tasks.sequence import TaskSequence


def sample(family: str, seed: int) -> Decision:
    """Draw a question that has an answer."""
    return Decision(family, plain_data(family, _DRAWS[family](seed)))


def _rng(seed: int) -> np.random.Generator:
    return np.random.default_rng([seed, 18])


def _forbidding(rng: np.random.Generator, cost: np.ndarray, share: float = 0.15) -> np.ndarray:
    return np.where(rng.random(cost.shape) < share, np.inf, cost)


def _pile_on(seed: int) -> object:
    variant = list(Variant)[seed % 5]
    robots = 0 if seed % 3 else 2
    size = pile_on_sample.Size(2, 1, 5, 4, 3, robots=robots, inbound=seed % 2, skus_per_pod=2)
    weights = Weights(visit=1.5, unit=0.25, line=0.5) if seed % 2 else Weights(prospects=False)
    return pile_on_sample.snapshot(size, seed, variant=variant, weights=weights)


def _planning(seed: int) -> object:
    return planning(stations=2, slots=2, orders=3, pods=4, skus=2, visits=2, seed=seed)


def _sequencing(seed: int) -> object:
    return station(orders=3, pods=3, skus=4, capacity=2, seed=seed)


def _rack_allocation(seed: int) -> object:
    return site(orders=4, pods=5, skus=4, stations=2, slots=1, seed=seed)


def _placement(seed: int) -> object:
    rng = _rng(seed)
    travel_s = rng.uniform(1.0, 60.0, (3, 5))
    travel_s[:, :2] = _forbidding(rng, travel_s[:, :2])
    return Placement(travel_s, rng.uniform(0.0, 50.0, 5), rng.uniform(0.0, 3.0, 3))


def _stays(seed: int) -> object:
    rng = _rng(seed)
    begin_s = rng.integers(0, 20, 4).astype(float)
    zones = 3 - seed % 2
    cost_s = rng.uniform(1.0, 60.0, (4, zones))
    cost_s[:, :-1] = _forbidding(rng, cost_s[:, :-1])
    end_s = begin_s + rng.integers(1, 12, 4)
    return Stays(begin_s, end_s, cost_s, np.array([1, 2, 4])[-zones:])


def _charging(seed: int) -> object:
    rng = _rng(seed)
    robots, groups, slots, swaps = 3, 1 + seed % 2, 4, seed % 3 == 1
    here = np.full(robots, AWAY)
    here[0] = AWAY if swaps else 0
    way_s = rng.uniform(5.0, 60.0, (robots, groups))
    way_s[:, 1:] = _forbidding(rng, way_s[:, 1:])
    return Charging(
        level=rng.uniform(0.1, 0.9, robots),
        drain=rng.uniform(0.0, 0.1, robots),
        ready=rng.integers(0, 3, robots),
        waits=np.array([False, seed % 4 == 1, False]),
        here=here,
        way_s=way_s,
        places=rng.integers(1, 3, (groups, slots)),
        gain=np.where(np.arange(groups) < swaps, 0.0, rng.uniform(0.1, 0.4, groups)),
        swapped=np.where(np.arange(groups) < swaps, 0.9, 0.0),
        wanted=rng.integers(0, robots + 1, (2, slots)),
        slot_s=60.0,
        worth_s=rng.uniform(200.0, 900.0),
        longest=2 + seed % 2,
        taper_from=1.0 if seed % 5 == 0 else 0.7,
        idle=0.25 * (seed % 2),
        short_s=2000.0,
    )


def _zones(seed: int) -> object:
    rng = _rng(seed)
    pods = rng.integers(1, 9, 3).astype(float)
    return Zones(
        rng.uniform(10.0, 90.0, (3, 2)),
        rng.uniform(0.1, 4.0, 3),
        pods,
        np.array([pods.sum() / 2 + 1, pods.sum() / 2]),
        rng.uniform(0.0, 0.2, 2),
    )


def _matching(seed: int) -> object:
    rng = _rng(seed)
    return Matching(_forbidding(rng, rng.uniform(1.0, 90.0, (3, 4))), rng.uniform(20.0, 80.0, 4))


def _balance(seed: int) -> object:
    rng = _rng(seed)
    return Balance(
        _forbidding(rng, rng.uniform(1.0, 90.0, (3, 4))),
        rng.uniform(20.0, 200.0, 4),
        np.array([np.inf, 10.0, -5.0, 40.0]),
        np.array([0, 0, 1, 1]),
        rng.integers(0, 3, 2),
        rng.uniform(0.0, 30.0, 2),
        np.array([1, 2]),
        0.5,
    )


def _sequence(seed: int) -> object:
    rng = _rng(seed)
    robots, tasks, places = 2, 2, 4

    def ways(*shape: int) -> np.ndarray:
        return rng.uniform(1.0, 60.0, shape)

    return TaskSequence(
        ready_s=ways(robots),
        carrying=np.array([seed % 2, 0]),
        reach_s=_forbidding(rng, ways(robots, tasks)),
        stow_s=ways(robots, places),
        fetch_s=_forbidding(rng, ways(places, tasks)),
        bring_s=ways(tasks),
        service_s=ways(tasks),
        store_s=ways(tasks, places),
        earliest_s=ways(tasks) / 2,
        latest_s=np.array([np.inf, 400.0]),
        due_s=np.array([60.0, np.inf]),
        skip_s=100.0 + ways(tasks),
        late_weight=2,
    )


def _replenishment(seed: int) -> object:
    rng = _rng(seed)
    worth_s = rng.uniform(0.0, 90.0, (3, 3))
    return Replenishment(
        -_forbidding(rng, -worth_s),
        rng.uniform(0.0, 40.0, 3),
        rng.uniform(1.0, 4.0, 3),
        rng.uniform(2.0, 8.0, 3),
        rng.uniform(5.0, 60.0, (3, 2)),
        rng.uniform(3.0, 9.0, 2),
    )


def _run_bound(seed: int) -> object:
    rng = _rng(seed)

    def some(low: float, high: float) -> np.ndarray:
        return rng.uniform(low, high, 2)

    picking = PickStations(some(5, 9), some(3, 6), some(0, 9), some(10, 40), some(10, 40), [6, 4])
    refill = Refill(some(10, 30), some(10, 40), some(10, 40), 8, 3)
    stock = Stock(rng.integers(0, 60, 30), 60)
    orders = Orders(units=rng.uniform(200, 900), largest_order_units=4, lone_units=100)
    if seed % 2:
        orders = Orders()
    return RunBound(3600.0, 2 + seed % 6, picking, refill, stock, orders)


_DRAWS = {
    "pile_on": _pile_on,
    "planning": _planning,
    "sequencing": _sequencing,
    "rack_allocation": _rack_allocation,
    "placement": _placement,
    "stays": _stays,
    "zones": _zones,
    "charging": _charging,
    "matching": _matching,
    "balance": _balance,
    "sequence": _sequence,
    "replenishment": _replenishment,
    "run_bound": _run_bound,
}
