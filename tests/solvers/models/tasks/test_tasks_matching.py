"""Robots to tasks, with and without stations: against enumeration on random small cases."""

from collections.abc import Iterator
from itertools import product
from math import inf, isinf

import numpy as np
import pytest

from rmfs.solvers.models import ModelError, Status
from rmfs.solvers.models.tasks import balance, matching
from rmfs.solvers.models.tasks.balance import Balance
from rmfs.solvers.models.tasks.matching import Matching


def random_matching(seed: int) -> Matching:
    rng = np.random.default_rng(seed)
    robots, tasks = int(rng.integers(0, 5)), int(rng.integers(0, 5))
    travel = rng.uniform(0, 100, (robots, tasks))
    travel[rng.random(travel.shape) < 0.2] = inf
    leave = np.where(rng.random(tasks) < 0.2, inf, rng.uniform(-10, 150, tasks))
    return Matching(travel, leave)


def random_balance(seed: int) -> Balance:
    rng = np.random.default_rng(seed)
    pairs = random_matching(seed)
    stations, tasks = int(rng.integers(1, 4)), len(pairs.leave_s)
    return Balance(
        pairs.travel_s,
        pairs.leave_s,
        np.where(rng.random(tasks) < 0.3, inf, rng.uniform(-20, 80, tasks)),
        rng.integers(0, stations, tasks),
        rng.integers(0, 4, stations),
        rng.uniform(0, 30, stations),
        rng.integers(0, 4, stations),
        rng.uniform(0, 3),
    )


def choices(robots: int, tasks: int) -> Iterator[tuple[int, ...]]:
    """All choices of a robot, or none, for every task, without a robot twice."""
    for robot in product(range(-1, robots), repeat=tasks):
        busy = [one for one in robot if one >= 0]
        if len(set(busy)) == len(busy):
            yield robot


def best_matching(data: Matching) -> float:
    robots, tasks = data.travel_s.shape
    return min(
        sum(data.leave_s[t] if r < 0 else data.travel_s[r, t] for t, r in enumerate(robot))
        for robot in choices(robots, tasks)
    )


def best_balance(data: Balance) -> float:
    """Least cost, added up robot by robot as they join the queues."""
    robots, tasks = data.arrive_s.shape
    best = inf
    for robot in choices(robots, tasks):
        cost, queue = 0.0, data.queue.tolist()
        sent = [0] * len(queue)
        for task, one in enumerate(robot):
            if one < 0:
                cost += data.leave_s[task]
                continue
            station, arrive = data.station[task], data.arrive_s[one, task]
            late = 0.0 if isinf(data.due_s[task]) else max(0.0, arrive - data.due_s[task])
            cost += arrive + queue[station] * data.service_s[station]
            if data.late_weight:
                cost += data.late_weight * late
            queue[station] += 1
            sent[station] += 1
        if all(n <= room for n, room in zip(sent, data.room, strict=True)):
            best = min(best, float(cost))
    return best


@pytest.mark.parametrize("solver", ["assignment", "flow"])
def test_the_matching_is_the_enumerated_optimum(solver: str) -> None:
    infeasible = 0
    for seed in range(300):
        data = random_matching(seed)
        best = best_matching(data)
        solution = matching.solve(data, solver)
        if isinf(best):
            infeasible += 1
            assert solution.status is Status.INFEASIBLE
            continue
        assert solution.status is Status.OPTIMAL
        assert not matching.violations(data, solution.required)
        assert solution.objective == pytest.approx(best, abs=1e-5)
        assert best - 1e-5 <= solution.bound <= best + 1e-9
    assert 10 < infeasible < 250


def test_balanced_dispatch_is_the_enumerated_optimum() -> None:
    infeasible = 0
    for seed in range(300):
        data = random_balance(seed)
        best, solution = best_balance(data), balance.solve(data)
        if isinf(best):
            infeasible += 1
            assert solution.status is Status.INFEASIBLE
            continue
        assert solution.status is Status.OPTIMAL
        assert not balance.violations(data, solution.required)
        assert solution.objective == balance.objective(data, solution.required)
        assert solution.objective == pytest.approx(best, abs=1e-4)
        assert best - 1e-4 <= solution.bound <= best + 1e-9
    assert 20 < infeasible < 280


def test_the_rules_are_between_their_bounds_and_the_optimum() -> None:
    found = 0
    for seed in range(300):
        pairs, stations = random_matching(seed), random_balance(seed)
        for data, rule, best, broken in (
            (pairs, matching.greedy.solve(pairs), best_matching(pairs), matching.violations),
            (
                stations,
                balance.greedy.solve(stations),
                best_balance(stations),
                balance.violations,
            ),
        ):
            if rule.found:
                found += 1
                assert not broken(data, rule.required)  # type: ignore[operator]
                assert rule.bound - 1e-9 <= best <= rule.objective + 1e-9
            elif rule.status is Status.INFEASIBLE:
                assert isinf(best)
    assert found > 300


