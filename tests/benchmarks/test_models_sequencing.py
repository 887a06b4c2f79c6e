"""How long rack sequencing at one station takes, at three sizes up to a day's wave of orders."""

from typing import Any

import pytest

from rmfs.solvers.models import Limits
from rmfs.solvers.models.sequencing import beam, cp_sat, dynamic, violations
from rmfs.solvers.models.sequencing.sample import station

SIZES = {"small": (8, 10, 12, 3), "medium": (30, 60, 60, 6), "large": (200, 300, 250, 12)}
"""Orders, pods, SKUs and slots of one station."""


def what(size: str) -> str:
    orders, pods, skus, slots = SIZES[size]
    return f"{orders} orders, {pods} pods, {skus} SKUs, {slots} slots"


@pytest.mark.benchmark(group="sequencing")
def test_dynamic(benchmark: Any, note: Any) -> None:
    solution = benchmark.pedantic(dynamic.solve, (station(*SIZES["small"], seed=7),), rounds=3)
    assert solution.gap == 0.0
    note("sequencing", "small", solution, what("small"))


@pytest.mark.benchmark(group="sequencing")
@pytest.mark.parametrize("size", SIZES)
def test_beam(benchmark: Any, note: Any, size: str) -> None:
    data = station(*SIZES[size], seed=7)
    solution = benchmark.pedantic(beam.solve, (data,), rounds=1)
    assert not violations(data, solution.required)
    note("sequencing", size, solution, what(size))


@pytest.mark.benchmark(group="sequencing")
@pytest.mark.parametrize("size", ["small", "medium"])
def test_cp_sat(benchmark: Any, note: Any, size: str) -> None:
    data = station(*SIZES[size], seed=7)
    start = beam.solve(data)
    limits = Limits(deterministic_s=5.0)
    solution = benchmark.pedantic(cp_sat.solve, (data, limits), {"start": start.required}, rounds=1)
    assert solution.objective <= start.objective
    note("sequencing", size, solution, what(size))
