"""How long the task models take, at three sizes up to a real site's."""

from typing import Any

import numpy as np
import pytest

from rmfs.solvers.models import Limits
from rmfs.solvers.models.tasks import balance, matching, sequence

SIZES = {"small": (10, 20), "medium": (45, 90), "large": (128, 256)}
"""Robots and tasks."""

ROUTES = {"small": (4, 8, 10), "medium": (45, 90, 210), "large": (128, 200, 300)}
"""Robots, tasks and free places: one or two tasks ahead."""

STATIONS = 18


def pairs(robots: int, tasks: int) -> matching.Matching:
    rng = np.random.default_rng(7)
    return matching.Matching(rng.uniform(10, 150, (robots, tasks)), rng.uniform(60, 200, tasks))


@pytest.mark.benchmark(group="tasks: matching")
@pytest.mark.parametrize("method", ["assignment", "flow"])
@pytest.mark.parametrize("size", SIZES)
def test_matching(benchmark: Any, note: Any, size: str, method: str) -> None:
    data = pairs(*SIZES[size])
    solution = benchmark(matching.solve, data, method)
    assert solution.gap < 1e-6
    assert solution.objective <= matching.solve(data, "greedy").objective + 1e-6
    note(
        "tasks.matching", size, method, solution, f"{SIZES[size][0]} robots, {SIZES[size][1]} tasks"
    )


@pytest.mark.benchmark(group="tasks: balance")
@pytest.mark.parametrize("size", SIZES)
def test_balance(benchmark: Any, note: Any, size: str) -> None:
    rng = np.random.default_rng(8)
    flat = pairs(*SIZES[size])
    tasks = len(flat.leave_s)
    data = balance.Balance(
        flat.travel_s,
        flat.leave_s,
        rng.uniform(0, 100, tasks),
        rng.integers(0, STATIONS, tasks),
        rng.integers(0, 4, STATIONS),
        np.full(STATIONS, 25.0),
        np.full(STATIONS, 8),
    )
    solution = benchmark(balance.solve, data)
    assert solution.gap < 1e-6
    assert solution.objective <= balance.solve(data, "greedy").objective + 1e-6
    note(
        "tasks.balance",
        size,
        "flow",
        solution,
        f"{SIZES[size][0]} robots, {SIZES[size][1]} tasks, {STATIONS} stations",
    )


def floor(robots: int, tasks: int, places: int) -> sequence.TaskSequence:
    """Points on 60 m by 40 m, stations along one side, rectangular ways at 1.3 m/s."""
    rng = np.random.default_rng(7)
    size = np.array([60.0, 40.0])
    at_robot, at_pod, at_place = (rng.uniform(0, size, (n, 2)) for n in (robots, tasks, places))
    along = np.linspace(0, 60, STATIONS)[rng.integers(0, STATIONS, tasks)]
    at_station = np.column_stack([along, np.zeros(tasks)])

    def drive_s(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return np.abs(a[:, None] - b[None]).sum(axis=2) / 1.3

    return sequence.TaskSequence(
        rng.uniform(0, 40, robots),
        rng.random(robots) < 0.6,
        drive_s(at_robot, at_pod),
        drive_s(at_robot, at_place) + 2.2,
        drive_s(at_place, at_pod),
        2.2 + np.abs(at_pod - at_station).sum(axis=1) / 1.3,
        rng.uniform(10, 60, tasks),
        drive_s(at_station, at_place) + 2.2,
        np.zeros(tasks),
        np.full(tasks, np.inf),
        rng.uniform(60, 400, tasks),
        np.full(tasks, 200.0),
    )


@pytest.mark.benchmark(group="tasks: sequence")
@pytest.mark.parametrize("size", ROUTES)
def test_sequence(benchmark: Any, note: Any, size: str) -> None:
    data = floor(*ROUTES[size])
    rule = sequence.solve(data, "greedy")
    near = sequence.short_ways(data, rule.required, tasks=3, places=2)
    given = {"start": rule.required, "ways": None if size == "small" else near}
    limits = Limits(deterministic_s=1.0)
    solution = benchmark.pedantic(sequence.solve, (data, "cp_sat", limits), given, rounds=3)
    assert solution.objective <= rule.objective + 1e-6
    assert solution.gap < (1e-6 if size == "small" else 0.3)
    note(
        "tasks.sequence",
        size,
        "cp_sat",
        solution,
        f"{ROUTES[size][0]} robots, {ROUTES[size][1]} tasks, {ROUTES[size][2]} places",
    )


@pytest.mark.benchmark(group="tasks: sequence")
@pytest.mark.parametrize("size", ROUTES)
def test_insertion(benchmark: Any, note: Any, size: str) -> None:
    data = floor(*ROUTES[size])
    solution = benchmark.pedantic(sequence.solve, (data, "greedy"), rounds=3)
    assert not sequence.violations(data, solution.required)
    note(
        "tasks.sequence",
        size,
        "greedy",
        solution,
        f"{ROUTES[size][0]} robots, {ROUTES[size][1]} tasks, {ROUTES[size][2]} places",
    )
