"""The interval model: against enumeration on random small cases, all back ends."""

from collections.abc import Callable
from itertools import product
from math import inf, isinf

import numpy as np
import pytest

from rmfs.solvers.models import Limits, ModelError, Solution, Status
from rmfs.solvers.models.storage.stays import (
    Stays,
    cp_sat,
    flow,
    greedy,
    highs,
    objective,
    places,
    violations,
)

BACKENDS = {"cp_sat": cp_sat.solve, "highs": highs.solve, "flow": flow.solve}


def random_stays(seed: int, zones: int | None = None) -> Stays:
    rng = np.random.default_rng(seed)
    stays, number = int(rng.integers(0, 7)), zones or int(rng.integers(1, 4))
    # whole times, so that stays that touch are common
    begin = rng.integers(0, 9, stays)
    cost = rng.integers(0, 400, (stays, number)) / 8
    cost[rng.random(cost.shape) < 0.15] = inf
    return Stays(begin, begin + rng.integers(1, 6, stays), cost, rng.integers(0, 4, number))


def most_at_a_time(data: Stays, zone: tuple[int, ...], which: int) -> int:
    """Count stays in a zone at every begin, the plain way."""
    own = [s for s, z in enumerate(zone) if z == which]
    return max(
        (sum(bool(data.begin_s[o] <= data.begin_s[s] < data.end_s[o]) for o in own) for s in own),
        default=0,
    )


def enumerated(data: Stays) -> float:
    """Least cost over all choices of zones; inf if none is feasible."""
    stays, zones = data.cost_s.shape
    best = inf
    for zone in product(range(zones), repeat=stays):
        cost = sum(data.cost_s[s, z] for s, z in enumerate(zone))
        if cost < best and all(
            most_at_a_time(data, zone, z) <= data.capacity[z] for z in range(zones)
        ):
            best = float(cost)
    return best


def check(data: Stays, solution: Solution[np.ndarray], best: float) -> None:
    if isinf(best):
        assert solution.status is Status.INFEASIBLE
        return
    assert solution.status is Status.OPTIMAL
    assert not violations(data, solution.required)
    assert solution.objective == objective(data, solution.required)
    assert solution.objective == pytest.approx(best, abs=1e-6)
    assert best - 1e-3 <= solution.bound <= best + 1e-9


@pytest.mark.parametrize(
    ("backend", "zones"), [("cp_sat", None), ("highs", None), ("flow", 2), ("highs", 2)]
)
def test_the_choice_of_zones_is_the_enumerated_optimum(backend: str, zones: int | None) -> None:
    infeasible = 0
    for seed in range(150):
        data = random_stays(seed, zones)
        best = enumerated(data)
        check(data, BACKENDS[backend](data), best)
        infeasible += isinf(best)
    assert 15 < infeasible < 130


def test_back_ends_agree_on_larger_cases() -> None:
    for seed in range(4):
        rng = np.random.default_rng(seed)
        begin = rng.uniform(0, 600, 80)
        cost = np.sort(rng.uniform(20, 90, 2)) * rng.uniform(0.5, 1.5, (80, 2))
        data = Stays(begin, begin + rng.gamma(2, 40, 80), cost, [6, 20])
        start = greedy.solve(data)
        solutions = [
            flow.solve(data),
            highs.solve(data, start=start.values),
            cp_sat.solve(data, start=start.values),
        ]
        assert {s.status for s in solutions} == {Status.OPTIMAL}
        assert np.ptp([s.objective for s in solutions]) <= 80 / 1024
        assert start.objective >= solutions[0].objective - 1e-9


def test_the_rule_is_feasible_and_between_its_bound_and_the_optimum() -> None:
    found = 0
    for seed in range(200):
        data = random_stays(seed)
        best, rule = enumerated(data), greedy.solve(data)
        if rule.found:
            found += 1
            assert not violations(data, rule.required)
            assert rule.bound - 1e-9 <= best <= rule.objective + 1e-9
        elif rule.status is Status.INFEASIBLE:
            assert isinf(best)
    assert found > 60


