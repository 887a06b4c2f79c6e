"""How long replenishment takes, at three sizes up to a real site's."""

from typing import Any

import numpy as np
import pytest

from rmfs.solvers.models import Limits
from rmfs.solvers.models.replenishment import (
    Replenishment,
    best_pods,
    bundle_worth_s,
    methods,
    solve,
)

SIZES = {"small": (20, 100, 2, 100), "medium": (60, 400, 4, 400), "large": (200, 1200, 6, 1000)}
"""Bundles, pods, stations, SKUs."""


def stock_of(rng: np.random.Generator, skus: int, pods: int) -> np.ndarray:
    """About ten SKUs in a pod."""
    held: np.ndarray = rng.poisson(8, (skus, pods)) * (rng.random((skus, pods)) < 10 / skus)
    return held


def site(bundles: int, pods: int, stations: int, skus: int) -> Replenishment:
    rng = np.random.default_rng(7)
    popularity = rng.gamma(1, 2, skus)
    popularity /= popularity.sum()
    units = rng.integers(4, 13, bundles)
    affinity = np.zeros((skus, skus))
    affinity[rng.integers(0, skus, 5 * skus), rng.integers(0, skus, 5 * skus)] = rng.uniform(
        0, 0.3, 5 * skus
    )
    worth_s = bundle_worth_s(
        stock_of(rng, skus, pods),
        rng.choice(skus, bundles, p=popularity),
        units,
        popularity * 600,
        affinity,
        visit_s=80.0,
        pile_on=2.5,
    )
    return Replenishment(
        worth_s,
        np.full(bundles, 5.0),
        units * rng.uniform(2, 8, bundles),
        rng.uniform(20, 250, pods),
        rng.uniform(40, 120, (pods, stations)),
        np.full(stations, 1000.0),
    )


@pytest.mark.benchmark(group="replenishment")
@pytest.mark.parametrize("method", methods())
@pytest.mark.parametrize("size", SIZES)
def test_replenishment(benchmark: Any, note: Any, size: str, method: str) -> None:
    data = best_pods(site(*SIZES[size]), pods=5, stations=2)
    start = solve(data, "greedy")
    limits = Limits(deterministic_s=1.0, nodes=1, gap=0.05)
    solution = benchmark.pedantic(
        solve, (data, method, limits), {"start": start.required}, rounds=1
    )
    # rules begin from nothing, so they may also be a little worse than the start
    assert solution.objective <= 0.95 * start.objective
    bundles, pods, stations, _ = SIZES[size]
    note(
        "replenishment",
        size,
        method,
        solution,
        f"{bundles} bundles, {pods} pods, {stations} stations",
    )


@pytest.mark.benchmark(group="replenishment: worth")
@pytest.mark.parametrize("size", SIZES)
def test_worth(benchmark: Any, size: str) -> None:
    bundles, pods, _, skus = SIZES[size]
    rng = np.random.default_rng(7)
    stock = stock_of(rng, skus, pods)
    sku, units = rng.integers(0, skus, bundles), np.full(bundles, 8)
    wanted, affinity = np.full(skus, 0.6), rng.random((skus, skus)) * 0.01
    worth_s = benchmark(
        bundle_worth_s, stock, sku, units, wanted, affinity, visit_s=80.0, pile_on=2.5
    )
    assert worth_s.shape == (bundles, pods)
