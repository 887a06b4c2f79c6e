"""The steady state: against piecewise-linear programmes, its prices, and the rule they give."""

from itertools import product
from math import inf

import networkx as nx
import numpy as np
import pytest
from scipy.optimize import linprog

from rmfs.solvers.models import Limits, ModelError, Status
from rmfs.solvers.models.storage.zones import (
    Prices,
    ZonePlan,
    Zones,
    greedy,
    objective,
    place_values,
    price_bound,
    solve,
    violations,
)
from rmfs.solvers.models.storage.zones.prices import expected_stay_h
from rmfs.solvers.models.storage.zones.repair import repaired

SHAPES = list(product((1, 2, 4), (1, 2, 5)))
"""Few shapes, as each is compiled once."""


def random_zones(seed: int, *, congested: bool = True) -> Zones:
    rng = np.random.default_rng(seed)
    classes, zones = SHAPES[seed % len(SHAPES)]
    pods = rng.integers(0, 9, classes)
    spare = rng.integers(0, 4)
    places = rng.multinomial(pods.sum() + spare, np.full(zones, 1 / zones))
    return Zones(
        rng.uniform(20, 90, (classes, zones)),
        np.where(rng.random(classes) < 0.1, 0.0, rng.gamma(1, 3, classes)),
        pods,
        places,
        rng.uniform(0, 1, zones) * (rng.random(zones) < 0.8) * congested,
    )


def cutting_planes(data: Zones) -> float:
    """Least robot time by tangents of the congestion cost, added where they are needed (Kelley)."""
    classes, zones = data.visit_s.shape
    n = classes * zones
    rows = np.kron(np.eye(classes), np.ones(zones))
    columns = np.kron(np.ones(classes), np.eye(zones))
    flow = np.hstack([rate * np.eye(zones) for rate in data.rate_per_h] or [np.zeros((zones, 0))])
    cost = np.concatenate([(data.rate_per_h[:, None] * data.visit_s).ravel(), np.ones(zones)])
    fit = np.hstack([columns, np.zeros((zones, zones))])
    tangents, sides = [fit], [data.places]
    best = inf
    for _ in range(60):
        result = linprog(
            cost,
            A_ub=np.vstack(tangents),
            b_ub=np.concatenate(sides),
            A_eq=np.hstack([rows, np.zeros((classes, zones))]),
            b_eq=data.pods,
        )
        assert result.success
        x, waiting = result.x[:n], result.x[n:]
        traffic = flow @ x
        exact = data.congestion_s_h * traffic**2
        best = min(best, float(cost[:n] @ x + exact.sum()))
        if (exact - waiting).sum() <= 1e-7 * max(1.0, best):
            return best
        slope = 2 * data.congestion_s_h * traffic
        tangents.append(np.hstack([slope[:, None] * flow, -np.eye(zones)]))
        sides.append(slope * traffic - exact)
    return best


def test_the_plan_is_optimal_and_its_prices_prove_it() -> None:
    for seed in range(100):
        data = random_zones(seed)
        solution = solve(data)
        assert solution.status is Status.OPTIMAL
        assert not violations(data, solution.required)
        assert solution.objective == objective(data, solution.required)
        assert solution.objective - solution.bound <= 1e-6 * max(1.0, solution.objective)
        best = cutting_planes(data)
        assert solution.objective == pytest.approx(best, rel=2e-5, abs=1e-4)
        assert solution.bound <= best * (1 + 1e-6) + 1e-6


def test_without_congestion_it_is_the_transportation_problem() -> None:
    for seed in range(45):
        data = random_zones(seed, congested=False)
        classes, zones = data.visit_s.shape
        graph = nx.DiGraph()
        whole = np.rint(data.rate_per_h[:, None] * data.visit_s * 1e6).astype(int)
        graph.add_node("end", demand=int(data.pods.sum()))
        for i in range(classes):
            graph.add_node(("class", i), demand=-int(data.pods[i]))
            for j in range(zones):
                graph.add_edge(("class", i), ("zone", j), weight=int(whole[i, j]))
        for j in range(zones):
            graph.add_edge(("zone", j), "end", capacity=int(data.places[j]))
        best = nx.min_cost_flow_cost(graph) / 1e6
        assert solve(data).objective == pytest.approx(best, rel=1e-5, abs=1e-3)


def test_the_bound_holds_for_any_prices_and_any_plan() -> None:
    for seed in range(60):
        data = random_zones(seed)
        best = solve(data).objective
        rng = np.random.default_rng(seed)
        for _ in range(5):
            any_plan = ZonePlan(
                rng.uniform(0, 9, data.visit_s.shape), rng.uniform(-5, 90, len(data.places))
            )
            assert price_bound(data, any_plan) <= best + 1e-6 * max(1.0, best)


