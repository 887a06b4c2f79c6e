"""Plans of several visits: methods against enumeration and each other, bounds, bad input."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from plain_filling import Filling
from planning_oracle import best
from planning_sample import planning

from rmfs.solvers.models import Limits, ModelError, Status
from rmfs.solvers.models.planning import (
    Plan,
    Planning,
    methods,
    nothing,
    objective,
    solve,
    violations,
)
from rmfs.solvers.models.planning.compiled import found, visits
from rmfs.solvers.models.planning.program import Programme

METHODS = methods()
TINY: list[dict[str, int]] = [
    {"stations": 1, "slots": 2, "orders": 2, "pods": 3, "skus": 2, "visits": 2},
    {"stations": 2, "slots": 2, "orders": 2, "pods": 3, "skus": 2, "visits": 1},
    {"stations": 1, "slots": 1, "orders": 3, "pods": 3, "skus": 2, "visits": 1},
]


def hand_made(**changes: Any) -> Planning:
    """Two orders, one of two lines; a pod under way with the first SKU, others with the second."""
    given: dict[str, Any] = {
        "slots": [2],
        "coming": [0],
        "coming_to": [0],
        "order_station": [-1, -1],
        "order_until": [-1, -1],
        "order_worth": [5.0, 5.0],
        "line_order": [0, 0, 1],
        "line_sku": [0, 1, 0],
        "line_units": [1, 2, 3],
        "line_worth": [10.0, 20.0, 30.0],
        "stock": [[4, 0], [0, 2], [0, 9]],
        "cost": [[np.inf], [12.0], [13.0]],
        "visits": 2,
        "decay": 0.5,
    }
    return Planning(**{**given, **changes})


@pytest.mark.parametrize("sizes", TINY)
@pytest.mark.parametrize("seed", range(8))
def test_exact_is_what_enumeration_finds(sizes: dict[str, int], seed: int) -> None:
    """Both solvers prove the least objective; others and prices keep to their side of it."""
    data = planning(**sizes, seed=seed)
    least = best(data)
    for method in ("cp_sat", "highs"):
        exact = solve(data, method)
        assert exact.status is Status.OPTIMAL
        assert exact.objective == pytest.approx(least, abs=1e-6)
    for method in ("greedy", "lns"):
        found = solve(data, method, bound_steps=30)
        assert found.objective >= least - 1e-6
        assert found.bound <= least + 1e-6


@pytest.mark.parametrize("method", METHODS)
def test_every_method_gives_feasible_plans(method: str) -> None:
    """Feasible, with the objective recomputed, and never worse than doing nothing."""
    for seed in range(12):
        data = planning(seed=seed)
        found = solve(data, method, Limits(iterations=20, deterministic_s=2.0))
        assert violations(data, found.required) == []
        assert found.objective == pytest.approx(objective(data, found.required))
        assert found.objective <= objective(data, nothing(data)) + 1e-9


def test_the_search_improves_on_the_start_rule() -> None:
    """Not worse on any input, and better on most of those with a choice."""
    better = 0
    for seed in range(20):
        data = planning(orders=12, pods=10, skus=8, visits=3, seed=seed)
        rule, found = solve(data, "greedy"), solve(data, "lns")
        assert found.objective <= rule.objective + 1e-9
        better += found.objective < rule.objective - 1e-6
    assert better > 10


def test_the_search_repeats_and_depends_on_its_seed() -> None:
    """The same seed gives the same plan; over many inputs another seed gives another one."""
    others = 0
    for seed in range(10):
        data = planning(orders=12, pods=10, skus=8, visits=3, seed=seed)
        limits = Limits(iterations=5)
        first, again = (solve(data, "lns", limits, seed=1) for _ in range(2))
        assert first.required.pods == again.required.pods
        assert first.work == again.work
        others += first.required.pods != solve(data, "lns", limits, seed=2).required.pods
    assert others


@pytest.mark.parametrize("seed", range(40))
def test_the_compiled_filling_is_the_plain_one(seed: int) -> None:
    """Any visits of any stations serve the same lines by either, and are worth the same."""
    rng = np.random.default_rng(seed)
    sizes = {"stations": (1, 5), "slots": (1, 5), "orders": (1, 40), "pods": (5, 30),
             "skus": (1, 14), "visits": (1, 6)}  # fmt: skip
    data = planning(**{name: int(rng.integers(*span)) for name, span in sizes.items()}, seed=seed)
    pods: list[list[int]] = [[] for _ in range(data.stations)]
    for pod in rng.permutation(np.arange(1, data.pods)).tolist():
        station = int(rng.integers(data.stations))
        if len(pods[station]) < data.visits:
            pods[station].append(pod)
    plain, compiled = Filling(data).draft(pods), found(visits(data).filled(pods))
    assert [list(new) for new in compiled.plan.pods] == plain.pods
    assert compiled.plan.order_station.tolist() == plain.order_station
    assert compiled.plan.line_visit.tolist() == plain.line_visit
    assert compiled.value == pytest.approx(plain.value)


def test_a_plan_goes_on_from_the_last_one() -> None:
    """Visits of a start are kept by the rule; those that are impossible now are left out."""
    data = hand_made()
    assert solve(data, "greedy", pods=[[2]]).required.pods[0] == (2,)
    assert solve(data, "greedy", pods=[[0, 1]]).required.pods[0] == (1,)


def test_a_start_is_kept_unless_it_is_wrong() -> None:
    """No method gives less than a feasible start; one that is not feasible is refused."""
    for seed in range(6):
        data = planning(seed=seed)
        start = solve(data, "cp_sat").required
        for method in METHODS:
            found = solve(data, method, Limits(iterations=3), start=start)
            assert found.objective <= objective(data, start) + 1e-9
    wrong = Plan(((0,),), np.array([-1, 0]), np.array([-1, -1, 0]))
    for method in METHODS:
        with pytest.raises(ModelError, match="may not be called there"):
            solve(hand_made(), method, start=wrong)


def test_orders_of_several_pods_keep_a_slot() -> None:
    """With slots to keep one order the order of two pods is served, without it is not."""
    assert solve(hand_made()).required.order_station.tolist() == [0, 0]
    single = solve(hand_made(slots=[1]))
    assert single.required.order_station.tolist() == [-1, 0]
    assert solve(hand_made(slots=[1]), "cp_sat").objective == single.objective


def test_an_order_that_needs_two_new_pods_is_begun() -> None:
    """Neither pod alone serves anything; together they pay."""
    data = hand_made(
        coming=[], coming_to=[], order_station=[-1], order_until=[-1], order_worth=[5.0],
        line_order=[0, 0], line_sku=[0, 1], line_units=[1, 2], line_worth=[10.0, 20.0],
        cost=[[3.0], [4.0], [5.0]],
    )  # fmt: skip
    for method in METHODS:
        assert sorted(solve(data, method).required.pods[0]) == [0, 1]


def test_objective_by_hand() -> None:
    """The second visit counts half: cost 12, line 20 and the order's 5 at its end."""
    data = hand_made()
    plan = Plan(((1,),), np.array([0, 0]), np.array([0, 1, 0]))
    assert violations(data, plan) == []
    assert objective(data, plan) == pytest.approx(0.5 * 12 - (10 + 30 + 0.5 * 20) - (0.5 * 5 + 5))
    assert solve(data, "cp_sat").objective == pytest.approx(objective(data, plan))


