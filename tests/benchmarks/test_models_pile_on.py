"""How long the pile-on models take at three sizes up to a real site's, and what pruning loses."""

from dataclasses import replace
from typing import Any

import pytest
from pile_on_sample import LARGE, MEDIUM, SMALL, Size, snapshot

from rmfs.solvers.models import Limits
from rmfs.solvers.models.pile_on import Pruning, objective, prune, solve
from rmfs.solvers.models.pile_on.relaxation import PileOnRelaxation

SIZES = {"small": SMALL, "medium": MEDIUM, "large": LARGE}


def what(size: Size) -> str:
    return f"{size.stations} stations, {size.pods} pods, {size.skus} SKUs, {size.orders} orders"


@pytest.mark.benchmark(group="pile-on: rules")
@pytest.mark.parametrize("rule", ["greedy", "hadgs"])
@pytest.mark.parametrize("size", SIZES)
def test_rules(benchmark: Any, note: Any, size: str, rule: str) -> None:
    data = snapshot(SIZES[size], 7)
    solution = benchmark.pedantic(solve, (data, rule), rounds=3)
    note("pile_on", size, rule, solution, what(SIZES[size]))


@pytest.mark.benchmark(group="pile-on: joint")
@pytest.mark.parametrize("size", SIZES)
def test_joint(benchmark: Any, note: Any, size: str) -> None:
    """What controllers ask, with their limit of work and their steps for a bound."""
    data = snapshot(SIZES[size], 7)
    limits = Limits(deterministic_s=0.02)
    solution = benchmark.pedantic(solve, (data, "joint", limits), {"bound_steps": 20}, rounds=3)
    assert solution.objective <= solve(data, "greedy").objective + 1e-6
    note("pile_on", size, "joint", solution, what(SIZES[size]))


@pytest.mark.benchmark(group="pile-on: exact")
@pytest.mark.parametrize("method", ["cp_sat", "highs"])
@pytest.mark.parametrize("size", SIZES)
def test_exact(benchmark: Any, note: Any, size: str, method: str) -> None:
    """Over pruned pairs at the larger sizes, from what pod match finds."""
    data = snapshot(SIZES[size], 7)
    start = solve(data, "greedy").required
    given = {"start": start, "candidates": None if size == "small" else prune(data)}
    limits = Limits(deterministic_s=1.0, nodes=1)
    solution = benchmark.pedantic(solve, (data, method, limits), given, rounds=1)
    assert solution.objective <= objective(data, start) + 1e-6
    note("pile_on", size, method, solution, what(SIZES[size]))


@pytest.mark.benchmark(group="pile-on: relaxation")
@pytest.mark.parametrize("size", ["small", "medium"])
def test_relaxation(benchmark: Any, note: Any, size: str) -> None:
    """The bound by Clarabel, compiled once and re-solved; not for large sites (see there)."""
    data = snapshot(SIZES[size], 7)
    relaxation = PileOnRelaxation()
    relaxation.solve(data)
    found = benchmark.pedantic(relaxation.solve, (data,), rounds=1)
    rule = solve(data, "greedy")
    assert relaxation.compilations == 1
    assert found.bound <= rule.objective
    known = replace(
        rule,
        bound=found.bound,
        wall_s=found.wall_s,
        build_s=found.build_s,
        work=found.work,
    )
    note("pile_on", size, "relaxation", known, what(SIZES[size]))


@pytest.mark.benchmark(group="pile-on: pruning")
@pytest.mark.parametrize(
    ("pods_per_sku", "orders_per_slot"), [(2, 64), (4, 16), (4, 64), (8, 64), (4, 200)]
)
def test_what_pruning_loses(benchmark: Any, pods_per_sku: int, orders_per_slot: int) -> None:
    """Objective over pruned pairs against that over all, each from the same rule and limit."""
    limits = Limits(deterministic_s=2.0)

    def lost() -> list[float]:
        losses = []
        for seed in range(5):
            data = snapshot(SMALL, seed)
            start = solve(data, "greedy").required
            every = solve(data, "cp_sat", limits, start=start)
            few = prune(data, Pruning(pods_per_sku, orders_per_slot))
            kept = solve(data, "cp_sat", limits, start=start, candidates=few)
            losses.append(kept.objective - every.bound)
            assert losses[-1] >= -1e-6
        return losses

    losses = benchmark.pedantic(lost, rounds=1)
    benchmark.extra_info |= {
        "pods_per_sku": pods_per_sku,
        "orders_per_slot": orders_per_slot,
        "lost": losses,
    }
    # a slot left empty costs 1,000: what is lost are metres of travel
    assert max(losses) < 1000.0