def test_without_forbidden_zones_the_rule_finds_room_whenever_there_is_any() -> None:
    for seed in range(200):
        data = random_stays(seed)
        free = Stays(
            data.begin_s,
            data.end_s,
            np.where(np.isinf(data.cost_s), 99.0, data.cost_s),
            data.capacity,
        )
        assert greedy.solve(free).found == (not isinf(enumerated(free)))


def test_periods_are_the_maximal_sets_of_stays() -> None:
    data = Stays([0, 1, 2, 4], [3, 2, 5, 6], np.zeros((4, 1)), [9])
    first, last, periods = data.periods
    together = [{s for s in range(4) if first[s] <= t < last[s]} for t in range(periods)]
    # stay 1 has left when stay 2 begins
    assert together == [{0, 1}, {0, 2}, {2, 3}]


def test_places_are_never_shared() -> None:
    shared = 0
    for seed in range(150):
        data = random_stays(seed)
        rule = greedy.solve(data)
        if not rule.found:
            continue
        zone, place = rule.required, places(data, rule.required)
        assert ((place >= 0) & (place < data.capacity[zone])).all()
        for a, b in product(range(len(zone)), repeat=2):
            if a < b and (zone[a], place[a]) == (zone[b], place[b]):
                shared += 1
                assert data.end_s[a] <= data.begin_s[b] or data.end_s[b] <= data.begin_s[a]
    assert shared > 20


def test_limits_end_the_search_and_the_bound_stays_one() -> None:
    rng = np.random.default_rng(3)
    begin = rng.uniform(0, 300, 60)
    cost = rng.uniform(20, 90, (60, 5))
    data = Stays(begin, begin + rng.gamma(2, 60, 60), cost, np.full(5, 8))
    start = greedy.solve(data).required
    best = highs.solve(data).objective
    solvers: tuple[tuple[Callable[..., Solution[np.ndarray]], Limits], ...] = (
        (cp_sat.solve, Limits(deterministic_s=0.001)),
        (highs.solve, Limits(nodes=0)),
    )
    for solve, limits in solvers:
        stopped = solve(data, limits, start=start)
        assert stopped.bound <= best + 1e-6
        assert stopped.objective >= best - 1e-6
        again = solve(data, limits, start=start)
        assert (stopped.objective, stopped.bound, stopped.work) == (
            again.objective,
            again.bound,
            again.work,
        )


def test_an_infeasible_start_and_invalid_input_are_refused() -> None:
    data = Stays([0, 0], [1, 1], [[1.0, 2.0], [1.0, 2.0]], [1, 1])
    with pytest.raises(ModelError, match="start"):
        highs.solve(data, start=np.array([0, 0]))
    with pytest.raises(ModelError, match="zone"):
        places(data, np.array([0, 0]))
    with pytest.raises(ModelError, match="end_s"):
        Stays([1.0], [1.0], [[1.0]], [1])
    with pytest.raises(ModelError, match="capacity"):
        Stays([1.0], [2.0], [[1.0]], [-1])
    with pytest.raises(ModelError, match="capacity"):
        flow.solve(Stays([1.0], [2.0], [[1.0]], [1]))


def test_nothing_to_decide() -> None:
    empty = Stays([], [], np.zeros((0, 2)), [1, 1])
    for solve in (*BACKENDS.values(), greedy.solve):
        assert solve(empty).objective == 0.0
    homeless = Stays([0.0], [1.0], np.zeros((1, 0)), [])
    for solve in (highs.solve, cp_sat.solve, greedy.solve):
        assert solve(homeless).status is Status.INFEASIBLE


def test_bounds_of_cp_sat_hold_beside_huge_costs() -> None:
    """Sums above 2^53 are not exact in the solver's report; larger ones are refused."""
    compared = 0
    for seed in range(60):
        data = random_stays(seed, 2)
        huge = np.random.default_rng(seed).random(data.cost_s.shape) < 0.3
        cost_s = np.where(huge & np.isfinite(data.cost_s), 1e15, data.cost_s)
        data = Stays(data.begin_s, data.end_s, cost_s, data.capacity)
        best = enumerated(data)
        try:
            solution = cp_sat.solve(data)
        except ModelError as error:
            assert "adds up to" in str(error)
            continue
        compared += huge.any() and not isinf(best)
        assert solution.bound <= best + 1e-9
    assert compared > 10
