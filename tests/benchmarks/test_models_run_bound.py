"""How long the bound of a whole run takes: default, medium and large site."""

from typing import Any

import numpy as np
import pytest

from rmfs.solvers.models.run_bound import (
    Orders,
    PickStations,
    Refill,
    RunBound,
    Stock,
    single_bounds,
    solve,
)

SIZES = {"small": (2, 2, 100, 10), "medium": (4, 4, 500, 32), "large": (12, 6, 1200, 128)}
"""Pick stations, replenishment stations, pods, robots."""


def site(picking: int, refilling: int, pods: int, robots: int) -> RunBound:
    rng = np.random.default_rng(7)
    content = rng.integers(40, 160, pods)
    return RunBound(
        4 * 3600.0,
        robots,
        PickStations(
            np.full(picking, 10.0),
            np.full(picking, 3.0),
            np.full(picking, 8.0),
            rng.uniform(8, 12, picking),
            rng.uniform(8, 12, picking),
            np.full(picking, 8),
        ),
        Refill(
            np.full(refilling, 10.0),
            rng.uniform(8, 12, refilling),
            rng.uniform(8, 12, refilling),
            12,
            20,
        ),
        Stock(content, int(content.max())),
        Orders(units=60_000.0, largest_order_units=12.0, lone_units=30_000.0),
    )


@pytest.mark.benchmark(group="run bound")
@pytest.mark.parametrize("size", SIZES)
def test_run_bound(benchmark: Any, note: Any, size: str) -> None:
    data = site(*SIZES[size])
    solution = benchmark(solve, data)
    assert solution.gap < 1e-6
    assert solution.bound <= min(single_bounds(data).values()) * (1 + 1e-9)
    picking, refilling, pods, robots = SIZES[size]
    what = f"{picking} + {refilling} stations, {pods} pods, {robots} robots"
    note("run_bound", size, "highs", solution, what)
