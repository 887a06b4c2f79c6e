"""Routes: against enumeration on random small cases, the rule, the bound and the short ways."""

from dataclasses import fields
from itertools import permutations, product
from math import inf, isinf

import numpy as np
import pytest

from rmfs.solvers.models import Limits, ModelError, Status
from rmfs.solvers.models.tasks.sequence import (
    Routes,
    TaskSequence,
    arrivals_s,
    every_way,
    greedy,
    lns,
    objective,
    relaxed_bound,
    short_ways,
    solve,
    violations,
)


def random_sequence(seed: int) -> TaskSequence:
    rng = np.random.default_rng(seed)
    robots, tasks, places = (int(rng.integers(0, n)) for n in (3, 4, 5))

    def ways(*shape: int) -> np.ndarray:
        return np.where(rng.random(shape) < 0.1, inf, rng.uniform(1, 40, shape))

    earliest = rng.uniform(0, 60, tasks)
    return TaskSequence(
        rng.uniform(0, 20, robots),
        rng.random(robots) < 0.5,
        ways(robots, tasks),
        ways(robots, places),
        ways(places, tasks),
        rng.uniform(5, 20, tasks),
        rng.uniform(0, 20, tasks),
        ways(tasks, places),
        earliest,
        np.where(rng.random(tasks) < 0.4, inf, earliest + rng.uniform(0, 80, tasks)),
        np.where(rng.random(tasks) < 0.3, inf, rng.uniform(0, 100, tasks)),
        np.where(rng.random(tasks) < 0.1, inf, rng.uniform(0, 120, tasks)),
        int(rng.integers(0, 4)),
    )


