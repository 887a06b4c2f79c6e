"""How long rack sequencing at one station takes, at three sizes up to a day's wave of orders."""

from typing import Any

import pytest
from sequencing_sample import station

from rmfs.solvers.models import Limits
from rmfs.solvers.models.sequencing import solve, violations

SIZES = {"small": (8, 10, 12, 3), "medium": (30, 60, 60, 6), "large": (200, 300, 250, 12)}
"""Orders, pods, SKUs and slots of one station."""


def what(size: str) -> str:
    orders, pods, skus, slots = SIZES[size]
    return f"{orders} orders, {pods} pods, {skus} SKUs, {slots} slots"


@pytest.mark.benchmark(group="sequencing")
def test_dynamic(benchmark: Any, note: Any) -> None:
    solution = benchmark.pedantic(solve, (station(*SIZES["small"], seed=7), "dynamic"), rounds=3)
    assert solution.gap == 0.0
    note("sequencing", "small", "dynamic", solution, what("small"))


@pytest.mark.benchmark(group="sequencing")
@pytest.mark.parametrize("size", SIZES)
def test_beam(benchmark: Any, note: Any, size: str) -> None:
    data = station(*SIZES[size], seed=7)
    solution = benchmark.pedantic(solve, (data, "beam"), rounds=1)
    assert not violations(data, solution.required)
    note("sequencing", size, "beam", solution, what(size))


@pytest.mark.benchmark(group="sequencing")
@pytest.mark.parametrize("size", ["small", "medium"])
def test_cp_sat(benchmark: Any, note: Any, size: str) -> None:
    data = station(*SIZES[size], seed=7)
    start = solve(data, "beam")
    limits = Limits(deterministic_s=5.0)
    solution = benchmark.pedantic(
        solve, (data, "cp_sat", limits), {"start": start.required}, rounds=1
    )
    assert solution.objective <= start.objective
    note("sequencing", size, "cp_sat", solution, what(size))