@pytest.mark.parametrize(
    ("plan", "complaint"),
    [
        (Plan(((1, 1),), np.array([0, 0]), np.array([0, 1, 0])), "two new visits"),
        (Plan(((0,),), np.array([-1, 0]), np.array([-1, -1, 0])), "may not be called there"),
        (Plan(((1,),), np.array([0, 0]), np.array([0, -1, 0])), "all its lines served"),
        (Plan(((1,),), np.array([0, 0]), np.array([0, 2, 0])), "does not exist"),
        (Plan(((1,),), np.array([0, 0]), np.array([0, 0, 0])), "too few units"),
        (Plan(((1,),), np.array([-1, 0]), np.array([-1, -1, 0])), "serves no line"),
        (Plan(((1, 2, 3),), np.array([0, 0]), np.array([0, 1, 0])), "more than"),
    ],
)
def test_violations_say_what_is_wrong(plan: Plan, complaint: str) -> None:
    """Each rule of a plan is checked on its own."""
    data = hand_made(stock=[[4, 0], [0, 2], [0, 9], [0, 0]], cost=[[np.inf], [12.0], [13.0], [1.0]])
    assert any(complaint in found for found in violations(data, plan))


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"slots": [0]}, "slots"),
        ({"coming": [0, 0], "coming_to": [0, 0]}, "coming"),
        ({"cost": [[1.0], [12.0], [13.0]]}, "cost"),
        ({"line_order": [0, 0, 0]}, "line_order"),
        ({"line_units": [0, 1, 1]}, "line_units"),
        ({"order_until": [0, -1]}, "order_until"),
        ({"order_station": [0, -1], "order_until": [1, -1]}, "order_until"),
        ({"decay": 0.0}, "decay"),
        ({"decay": 1.5}, "decay"),
        ({"visits": -1}, "visits"),
        ({"line_worth": [1.0, 2.0, np.nan]}, "line_worth"),
    ],
)
def test_bad_input_is_refused(changes: dict[str, Any], field: str) -> None:
    """The error names the field."""
    with pytest.raises(ModelError) as error:
        hand_made(**changes)
    assert error.value.field.split("[")[0] == field


@pytest.mark.parametrize("method", METHODS)
def test_nothing_to_do(method: str) -> None:
    """Without orders, or without visits, there is a plan: none."""
    data = hand_made()
    none = np.zeros(0)
    empty = replace(
        data, order_station=none, order_until=none, order_worth=none,
        line_order=none, line_sku=none, line_units=none, line_worth=none,
    )  # fmt: skip
    assert solve(empty, method).objective == 0.0
    still = solve(replace(data, visits=0), method)
    assert still.required.pods == ((),)
    assert still.required.order_station.tolist() == [-1, 0]


@pytest.mark.parametrize("method", ["cp_sat", "highs"])
def test_exact_methods_state_the_size_of_their_program(method: str) -> None:
    """The pacing `work` charges for every nonzero."""
    data = hand_made()
    assert solve(data, method).built == Programme(data).linear.nonzeros > 0
