"""How long planning several visits takes, at three sizes up to the large site."""

from typing import Any

import pytest
from planning_sample import planning

from rmfs.solvers.models import Limits
from rmfs.solvers.models.planning import solve, violations

SIZES = {"small": (2, 100, 100, 100), "medium": (6, 120, 500, 400), "large": (12, 200, 1200, 1000)}
"""Stations, orders, pods and SKUs."""
STEPS = 300


def what(size: str) -> str:
    stations, orders, pods, skus = SIZES[size]
    return f"{stations} stations, {pods} pods, {skus} SKUs, {orders} orders"


@pytest.mark.benchmark(group="planning")
@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("method", ["greedy", "lns"])
def test_heuristics(benchmark: Any, note: Any, method: str, size: str) -> None:
    stations, orders, pods, skus = SIZES[size]
    data = planning(
        stations=stations, slots=6, orders=orders, pods=pods, skus=skus, visits=6, seed=7
    )
    limits = Limits(iterations=STEPS)
    solution = benchmark.pedantic(solve, (data, method, limits), rounds=3)
    assert not violations(data, solution.required)
    note("planning", size, method, solution, what(size))
