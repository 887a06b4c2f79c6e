"""Rack allocation: against every allocation there is, on hundreds of small cases."""

from __future__ import annotations

from itertools import product
from math import inf

import numpy as np
import pytest
from rack_allocation_sample import site

from rmfs.solvers.models import Limits, ModelError, Status
from rmfs.solvers.models.rack_allocation import (
    Allocation,
    RackAllocation,
    cp_sat,
    greedy,
    highs,
    objective,
    violations,
)

EXACT = {"cp_sat": cp_sat.solve, "highs": highs.solve}


def small_case(seed: int) -> RackAllocation:
    """Up to 4 orders, 4 pods, 3 SKUs and 2 stations; often without a solution."""
    rng = np.random.default_rng(seed)
    orders, pods, skus = (int(rng.integers(0, n + 1)) for n in (4, 4, 3))
    units = rng.integers(0, 3, (orders, skus)) * (rng.random((orders, skus)) < 0.6)
    stock = rng.integers(0, 4, (pods, skus)) * (rng.random((pods, skus)) < 0.7)
    slots = rng.integers(0, 3, int(rng.integers(0, 3)))
    return RackAllocation(units, stock, slots)


def fewest_pods(data: RackAllocation) -> float:
    """Try every station for every order and pod; the definition, word for word."""
    orders, pods, stations = data.sizes
    best = inf
    choices = range(-1, stations)
    by_orders = []
    for given in product(choices, repeat=orders):
        counts = [sum(s == station for s in given) for station in range(stations)]
        if counts == data.slots.tolist():
            by_orders.append(
                [
                    [
                        sum(data.units[o, k] for o in range(orders) if given[o] == s)
                        for s in range(stations)
                    ]
                    for k in range(data.units.shape[1])
                ]
            )
    for brought in product(choices, repeat=pods):
        used = sum(s >= 0 for s in brought)
        if used >= best:
            continue
        there = [
            [sum(data.stock[p, k] for p in range(pods) if brought[p] == s) for s in range(stations)]
            for k in range(data.units.shape[1])
        ]
        if any(
            all(
                a <= b
                for one, other in zip(asked, there, strict=True)
                for a, b in zip(one, other, strict=True)
            )
            for asked in by_orders
        ):
            best = used
    return best


@pytest.mark.parametrize("part", range(10))
def test_back_ends_find_the_fewest_pods(part: int) -> None:
    """300 cases: same value as by trying, same status; the rule is feasible and not better."""
    for seed in range(30 * part, 30 * part + 30):
        data = small_case(seed)
        best = fewest_pods(data)
        rule = greedy.solve(data)
        assert rule.bound <= best
        if rule.found:
            assert violations(data, rule.required) == []
            assert rule.objective >= best
        for solve in EXACT.values():
            found = solve(data, start=rule.values)
            if best == inf:
                assert found.status is Status.INFEASIBLE
                assert rule.status in (Status.INFEASIBLE, Status.LIMIT)
                continue
            assert found.status is Status.OPTIMAL
            assert violations(data, found.required) == []
            assert found.objective == objective(data, found.required) == best
            assert found.bound == pytest.approx(best, abs=1e-4)


def test_one_pod_for_two_orders() -> None:
    """By hand: pod 2 serves both orders at the one station; pods 0 and 1 would be two."""
    data = RackAllocation([[1, 0], [0, 1]], [[5, 0], [0, 5], [1, 1]], [2])
    for solve in (*EXACT.values(), greedy.solve):
        assert solve(data).required.pod_station.tolist() == [-1, -1, 0]


def test_one_pod_does_not_serve_two_stations() -> None:
    """By hand: two stations with an order each need two pods, though one holds everything."""
    data = RackAllocation([[1], [1]], [[9], [1]], [1, 1])
    for solve in EXACT.values():
        assert solve(data).objective == 2.0


@pytest.mark.parametrize("solve", [*EXACT.values(), greedy.solve])
def test_empty_and_degenerate(solve) -> None:
    """No stations, no slots, orders that ask for nothing, more slots than orders."""
    nothing = np.zeros((0, 2), np.int64)
    assert solve(RackAllocation(nothing, nothing, [])).objective == 0.0
    assert solve(RackAllocation([[1, 1]], nothing, [0])).objective == 0.0
    assert solve(RackAllocation([[0, 0]], nothing, [1])).objective == 0.0
    assert solve(RackAllocation([[1, 0]], [[1, 0]], [2])).status is Status.INFEASIBLE
    assert solve(RackAllocation([[2, 0]], [[1, 0]], [1])).status is Status.INFEASIBLE


@pytest.mark.parametrize("method", EXACT)
def test_stopped_at_once_it_states_no_finite_bound_if_there_is_no_allocation(method: str) -> None:
    """Nine orders of one unit each share eight units; the solver may not begin."""
    data = RackAllocation(np.ones((9, 1), int), [[4], [4]], [5, 4])
    ended = EXACT[method](data, Limits(deterministic_s=0.0, nodes=0))
    assert (ended.status, ended.bound) == (Status.INFEASIBLE, np.inf)


@pytest.mark.parametrize(
    ("field", "change"),
    [
        ("units", {"units": [[-1, 0]]}),
        ("units", {"units": [[0.5, 0]]}),
        ("stock", {"stock": [[1, 1, 1]]}),
        ("slots", {"slots": [-1]}),
        ("slots", {"slots": [[1]]}),
    ],
)
def test_wrong_input_names_the_field(field: str, change: dict[str, list]) -> None:
    right = {"units": [[1, 0]], "stock": [[1, 1]], "slots": [1]}
    with pytest.raises(ModelError, match=rf"^{field}\b"):
        RackAllocation(**(right | change))


def test_a_start_must_be_feasible() -> None:
    data = RackAllocation([[1]], [[1]], [1])
    with pytest.raises(ModelError, match="lacks units"):
        cp_sat.solve(data, start=Allocation(np.array([0]), np.array([-1])))


def test_medium_site_with_limits() -> None:
    """Under a limit the search begins with the rule, repeats itself, and is bounded from below."""
    data = site(30, 60, 60, 3, 4, seed=1)
    rule = greedy.solve(data)
    limits = Limits(deterministic_s=0.1)
    one, other = (cp_sat.solve(data, limits, start=rule.values) for _ in range(2))
    assert one.objective == other.objective <= rule.objective
    assert 3.0 <= one.bound <= one.objective
    assert one.work == other.work
    assert np.array_equal(one.required.pod_station, other.required.pod_station)
