"""How long rack allocation takes, at three sizes up to a real site's."""

from typing import Any

import pytest

from rmfs.solvers.models import Limits
from rmfs.solvers.models.rack_allocation import solve_by_cp_sat, solve_by_highs, solve_greedily
from rmfs.solvers.models.rack_allocation.sample import site

SIZES = {
    "small": (30, 60, 60, 2, 6),
    "medium": (100, 300, 300, 6, 8),
    "large": (200, 1200, 1000, 12, 8),
}
"""Orders, pods, SKUs, stations and slots of each; the large one is a real site's."""

BACKENDS = {"cp_sat": solve_by_cp_sat, "highs": solve_by_highs, "rule": solve_greedily}


CASES = [(size, backend) for size in SIZES for backend in BACKENDS]
CASES.remove(("large", "highs"))  # its root node alone takes minutes


@pytest.mark.benchmark(group="rack allocation")
@pytest.mark.parametrize(("size", "backend"), CASES)
def test_rack_allocation(benchmark: Any, note: Any, size: str, backend: str) -> None:
    data = site(*SIZES[size], seed=7)
    start = solve_greedily(data)
    limits = Limits(deterministic_s=1.0, nodes=1)
    solution = benchmark.pedantic(
        BACKENDS[backend], (data, limits), {"start": start.values}, rounds=1
    )
    assert solution.objective <= start.objective
    orders, pods, skus, stations, _ = SIZES[size]
    note(
        "rack_allocation",
        size,
        solution,
        f"{stations} stations, {pods} pods, {skus} SKUs, {orders} orders",
    )