def test_without_stations_and_due_times_balance_is_matching() -> None:
    for seed in range(100):
        data = random_matching(seed)
        tasks = len(data.leave_s)
        alone = Balance(
            data.travel_s, data.leave_s, np.full(tasks, inf), np.zeros(tasks), [3], [0.0], [99]
        )
        flat, flow = matching.solve(data), balance.solve(alone)
        assert flat.status is flow.status
        if flat.found:
            assert flow.objective == pytest.approx(flat.objective, abs=1e-5)


def test_queues_send_robots_to_the_emptier_station() -> None:
    data = Balance([[20.0, 25.0]], [100.0, 100.0], [inf, inf], [0, 1], [3, 0], [10.0, 10.0], [9, 9])
    assert balance.solve(data).required.tolist() == [-1, 0]
    assert matching.solve(data.pairs).required.tolist() == [0, -1]


def test_a_due_time_outweighs_a_shorter_way() -> None:
    data = Balance([[20.0, 25.0]], [50.0, 50.0], [inf, 5.0], [0, 0], [0], [0.0], [9], 4.0)
    # 20 s and 50 s for the one left, against 25 + 80 s late and 50 s: late anyway, so the short way
    assert balance.solve(data).required.tolist() == [0, -1]
    pressing = Balance([[20.0, 25.0]], [50.0, 500.0], [inf, 5.0], [0, 0], [0], [0.0], [9], 4.0)
    assert balance.solve(pressing).required.tolist() == [-1, 0]


def test_nothing_to_do_and_nobody_to_do_it() -> None:
    nobody = Matching(np.zeros((0, 2)), [3.0, 4.0])
    idle = Matching(np.zeros((2, 0)), [])
    for solve in (matching.solve, matching.greedy.solve):
        assert solve(nobody).required.tolist() == [-1, -1]
        assert solve(nobody).objective == 7.0
        assert solve(idle).objective == 0.0
    empty = Balance(np.zeros((0, 0)), [], [], [], [], [], [])
    for rule in (balance.solve, balance.greedy.solve):
        assert rule(empty).objective == 0.0


def test_invalid_input_is_refused_by_field() -> None:
    with pytest.raises(ModelError, match="travel_s"):
        Matching([[-1.0]], [1.0])
    with pytest.raises(ModelError, match="leave_s"):
        Matching([[1.0]], [1.0, 2.0])
    with pytest.raises(ModelError, match="station"):
        Balance([[1.0]], [1.0], [1.0], [1], [0], [1.0], [1])
    with pytest.raises(ModelError, match="late_weight"):
        Balance([[1.0]], [1.0], [1.0], [0], [0], [1.0], [1], -1.0)


def test_violations_name_what_is_wrong() -> None:
    data = Matching([[1.0, 1.0, inf]], [1.0, 1.0, inf])
    assert matching.violations(data, np.array([0, 0, -1])) == [
        "a robot gets two tasks",
        "a task is left undone that must be done",
    ]
    assert matching.violations(data, np.array([-1, -1, 0])) == [
        "a robot gets a task that it may not do"
    ]
    full = Balance([[1.0]], [1.0], [1.0], [0], [0], [1.0], [0])
    assert balance.violations(full, np.array([0])) == [
        "a station gets more robots than it has room for"
    ]


@pytest.mark.parametrize("penalty", [1e9, 1e12, 1e15])
def test_a_matching_beside_huge_costs_counts_as_optimal_only_if_it_is(penalty: float) -> None:
    """The flow rounds costs more coarsely if one of them is huge."""
    coarse = 0
    for seed in range(60):
        data = random_matching(seed)
        rng = np.random.default_rng(seed)
        leave = np.where(rng.random(len(data.leave_s)) < 0.4, penalty, data.leave_s)
        data = Matching(data.travel_s, leave)
        best, found = best_matching(data), matching.solve(data, "flow")
        if isinf(best):
            assert found.status is Status.INFEASIBLE
            continue
        assert found.bound <= best + 1e-9 * max(1.0, abs(best))
        if found.status is Status.OPTIMAL:
            assert found.objective == pytest.approx(best, rel=1e-5, abs=1e-5)
        else:
            assert found.status is Status.FEASIBLE
            coarse += 1
    assert coarse > 3 if penalty == 1e15 else coarse == 0
