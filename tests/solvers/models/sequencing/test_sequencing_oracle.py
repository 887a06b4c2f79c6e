"""Exact methods against a step-by-step shortest path; heuristics above it; bounds below."""

import numpy as np
import pytest
from sequencing_oracle import fewest_visits, tiny
from sequencing_sample import station

from rmfs.solvers.models import Limits, Status
from rmfs.solvers.models.sequencing import (
    Sequencing,
    VisitSequence,
    beam,
    cp_sat,
    dynamic,
    objective,
    violations,
)
from rmfs.solvers.models.sequencing.bounds import visits_bound


@pytest.mark.parametrize(("method", "cases"), [(dynamic, 400), (cp_sat, 150)])
def test_exact_methods_find_the_fewest_visits(method: object, cases: int) -> None:
    infeasible = 0
    for seed in range(cases):
        data = tiny(seed)
        best = fewest_visits(data)
        solution = method.solve(data)
        if np.isinf(best):
            infeasible += 1
            assert solution.status is Status.INFEASIBLE
            continue
        assert violations(data, solution.required) == [], seed
        assert solution.status is Status.OPTIMAL
        assert solution.objective == solution.bound == best, seed
    assert infeasible > 10


def test_heuristic_plans_are_feasible_and_bounded() -> None:
    met = []
    for seed in range(200):
        data = tiny(seed)
        best = fewest_visits(data)
        solution = beam.solve(data)
        if np.isinf(best):
            assert solution.status is Status.INFEASIBLE
            continue
        assert violations(data, solution.required) == [], seed
        assert solution.bound <= best <= solution.objective
        assert visits_bound(data) <= best
        met.append(solution.objective == best)
    assert np.mean(met) > 0.95


def test_exact_methods_agree_on_larger_stations() -> None:
    for seed in range(3):
        data = station(orders=7, pods=6, skus=10, capacity=2, seed=seed)
        one, other = dynamic.solve(data), cp_sat.solve(data)
        assert one.status is other.status is Status.OPTIMAL
        assert one.objective == other.objective <= beam.solve(data).objective


def test_plans_of_a_full_station_are_feasible_and_repeat() -> None:
    data = station(orders=30, pods=25, skus=40, capacity=6, seed=1)
    for method in (beam, cp_sat):
        runs = [method.solve(data, Limits(deterministic_s=0.2, iterations=100)) for _ in range(2)]
        assert violations(data, runs[0].required) == []
        assert np.array_equal(runs[0].required.pods, runs[1].required.pods)
        assert np.array_equal(runs[0].required.start, runs[1].required.start)
        assert runs[0].bound <= runs[0].objective


def test_a_start_is_never_lost() -> None:
    data = station(orders=12, pods=10, skus=20, capacity=3, seed=4)
    good = beam.solve(data).required
    for method in (beam, cp_sat):
        limits = Limits(deterministic_s=0.01, iterations=0)
        assert method.solve(data, limits, start=good).objective <= objective(data, good)
    limited = dynamic.solve(data, Limits(iterations=5), start=good)
    assert limited.status is Status.FEASIBLE
    assert limited.bound <= limited.objective == objective(data, good)
    assert dynamic.solve(data, Limits(iterations=5)).status is Status.LIMIT


def test_a_second_slot_saves_a_visit() -> None:
    # Both orders need both SKUs, each on its own pod: one slot needs 3 visits, two need 2.
    needs, holds = np.ones((2, 2)), np.eye(2)
    for capacity, visits in ((1, 3), (2, 2)):
        for method in (dynamic, cp_sat, beam):
            assert method.solve(Sequencing(needs, holds, capacity)).objective == visits


def test_returning_to_the_same_pod_at_once_is_one_visit() -> None:
    data = Sequencing(np.eye(2), np.ones((1, 2)), 1)
    plan = VisitSequence(np.array([0, 0]), np.array([0, 1]))
    assert violations(data, plan) == []
    assert objective(data, plan) == 1.0


def test_a_limit_that_comes_at_once_leaves_the_bound_of_the_covering() -> None:
    """CP-SAT may end before it has any bound of its own."""
    data = station(orders=12, pods=12, skus=12, capacity=3, seed=2)
    found = cp_sat.solve(data, Limits(deterministic_s=1e-9))
    assert 1.0 <= found.bound <= found.objective
