"""Bundles to pods and stations: against enumeration on random small cases, all back ends."""

from itertools import product
from math import inf, isinf

import numpy as np
import pytest

from rmfs.solvers.models import Limits, ModelError, Status
from rmfs.solvers.models.backends.backend import relax
from rmfs.solvers.models.replenishment import (
    Replenishment,
    Stocking,
    best_pods,
    cp_sat,
    greedy,
    highs,
    objective,
    rounding,
    violations,
)
from rmfs.solvers.models.replenishment.polish import polished
from rmfs.solvers.models.replenishment.program import Columns, program

BACKENDS = {"cp_sat": cp_sat.solve, "highs": highs.solve}
RULES = {"greedy": greedy.solve, "rounding": rounding.solve}


def random_replenishment(seed: int) -> Replenishment:
    rng = np.random.default_rng(seed)
    bundles, pods, stations = (int(rng.integers(0, n)) for n in (5, 4, 3))
    worth = rng.integers(0, 240, (bundles, pods)) / 8
    worth[rng.random(worth.shape) < 0.2] = -inf
    trip = rng.integers(0, 320, (pods, stations)) / 8
    trip[rng.random(trip.shape) < 0.15] = inf
    return Replenishment(
        worth,
        np.where(rng.random(bundles) < 0.15, inf, rng.integers(-40, 120, bundles) / 8),
        rng.uniform(1, 10, bundles),
        rng.uniform(0, 25, pods),
        trip,
        rng.uniform(0, 30, stations),
    )


def enumerated(data: Replenishment) -> float:
    """Least cost over all pods for bundles and stations for these pods; inf if none is feasible."""
    bundles, (pods, stations) = len(data.space), data.trip_s.shape
    best = inf
    for pod in product(range(-1, pods), repeat=bundles):
        used = sorted(set(pod) - {-1})
        for chosen in product(range(stations), repeat=len(used)):
            station = dict(zip(used, chosen, strict=True))
            in_pod, at = np.zeros(pods), np.zeros(stations)
            cost = sum(data.trip_s[p, s] for p, s in station.items())
            for bundle, p in enumerate(pod):
                if p < 0:
                    cost += data.leave_s[bundle]
                    continue
                cost -= data.worth_s[bundle, p]
                in_pod[p] += data.space[bundle]
                at[station[p]] += data.space[bundle]
            if (in_pod <= data.pod_space).all() and (at <= data.station_space).all():
                best = min(best, float(cost))
    return best


CASES = [
    (random_replenishment(seed), enumerated(random_replenishment(seed))) for seed in range(250)
]


@pytest.mark.parametrize("backend", BACKENDS)
def test_the_stocking_is_the_enumerated_optimum(backend: str) -> None:
    infeasible = 0
    for data, best in CASES:
        solution = BACKENDS[backend](data)
        if isinf(best):
            infeasible += 1
            assert solution.status is Status.INFEASIBLE
            continue
        assert solution.status is Status.OPTIMAL
        assert not violations(data, solution.required)
        assert solution.objective == objective(data, solution.required)
        assert solution.objective == pytest.approx(best, abs=1e-6)
        assert best - 1e-3 <= solution.bound <= best + 1e-9
    assert 20 < infeasible < 200


@pytest.mark.parametrize("rule", RULES)
def test_rules_are_feasible_and_between_their_bounds_and_the_optimum(rule: str) -> None:
    found, gaps = 0, []
    for data, best in CASES:
        solution = RULES[rule](data)
        if not solution.found:
            assert solution.status is not Status.INFEASIBLE or isinf(best)
            continue
        found += 1
        assert not violations(data, solution.required)
        assert solution.bound - 1e-9 <= best <= solution.objective + 1e-9
        gaps.append(solution.objective - best)
    assert found > 120
    assert np.mean(np.array(gaps) < 1e-9) > 0.5


def larger(seed: int) -> Replenishment:
    rng = np.random.default_rng(seed)
    worth = rng.gamma(2, 15, (8, 8)) * (rng.random((8, 8)) < 0.6)
    return Replenishment(
        worth,
        np.full(8, 4.0),
        rng.uniform(20, 60, 8),
        rng.uniform(40, 200, 8),
        rng.uniform(30, 90, (8, 2)),
        [150.0, 200.0],
    )