def site(seed: int, robots: int, tasks: int, places: int) -> TaskSequence:
    """Points on a floor, stations along one side, distances at 1.3 m/s."""
    rng = np.random.default_rng(seed)
    floor = np.array([60.0, 40.0])
    at_robot, at_pod, at_place = (rng.uniform(0, floor, (n, 2)) for n in (robots, tasks, places))
    at_station = np.column_stack([rng.choice(np.linspace(0, 60, 6), tasks), np.zeros(tasks)])

    def drive(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return np.abs(a[:, None] - b[None]).sum(axis=2) / 1.3

    return TaskSequence(
        rng.uniform(0, 40, robots),
        rng.random(robots) < 0.6,
        drive(at_robot, at_pod),
        drive(at_robot, at_place) + 2.2,
        drive(at_place, at_pod),
        2.2 + np.abs(at_pod - at_station).sum(axis=1) / 1.3,
        rng.uniform(10, 60, tasks),
        drive(at_station, at_place) + 2.2,
        np.zeros(tasks),
        np.full(tasks, inf),
        rng.uniform(60, 400, tasks),
        np.full(tasks, 200.0),
    )


def driven(data: TaskSequence, robot: int, tasks: tuple[int, ...], places: dict[str, int]) -> float:
    """Cost of one route, driven step by step; inf if it is not allowed."""
    time = data.ready_s[robot]
    cost, here = 0.0, None
    if data.carrying[robot]:
        here = places[f"r{robot}"]
        cost += data.stow_s[robot, here]
        time += data.stow_s[robot, here]
    for task in tasks:
        empty = data.reach_s[robot, task] if here is None else data.fetch_s[here, task]
        time = max(time + empty + data.bring_s[task], data.earliest_s[task])
        if isinf(time) or time > data.latest_s[task] + 1e-9:
            return inf
        if not isinf(data.due_s[task]):
            cost += data.late_weight * max(0.0, time - data.due_s[task])
        here = places[f"t{task}"]
        cost += empty + data.bring_s[task] + data.store_s[task, here]
        time += data.service_s[task] + data.store_s[task, here]
    return float(cost)


def enumerated(data: TaskSequence) -> float:
    """Least cost over all robots, orders and places; inf if nothing is feasible."""
    best = inf
    robots, tasks = range(data.robots), range(data.tasks)
    for doer in product(range(-1, data.robots), repeat=data.tasks):
        left = sum(data.skip_s[t] for t in tasks if doer[t] < 0)
        owners = [f"r{r}" for r in robots if data.carrying[r]]
        owners += [f"t{t}" for t in tasks if doer[t] >= 0]
        orders = [permutations([t for t in tasks if doer[t] == r]) for r in robots]
        for routes in product(*orders):
            for chosen in permutations(range(data.places), len(owners)):
                places = dict(zip(owners, chosen, strict=True))
                cost = left + sum(driven(data, r, routes[r], places) for r in robots)
                best = min(best, float(cost))
    return best


CASES = [(random_sequence(seed), enumerated(random_sequence(seed))) for seed in range(200)]


def test_routes_are_the_enumerated_optimum() -> None:
    infeasible = 0
    for data, best in CASES:
        solution = solve(data)
        if isinf(best):
            infeasible += 1
            assert solution.status is Status.INFEASIBLE
            continue
        assert solution.status is Status.OPTIMAL
        assert not violations(data, solution.required)
        assert solution.objective == objective(data, solution.required)
        assert solution.objective == pytest.approx(best, abs=1e-6)
        assert best - 1e-2 <= solution.bound <= best + 1e-6
    assert 15 < infeasible < 150


def test_the_relaxed_bound_never_exceeds_the_optimum_and_is_often_close() -> None:
    shares = []
    for data, best in CASES:
        bound = relaxed_bound(data)
        assert bound <= best + 1e-9 * max(1.0, abs(best))
        if 0 < best < inf:
            shares.append(bound / best)
    assert np.mean(shares) > 0.9


def test_insertion_is_feasible_and_never_better_than_the_optimum() -> None:
    found = 0
    for data, best in CASES:
        rule = greedy.solve(data)
        if rule.found:
            found += 1
            assert not violations(data, rule.required)
            assert rule.objective >= best - 1e-6
        elif rule.status is Status.INFEASIBLE:
            assert isinf(best)
    assert found > 100


def test_the_search_is_feasible_and_nearly_always_optimal() -> None:
    feasible = found = optimal = 0
    for data, best in CASES:
        solution = solve(data, "lns")
        assert solution.bound <= best + 1e-9 * max(1.0, abs(best))
        feasible += not isinf(best)
        if not solution.found:
            continue
        found += 1
        assert not violations(data, solution.required)
        assert solution.objective == objective(data, solution.required)
        assert solution.objective >= best - 1e-6
        optimal += solution.objective <= best + 1e-6
    assert found >= 0.97 * feasible
    assert optimal >= 0.95 * feasible


@pytest.mark.parametrize("seed", range(4))
def test_the_search_is_near_the_optimum_repeats_and_improves_with_steps(seed: int) -> None:
    data = site(seed, 10, 20, 30)
    best, rule = solve(data, "columns"), greedy.solve(data)
    assert best.status is Status.OPTIMAL
    ends = [solve(data, "lns", Limits(iterations=steps), seed=seed) for steps in (0, 400, 4000)]
    again = solve(data, "lns", Limits(iterations=4000), seed=seed)
    assert again.required.tasks == ends[-1].required.tasks
    assert (again.objective, again.work) == (ends[-1].objective, ends[-1].work)
    first, short, long = (end.objective for end in ends)
    assert best.objective - 1e-9 <= long <= 1.02 * best.objective
    assert max(short, long) < min(first, rule.objective)
    started = solve(data, "lns", Limits(iterations=0), start=best.required)
    assert started.objective == best.objective


def test_column_generation_finds_the_optimum_and_its_bound_never_exceeds_it() -> None:
    found = 0
    for data, best in CASES:
        solution = solve(data, "columns")
        assert solution.bound <= best + 1e-9 * max(1.0, abs(best))
        if isinf(best):
            assert not solution.found
            continue
        found += 1
        assert solution.status is Status.OPTIMAL
        assert not violations(data, solution.required)
        assert solution.objective == objective(data, solution.required)
        assert solution.objective == pytest.approx(best, abs=1e-6)
        assert solution.bound == pytest.approx(best, rel=1e-5, abs=1e-3)
    assert found > 50


@pytest.mark.parametrize("seed", range(4))
def test_column_generation_and_circuits_agree(seed: int) -> None:
    data = site(seed, 3, 6, 8)
    circuits, columns = solve(data, "cp_sat"), solve(data, "columns")
    assert columns.objective == pytest.approx(circuits.objective, abs=1e-6)
    assert columns.status is circuits.status is Status.OPTIMAL


def test_the_bound_of_column_generation_holds_under_any_limit_and_repeats() -> None:
    data = site(4, 10, 20, 30)
    best = solve(data, "columns")
    assert best.status is Status.OPTIMAL
    gaps = []
    for work in (0.0, 0.2, 1.0):
        first, again = (solve(data, "columns", Limits(deterministic_s=work)) for _ in range(2))
        assert first.bound <= best.objective + 1e-9
        assert best.objective <= first.objective + 1e-9
        assert (first.objective, first.bound, first.work) == (
            again.objective,
            again.bound,
            again.work,
        )
        gaps.append(first.gap)
    assert gaps[-1] < gaps[0]
    rule = greedy.solve(data)
    stopped = solve(data, "columns", Limits(deterministic_s=0.0), start=rule.required)
    assert stopped.required.tasks == rule.required.tasks


def test_prices_bound_routes_that_must_not_use_a_place_twice() -> None:
    """One place is best for both pods of a robot, and only one of them may have it."""
    data = simple(
        store_s=[[1.0, 60.0], [1.0, 60.0]], fetch_s=[[2.0, 2.0], [2.0, 2.0]], reach_s=[[1.0, 1.0]]
    )
    best = enumerated(data)
    solution = solve(data, "columns")
    assert solution.objective == solution.bound == pytest.approx(best)
    assert sorted(solution.required.place.tolist()) == [0, 1]


def test_short_ways_contain_the_plan_and_lose_little() -> None:
    for seed in range(3):
        data = site(seed, 3, 6, 8)
        rule = greedy.solve(data)
        assert rule.found
        ways = short_ways(data, rule.required, tasks=3, places=3)
        assert len(ways.onward) < len(every_way(data).onward)
        best, near = solve(data), solve(data, start=rule.required, ways=ways)
        assert not violations(data, near.required)
        assert best.objective <= near.objective + 1e-6 <= rule.objective + 2e-6
        assert near.bound <= best.objective + 1e-6
        assert near.status in (Status.FEASIBLE, Status.OPTIMAL)


def test_a_start_is_never_made_worse_and_work_repeats() -> None:
    data = site(4, 10, 20, 30)
    rule = greedy.solve(data)
    ways = short_ways(data, rule.required, tasks=3, places=2)
    for work in (0.0, 0.05):
        ends = [
            solve(data, limits=Limits(deterministic_s=work), start=rule.required, ways=ways)
            for _ in range(2)
        ]
        assert ends[0].objective <= rule.objective + 1e-9
        assert (ends[0].objective, ends[0].bound, ends[0].work) == (
            ends[1].objective,
            ends[1].bound,
            ends[1].work,
        )
        assert ends[0].required.tasks == ends[1].required.tasks


def simple(**changes: object) -> TaskSequence:
    """One robot at 0 on a line, two pods at 10 and 30, their station at 20, places at 12 and 28."""
    given = {
        "ready_s": [0.0],
        "carrying": [False],
        "reach_s": [[10.0, 30.0]],
        "stow_s": [[12.0, 28.0]],
        "fetch_s": [[2.0, 18.0], [18.0, 2.0]],
        "bring_s": [10.0, 10.0],
        "service_s": [5.0, 5.0],
        "store_s": [[8.0, 8.0], [8.0, 8.0]],
        "earliest_s": [0.0, 0.0],
        "latest_s": [inf, inf],
        "due_s": [inf, inf],
        "skip_s": [inf, inf],
    }
    return TaskSequence(**(given | changes))  # type: ignore[arg-type]


def test_the_return_of_one_pod_is_combined_with_the_fetch_of_the_next() -> None:
    for solver in (solve, greedy.solve, lns.solve):
        routes = solver(simple()).required
        assert routes.tasks == ((0, 1),)
        # near the next pod, not the first place in the list
        assert routes.place.tolist() == [1, 0]
        assert arrivals_s(simple(), routes).tolist() == [20.0, 45.0]


def test_a_robot_with_a_pod_stores_it_on_the_way() -> None:
    data = simple(carrying=[True], skip_s=[0.0, inf])
    routes = solve(data).required
    assert routes.tasks == ((1,),)
    assert routes.robot_place.tolist() == [1]


def test_windows_and_due_times_decide_the_order() -> None:
    assert solve(simple(latest_s=[inf, 40.0])).required.tasks == ((1, 0),)
    assert solve(simple(due_s=[inf, 40.0], late_weight=9)).required.tasks == ((1, 0),)
    waiting = solve(simple(earliest_s=[50.0, 0.0], skip_s=[inf, 0.0])).required
    assert arrivals_s(simple(earliest_s=[50.0, 0.0]), waiting)[0] == 50.0
    assert solve(simple(latest_s=[5.0, inf])).status is Status.INFEASIBLE
    assert solve(simple(earliest_s=[9.0, 0.0], latest_s=[5.0, inf])).status is Status.INFEASIBLE


def test_nothing_to_do_and_nobody_to_do_it() -> None:
    nobody = TaskSequence(
        [], [], np.zeros((0, 1)), np.zeros((0, 2)), np.zeros((2, 1)), [1.0], [1.0],
        np.zeros((1, 2)), [0.0], [inf], [inf], [7.0],
    )  # fmt: skip
    for solver in (solve, greedy.solve, lns.solve):
        assert solver(nobody).objective == 7.0
    idle = TaskSequence(
        [0.0], [True], np.zeros((1, 0)), [[3.0]], np.zeros((1, 0)), [], [], np.zeros((0, 1)),
        [], [], [], [],
    )  # fmt: skip
    for solver in (solve, greedy.solve, lns.solve):
        assert solver(idle).objective == 3.0
        assert solver(idle).required.robot_place.tolist() == [0]


def test_times_are_rounded_to_milliseconds() -> None:
    assert simple(bring_s=[1.00049, 2.0]).bring_s.tolist() == [1.0, 2.0]


def test_invalid_input_is_refused_by_field() -> None:
    with pytest.raises(ModelError, match="reach_s"):
        simple(reach_s=[[-1.0, 1.0]])
    with pytest.raises(ModelError, match="store_s"):
        simple(store_s=[[1.0, 1.0]])
    with pytest.raises(ModelError, match="late_weight"):
        simple(late_weight=0.5)
    with pytest.raises(ModelError, match="start"):
        solve(simple(), start=Routes(((),), np.array([-1, -1]), np.array([-1])))
    with pytest.raises(ModelError, match="start"):
        solve(simple(), "lns", start=Routes(((),), np.array([-1, -1]), np.array([-1])))


def test_violations_name_what_is_wrong() -> None:
    data, none = simple(), np.array([-1])
    assert violations(data, Routes(((0, 1),), np.array([1, 1]), none)) == [
        "two pods are stored at one location"
    ]
    assert violations(data, Routes(((0,),), np.array([1, 0]), none)) == [
        "exactly the tasks with a location must be done, each by one robot"
    ]
    assert violations(data, Routes(((0, 1),), np.array([1, 2]), none)) == [
        "a pod is stored at a location that does not exist"
    ]
    assert violations(data, Routes(((0, 1),), np.array([1, 0]), np.array([0])))[0].startswith(
        "robot_place must be -1"
    )


def test_stopped_at_once_cp_sat_says_if_the_relaxation_proves_that_there_are_no_routes() -> None:
    stopped = 0
    for data, best in CASES:
        ended = solve(data, "cp_sat", Limits(deterministic_s=0.0))
        if isinf(ended.bound):
            assert isinf(best)
            assert ended.status is Status.INFEASIBLE
            stopped += isinf(relaxed_bound(data))
    assert stopped > 5


def test_column_generation_ends_without_routes() -> None:
    """Two robots carry pods, and there is one place, 30 hours away."""
    far = np.full((2, 1), 30 * 3600.0)
    none, nothing = np.zeros((0, 1)), np.zeros(0)
    more = (nothing, nothing, none, nothing, nothing, nothing, nothing, 1)
    data = TaskSequence(np.zeros(2), [True, True], none.T.repeat(2, 0), far, none.T, *more)
    ended = solve(data, "columns")
    assert ended.values is None
    assert ended.status in (Status.LIMIT, Status.INFEASIBLE)


def test_times_beyond_the_integers_of_the_back_ends_are_refused() -> None:
    given = {field.name: getattr(CASES[1][0], field.name) for field in fields(TaskSequence)}
    skip = np.full_like(given["skip_s"], 1e10)
    assert skip.size
    with pytest.raises(ModelError, match=r"skip_s: must be at most 1e\+09 s"):
        TaskSequence(**{**given, "skip_s": skip})
