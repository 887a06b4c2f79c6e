"""Batch placement: against enumeration and networkx on random small cases, both back ends."""

from itertools import permutations
from math import inf, isinf

import networkx as nx
import numpy as np
import pytest

from rmfs.solvers.models import ModelError, Status
from rmfs.solvers.models.storage.placement import (
    Placement,
    expected_visits,
    greedy,
    objective,
    solve,
    violations,
)

SOLVERS = ("assignment", "flow")


def random_placement(seed: int) -> Placement:
    rng = np.random.default_rng(seed)
    pods, places = int(rng.integers(0, 5)), int(rng.integers(0, 6))
    travel = rng.uniform(0, 100, (pods, places))
    travel[rng.random((pods, places)) < 0.3] = inf
    return Placement(travel, rng.uniform(0, 60, places), rng.gamma(1.0, 1.0, pods))


def enumerated(data: Placement) -> float:
    """Least cost over all injective placements; inf if none is allowed."""
    pods, places = data.travel_s.shape
    return min(
        (float(data.cost_s[range(pods), list(p)].sum()) for p in permutations(range(places), pods)),
        default=inf,
    )


@pytest.mark.parametrize("solver", SOLVERS)
def test_the_placement_is_the_enumerated_optimum_and_the_bound_proves_it(solver: str) -> None:
    infeasible = 0
    for seed in range(300):
        data = random_placement(seed)
        best = enumerated(data)
        solution = solve(data, solver)
        if isinf(best):
            infeasible += 1
            assert solution.status is Status.INFEASIBLE
            assert not solution.found
            continue
        assert solution.status is Status.OPTIMAL
        assert not violations(data, solution.required)
        assert solution.objective == objective(data, solution.required)
        assert solution.objective == pytest.approx(best, abs=1e-5)
        assert best - 1e-5 <= solution.bound <= best + 1e-9
    assert 50 < infeasible < 250


def test_back_ends_agree_with_networkx_on_larger_cases() -> None:
    for seed in range(5):
        rng = np.random.default_rng(seed)
        data = Placement(rng.uniform(0, 90, (12, 30)), rng.uniform(0, 60, 30), rng.gamma(1, 1, 12))
        graph = nx.Graph()
        for pod, row in enumerate(data.cost_s):
            graph.add_weighted_edges_from((pod, 100 + place, c) for place, c in enumerate(row))
        mate = nx.bipartite.minimum_weight_full_matching(graph, top_nodes=range(12))
        best = sum(data.cost_s[pod, mate[pod] - 100] for pod in range(12))
        for solver in SOLVERS:
            solution = solve(data, solver)
            assert solution.objective == pytest.approx(best, abs=1e-4)
            assert solution.gap < 1e-6


def test_the_greedy_rule_is_feasible_and_between_its_bound_and_the_optimum() -> None:
    found = 0
    for seed in range(200):
        data = random_placement(seed)
        best, rule = enumerated(data), greedy.solve(data)
        if rule.found:
            found += 1
            assert not violations(data, rule.required)
            assert rule.bound - 1e-9 <= best <= rule.objective + 1e-9
        else:
            assert rule.status is not Status.INFEASIBLE or isinf(best)
    assert found > 50


def test_a_pod_that_is_wanted_soon_gets_the_near_place() -> None:
    data = Placement([[10.0, 12.0], [10.0, 12.0]], [5.0, 50.0], [0.1, 3.0])
    assert solve(data).required.tolist() == [1, 0]
    assert greedy.solve(data).required.tolist() == [1, 0]
    # without visits only today's travel counts: ties go to the lowest index
    assert greedy.solve(Placement(data.travel_s, data.access_s, [0.0, 0.0])).required[0] == 0


def test_no_pods_is_an_empty_placement() -> None:
    empty = Placement(np.zeros((0, 3)), np.zeros(3), [])
    for solution in (solve(empty), solve(empty, "flow"), greedy.solve(empty)):
        assert solution.required.shape == (0,)
        assert solution.objective == solution.bound == 0.0


def test_invalid_input_is_refused_by_field() -> None:
    with pytest.raises(ModelError, match="travel_s"):
        Placement([[-1.0]], [1.0], [1.0])
    with pytest.raises(ModelError, match="travel_s"):
        Placement([[np.nan]], [1.0], [1.0])
    with pytest.raises(ModelError, match="access_s"):
        Placement([[1.0]], [1.0, 2.0], [1.0])
    with pytest.raises(ModelError, match="visits"):
        Placement([[1.0]], [1.0], [-1.0])


def test_violations_name_what_is_wrong() -> None:
    data = Placement([[1.0, inf], [1.0, 1.0]], [0.0, 0.0], [0.0, 0.0])
    assert violations(data, np.array([0, 0])) == ["two pods are put at one location"]
    assert violations(data, np.array([1, 0])) == ["a pod is put at a location that is not allowed"]
    assert violations(data, np.array([0, 2])) == ["place must have a location for each pod"]
    assert violations(data, np.array([0, 1])) == []


def test_expected_visits_share_demand_by_stock() -> None:
    stock = [[6, 2], [0, 5]]
    # SKU 0: 4 units wanted of 8, SKU 1: 10 wanted of 5, so all of it
    visits = expected_visits(stock, [2, 0], [1.0, 5.0], horizon_h=2.0, pile_on=2.0)
    assert visits == pytest.approx([6 * 0.5 / 2, (2 * 0.5 + 5) / 2])
    only = expected_visits(stock, [2, 0], [1.0, 5.0], horizon_h=2.0, pile_on=2.0, pods=[1])
    assert only == pytest.approx(visits[1:])
    assert expected_visits([[0]], [9], [1.0], horizon_h=1.0, pile_on=1.0) == pytest.approx([0.0])
    with pytest.raises(ModelError, match="pile_on"):
        expected_visits(stock, [0, 0], [1.0, 1.0], horizon_h=1.0, pile_on=0.0)