def test_back_ends_agree_and_rules_are_near_on_larger_cases() -> None:
    for seed in range(3):
        data = larger(seed)
        rule = rounding.solve(data)
        exact, other = highs.solve(data, start=rule.values), cp_sat.solve(data)
        assert exact.status is other.status is Status.OPTIMAL
        assert exact.objective == pytest.approx(other.objective, abs=0.05)
        assert exact.bound - 1e-6 <= rule.objective
        assert rule.bound <= exact.objective + 1e-6
        assert rule.objective <= 0.75 * exact.objective


def test_pruning_keeps_solutions_valid_and_loses_little() -> None:
    for seed in range(3):
        data = larger(seed)
        pruned = best_pods(data, pods=4, stations=1)
        assert np.isfinite(pruned.worth_s).sum(axis=1).max() <= 4
        near, best = highs.solve(pruned), highs.solve(data)
        assert not violations(data, near.required)
        assert objective(data, near.required) == pytest.approx(near.objective)
        assert best.objective - 1e-6 <= near.objective <= 0.75 * best.objective


def test_only_stations_with_room_are_kept() -> None:
    """Pod 0 may take bundle 0 (2 units of space), pod 1 also bundle 1 (1 unit of space).

    Station 0, the nearest, is full, and station 1 has room for bundle 1 only: pod 0 goes to station
    2, pod 1 to station 1.
    """
    data = Replenishment(
        worth_s=[[90.0, 90.0], [-inf, 50.0]],
        leave_s=[20.0, 20.0],
        space=[2.0, 1.0],
        pod_space=[2.0, 3.0],
        trip_s=[[10.0, 20.0, 30.0], [10.0, 20.0, 30.0]],
        station_space=[0.5, 1.5, 9.0],
    )
    pruned = best_pods(data, pods=2, stations=1)
    assert pruned.trip_s.tolist() == [[inf, inf, 30.0], [inf, 20.0, inf]]
    assert best_pods(data, pods=2, stations=2).trip_s.tolist()[1] == [inf, 20.0, 30.0]


def test_pods_are_rated_by_the_trip_to_a_station_with_room() -> None:
    """Pod 0 is near the full station, pod 1 near the other."""
    data = Replenishment(
        worth_s=[[90.0, 90.0]],
        leave_s=[20.0],
        space=[1.0],
        pod_space=[1.0, 1.0],
        trip_s=[[10.0, 80.0], [70.0, 20.0]],
        station_space=[0.0, 9.0],
    )
    assert best_pods(data, pods=1, stations=1).worth_s.tolist() == [[-inf, 90.0]]


def test_polishing_never_makes_worse_and_stays_feasible() -> None:
    for seed in range(100):
        data = random_replenishment(seed)
        rng = np.random.default_rng(seed)
        bundles, (pods, stations) = len(data.space), data.trip_s.shape
        for _ in range(20):
            pod = rng.integers(-1, pods, bundles) if bundles else np.zeros(0, np.int64)
            station = rng.integers(-1, stations, pods) if pods else np.zeros(0, np.int64)
            rough = Stocking(pod, station)
            if violations(data, rough):
                continue
            better = polished(data, rough)
            assert not violations(data, better)
            assert objective(data, better) <= objective(data, rough) + 1e-9


def test_a_trip_is_made_only_if_its_bundles_pay_for_it_together() -> None:
    alone = Replenishment([[30.0]], [0.0], [1.0], [9.0], [[50.0]], [9.0])
    together = Replenishment([[30.0], [30.0]], [0.0, 0.0], [1.0, 1.0], [9.0], [[50.0]], [9.0])
    for solve in (*BACKENDS.values(), *RULES.values()):
        assert solve(alone).required.pod.tolist() == [-1]
        assert solve(alone).required.station.tolist() == [-1]
        assert solve(together).required.pod.tolist() == [0, 0]
        assert solve(together).objective == -10.0