def test_the_rule_and_the_bound_enclose_the_optimum() -> None:
    for seed in range(100):
        data = random_zones(seed)
        rule, best = greedy.solve(data), solve(data)
        assert not violations(data, rule.required)
        assert rule.bound <= best.objective + 1e-6
        assert rule.objective >= best.bound - 1e-6


def test_places_of_the_plan_are_rated_zero_and_no_place_is_rated_below() -> None:
    """Complementary slackness, said in the words of the online rule."""
    for seed in range(60):
        data = random_zones(seed)
        if not data.pods.all() or not data.rate_per_h.all():
            continue
        plan = solve(data).required
        prices = Prices.of(data, plan)
        classes, zones = data.visit_s.shape
        stay_h = 1.0 / data.rate_per_h
        values = place_values(
            prices,
            data.visit_s,
            zone=np.arange(zones),
            pod_class=np.arange(classes),
            stay_h=stay_h,
        )
        scale = 1e-4 * (1.0 + np.abs(stay_h * prices.worth_per_h)[:, None])
        assert (values >= -scale).all()
        used = plan.standing > 1e-2 * data.pods[:, None]
        assert (np.abs(values)[used] <= 100 * np.broadcast_to(scale, used.shape)[used]).all()


def test_the_rule_keeps_good_places_for_pods_that_come_back_soon() -> None:
    data = Zones([[20.0, 80.0], [20.0, 80.0]], [6.0, 0.5], [10, 30], [10, 40], [0.0, 0.0])
    plan = solve(data).required
    assert plan.standing == pytest.approx(np.array([[10.0, 0.0], [0.0, 30.0]]), abs=1e-3)
    prices = Prices.of(data, plan)
    values = place_values(
        prices,
        np.array([[20.0, 80.0], [20.0, 80.0]]),
        zone=np.array([0, 1]),
        pod_class=np.array([0, 1]),
        stay_h=expected_stay_h(data.rate_per_h, longest_h=10.0),
    )
    assert values.argmin(axis=1).tolist() == [0, 1]


def test_stays_are_limited_for_pods_that_are_never_visited() -> None:
    assert expected_stay_h(np.array([4.0, 0.0]), longest_h=2.0) == pytest.approx([0.25, 2.0])


def test_a_new_solve_of_the_same_size_forgets_the_last_one() -> None:
    first, other = random_zones(8), random_zones(17)
    assert first.visit_s.shape == other.visit_s.shape
    before = solve(first)
    solve(other)
    again = solve(first)
    assert np.array_equal(before.required.standing, again.required.standing)
    assert (before.objective, before.bound, before.work) == (
        again.objective,
        again.bound,
        again.work,
    )
    assert again.build_s < 0.05


def test_stopped_early_it_still_gives_a_feasible_plan_and_a_bound() -> None:
    data = random_zones(8)
    best = solve(data).objective
    for iterations in (1, 3):
        stopped = solve(data, limits=Limits(iterations=iterations))
        assert not violations(data, stopped.required)
        assert stopped.bound <= best + 1e-6 <= stopped.objective + 2e-6


def test_a_repaired_table_is_feasible_for_fractions_of_places_and_full_zones() -> None:
    """If the solver fails, its table is zero; if a zone has no places, all its pods move."""
    few = Zones([[1.0, 2.0]], [1.0], [0.5], [0.3, 0.4], [0.0, 0.0])
    assert not violations(few, ZonePlan(repaired(few, np.zeros((1, 2))), np.zeros(2)))
    rng = np.random.default_rng(1)
    for _ in range(100):
        pods = rng.random(3)
        places = pods.sum() * np.array([0.0, 0.4, 1.0])
        full = Zones(np.ones((3, 3)), np.ones(3), pods, places, np.zeros(3))
        crowded = [1.0, 0.05, 0.05] * rng.random((3, 3))
        assert not violations(full, ZonePlan(repaired(full, crowded), np.zeros(3)))


def test_too_few_places_and_no_pods() -> None:
    crowded = Zones([[1.0]], [1.0], [3], [2], [0.0])
    assert solve(crowded).status is Status.INFEASIBLE
    assert greedy.solve(crowded).status is Status.INFEASIBLE
    for data in (Zones([[1.0]], [1.0], [0], [2], [0.0]), Zones(np.zeros((0, 0)), [], [], [], [])):
        assert solve(data).objective == greedy.solve(data).objective == 0.0


def test_invalid_input_is_refused_by_field() -> None:
    with pytest.raises(ModelError, match="visit_s"):
        Zones([[-1.0]], [1.0], [1], [1], [0.0])
    with pytest.raises(ModelError, match="places"):
        Zones([[1.0]], [1.0], [1], [1, 2], [0.0])
    with pytest.raises(ModelError, match="congestion_s_h"):
        Zones([[1.0]], [1.0], [1], [1], [inf])
