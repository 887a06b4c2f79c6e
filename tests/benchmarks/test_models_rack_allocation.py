"""How long rack allocation takes, at three sizes up to a real site's."""

from typing import Any

import pytest
from rack_allocation_sample import site

from rmfs.solvers.models import Limits
from rmfs.solvers.models.rack_allocation import methods, solve

SIZES = {
    "small": (30, 60, 60, 2, 6),
    "medium": (100, 300, 300, 6, 8),
    "large": (200, 1200, 1000, 12, 8),
}
"""Orders, pods, SKUs, stations and slots of each; the large one is a real site's."""

CASES = [(size, method) for size in SIZES for method in methods()]
CASES.remove(("large", "highs"))  # its root node alone takes minutes


@pytest.mark.benchmark(group="rack allocation")
@pytest.mark.parametrize(("size", "method"), CASES)
def test_rack_allocation(benchmark: Any, note: Any, size: str, method: str) -> None:
    data = site(*SIZES[size], seed=7)
    start = solve(data, "greedy")
    limits = Limits(deterministic_s=1.0, nodes=1)
    solution = benchmark.pedantic(solve, (data, method, limits), {"start": start.values}, rounds=1)
    assert solution.objective <= start.objective
    orders, pods, skus, stations, _ = SIZES[size]
    note(
        "rack_allocation",
        size,
        method,
        solution,
        f"{stations} stations, {pods} pods, {skus} SKUs, {orders} orders",
    )