def test_spaces_are_rounded_to_the_safe_side() -> None:
    data = Replenishment([[1.0]], [0.0], [0.51], [0.99], [[1.0]], [0.99])
    assert data.space.tolist() == [0.5625]
    assert data.pod_space.tolist() == data.station_space.tolist() == [0.9375]


def test_limits_end_the_search_and_the_bound_stays_one() -> None:
    data = larger(5)
    best = highs.solve(data).objective
    start = greedy.solve(data).required
    for solve, limits in (
        (cp_sat.solve, Limits(deterministic_s=0.01)),
        (highs.solve, Limits(nodes=0)),
        (rounding.solve, Limits(iterations=3)),
    ):
        ends = [solve(data, limits, start=start) for _ in range(2)]
        assert ends[0].bound <= best + 1e-6
        assert solve is rounding.solve or ends[0].gap < 0.5
        assert ends[0].objective >= best - 1e-6
        assert (ends[0].objective, ends[0].bound, ends[0].work) == (
            ends[1].objective,
            ends[1].bound,
            ends[1].work,
        )


def test_nothing_to_store_and_nowhere_to_store_it() -> None:
    nothing = Replenishment(np.zeros((0, 2)), [], [], [1.0, 1.0], np.ones((2, 1)), [1.0])
    nowhere = Replenishment(np.zeros((2, 0)), [3.0, 4.0], [1.0, 1.0], [], np.zeros((0, 0)), [])
    forced = Replenishment(np.zeros((1, 0)), [inf], [1.0], [], np.zeros((0, 0)), [])
    for solve in (*BACKENDS.values(), *RULES.values()):
        assert solve(nothing).objective == 0.0
        assert solve(nowhere).objective == 7.0
        assert solve(forced).status is Status.INFEASIBLE


def test_invalid_input_is_refused_by_field() -> None:
    with pytest.raises(ModelError, match="worth_s"):
        Replenishment([[inf]], [0.0], [1.0], [1.0], [[1.0]], [1.0])
    with pytest.raises(ModelError, match="trip_s"):
        Replenishment([[1.0]], [0.0], [1.0], [1.0], [[-1.0]], [1.0])
    with pytest.raises(ModelError, match="station_space"):
        Replenishment([[1.0]], [0.0], [1.0], [1.0], [[1.0]], [1.0, 2.0])
    data = Replenishment([[1.0]], [0.0], [2.0], [1.0], [[1.0]], [9.0])
    with pytest.raises(ModelError, match="start"):
        highs.solve(data, start=Stocking(np.array([0]), np.array([0])))


def test_violations_name_what_is_wrong() -> None:
    data = Replenishment([[1.0], [-inf]], [0.0, 0.0], [2.0, 2.0], [2.0], [[1.0]], [1.0])
    both = Stocking(np.array([0, 0]), np.array([0]))
    assert violations(data, both) == [
        "a pod gets more bundles than fit into it",
        "a station gets more bundles than fit into it",
        "a pair is not allowed, or a bundle that must be stored is left out",
    ]
    away = Stocking(np.array([0, -1]), np.array([-1]))
    assert violations(data, away) == ["a pod gets a bundle, but is brought to no station"]


@pytest.mark.parametrize("kind", ["uint8", "bool", "int64", "float32"])
def test_worth_of_any_number_type_is_worth(kind: str) -> None:
    """A bundle worth 1 s in the pod, which comes anyway: the objective is -1."""
    data = Replenishment(np.ones((1, 1), kind), [0.0], [1.0], [1.0], [[0.0]], [1.0])
    for solve in (*BACKENDS.values(), *RULES.values()):
        assert solve(data).objective == -1.0


def test_bounds_of_relaxations_hold_for_tiny_costs() -> None:
    """Reduced costs within the solver's tolerance add up over loads of hundreds of parts."""
    for data, best in CASES:
        tiny = Replenishment(
            data.worth_s * 1e-6,
            data.leave_s * 1e-6,
            data.space,
            data.pod_space,
            data.trip_s * 1e-6,
            data.station_space,
        )
        bound = relax(program(tiny, Columns.of(tiny), whole=False)).bound
        assert bound <= best * 1e-6 + 1e-12
