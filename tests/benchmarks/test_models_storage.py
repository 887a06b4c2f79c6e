"""How long the storage models take, at three sizes up to a real site's."""

from typing import Any

import numpy as np
import pytest

from rmfs.solvers.models import Limits, Status
from rmfs.solvers.models.storage import placement, stays, zones

PLACEMENT = {"small": (8, 30), "medium": (45, 210), "large": (128, 1400)}
"""Pods that return and free places."""

ZONES = {"small": (4, 6), "medium": (10, 12), "large": (30, 40)}
"""Classes of pods and zones; 1,200 pods at the large site."""

STAYS = {"small": (60, 4), "medium": (200, 8), "large": (450, 12)}
"""Stays within half an hour, and zones."""


def free_places(pods: int, places: int) -> placement.Placement:
    rng = np.random.default_rng(7)
    return placement.Placement(
        rng.uniform(10, 150, (pods, places)), rng.uniform(20, 120, places), rng.gamma(1, 1, pods)
    )


@pytest.mark.benchmark(group="storage: placement")
@pytest.mark.parametrize("method", ["assignment", "flow"])
@pytest.mark.parametrize("size", PLACEMENT)
def test_placement(benchmark: Any, note: Any, size: str, method: str) -> None:
    data = free_places(*PLACEMENT[size])
    solution = benchmark(placement.solve, data, method)
    rule = placement.solve(data, "greedy")
    assert solution.gap < 1e-6
    assert solution.objective <= rule.objective + 1e-6
    note(
        "storage.placement",
        size,
        method,
        solution,
        f"{PLACEMENT[size][0]} pods, {PLACEMENT[size][1]} places",
    )


def steady_state(classes: int, number: int) -> zones.Zones:
    rng = np.random.default_rng(7)
    pods = np.full(classes, 1200 // classes if classes == 30 else 20)
    near = np.sort(rng.uniform(40, 120, number))
    return zones.Zones(
        near + rng.uniform(0, 5, (classes, number)),
        np.sort(rng.gamma(1, 2, classes))[::-1],
        pods,
        np.full(number, np.ceil(pods.sum() / number / 0.85)),
        rng.uniform(0, 0.05, number),
    )


@pytest.mark.benchmark(group="storage: zones")
@pytest.mark.parametrize("size", ZONES)
def test_zones(benchmark: Any, note: Any, size: str) -> None:
    data = steady_state(*ZONES[size])
    zones.solve(data)  # compiles the programme of this size, once and for all
    solution = benchmark(zones.solve, data)
    assert solution.status is Status.OPTIMAL
    assert solution.objective <= zones.solve(data, "greedy").objective * (1 + 1e-6)
    assert solution.build_s < solution.solve_s
    note(
        "storage.zones",
        size,
        "clarabel",
        solution,
        f"{ZONES[size][0]} classes, {ZONES[size][1]} zones",
    )


def half_an_hour(number: int, count: int) -> stays.Stays:
    rng = np.random.default_rng(7)
    begin = rng.uniform(0, 1800, number)
    near = np.sort(rng.uniform(20, 90, count))
    cost = near * rng.uniform(0.5, 1.5, (number, 1)) + rng.uniform(0, 15, (number, count))
    end = begin + rng.gamma(2, 200, number) + 30
    crowd = stays.Stays(begin, end, cost, np.full(count, number))
    most = int(crowd.present(np.zeros(number, np.int64), 0).max())
    return stays.Stays(begin, end, cost, np.full(count, -(-most * 11 // (10 * count))))


@pytest.mark.benchmark(group="storage: stays")
@pytest.mark.parametrize("method", ["highs", "cp_sat"])
@pytest.mark.parametrize("size", STAYS)
def test_stays(benchmark: Any, note: Any, size: str, method: str) -> None:
    data = half_an_hour(*STAYS[size])
    start = stays.solve(data, "greedy").required
    limits = Limits(deterministic_s=3.0, nodes=50, gap=1e-3)
    solution = benchmark.pedantic(stays.solve, (data, method, limits), {"start": start}, rounds=3)
    assert solution.objective <= stays.objective(data, start) + 1e-6
    assert solution.gap < 0.02
    note("storage.stays", size, method, solution, f"{STAYS[size][0]} stays, {STAYS[size][1]} zones")


@pytest.mark.benchmark(group="storage: two zones")
@pytest.mark.parametrize("size", STAYS)
def test_two_zones(benchmark: Any, note: Any, size: str) -> None:
    many = half_an_hour(*STAYS[size])
    data = stays.Stays(many.begin_s, many.end_s, many.cost_s[:, [0, -1]], [20, 500])
    solution = benchmark(stays.solve, data, "flow")
    assert solution.gap < 1e-6
    note("storage.stays", size, "flow", solution, f"{STAYS[size][0]} stays, 2 zones")
