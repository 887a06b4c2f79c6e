"""Invalid inputs first, then the edges of valid ones, then what an input derives."""

from dataclasses import replace

import numpy as np
import pytest

from rmfs.solvers.models import Limits, ModelError, Status
from rmfs.solvers.models.pile_on import (
    PileOn,
    Pruning,
    Variant,
    Weights,
    cp_sat,
    greedy,
    hadgs,
    highs,
    joint,
    methods,
    neighbourhood,
    objective,
    solve,
    violations,
)
from rmfs.solvers.models.pile_on.values import nothing

SOLVERS = [cp_sat, highs, greedy, hadgs, neighbourhood, joint]


def example(**changes: object) -> PileOn:
    """Two orders for SKUs 0 and 1, a pod for each SKU and one inbound with both; 2 stations."""
    fields: dict[str, object] = {
        "slots": [1, 2],
        "line_order": [0, 0, 1],
        "line_sku": [0, 1, 1],
        "line_units": [1, 2, 1],
        "stock": [[5, 0], [0, 5], [1, 1]],
        "travel": [[10.0, 20.0], [15.0, 5.0], [0.0, 0.0]],
        "available": [True, True, False],
        "inbound": [-1, -1, 1],
        "open_units": [[0, 0], [1, 0]],
        "fetch": [[3.0, 4.0, 9.0], [2.0, 8.0, 9.0]],
    }
    return PileOn(**(fields | changes))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("field", "value", "named"),
    [
        ("slots", [1, -1], "slots[1]"),
        ("slots", [[1]], "slots"),
        ("line_order", [0, 0, 2], "line_order"),
        ("line_order", [1, 1, 1], "line_order"),
        ("line_order", [1, 0, 0], "line_order"),
        ("line_sku", [0, 0, 1], "line_sku"),
        ("line_sku", [1, 0, 1], "line_sku"),
        ("line_sku", [0, 1, 2], "line_sku[2]"),
        ("line_units", [1, 2, 0], "line_units[2]"),
        ("line_units", [1, 2.5, 1], "line_units"),
        ("stock", [[5, 0], [0, -5], [1, 1]], "stock[1, 1]"),
        ("travel", [[10.0, 20.0]], "travel"),
        ("travel", [[10.0, np.nan], [15.0, 5.0], [0.0, 0.0]], "travel"),
        ("travel", [[10.0, -1.0], [15.0, 5.0], [0.0, 0.0]], "travel[0, 1]"),
        ("available", [True, True, True], "available"),
        ("available", [2, 0, 0], "available[0]"),
        ("inbound", [-1, -1, 2], "inbound[2]"),
        ("open_units", [[0, 0]], "open_units"),
        ("fetch", [[3.0, 4.0]], "fetch"),
        ("robot_pod", [0, 3], "robot_pod[1]"),
        ("robot_pod", [0, 0], "robot_pod"),
        ("worth", [1.0], "worth"),
    ],
)
def test_an_invalid_field_is_named(field: str, value: object, named: str) -> None:
    with pytest.raises(ModelError) as error:
        example(**{field: value})
    assert error.value.field == named


def test_bound_robots_need_a_fleet() -> None:
    with pytest.raises(ModelError, match="needs fetch"):
        example(fetch=None, robot_pod=[0])


def test_invalid_weights_and_pruning_are_named() -> None:
    with pytest.raises(ModelError, match="empty_slot"):
        Weights(empty_slot=-1)
    with pytest.raises(ModelError, match="pods_per_sku"):
        Pruning(pods_per_sku=0)
    with pytest.raises(ModelError, match="gap"):
        Limits(gap=-0.1)


def test_inbound_stock_serves_open_demand_first() -> None:
    data = example()
    assert data.surplus.tolist() == [[0, 0], [0, 1]]
    assert data.shortage.tolist() == [[0, 0], [0, 0]]
    short = example(open_units=[[0, 0], [3, 0]])
    assert short.shortage.tolist() == [[0, 0], [2, 0]]


@pytest.mark.parametrize("solver", SOLVERS)
def test_the_inbound_pod_fills_what_it_can_and_one_pod_more_the_rest(solver: object) -> None:
    # Order 1 needs one unit of SKU 1, which the inbound pod has to spare; order 0 needs both pods.
    solution = solver.solve(example(weights=Weights(prospects=False)))
    if solver is hadgs:
        # Station 0 comes first and takes order 1; then no two pods are left for order 0.
        assert solution.required.slot.tolist() == [[False, False], [True, False]]
    else:
        assert solution.required.slot.sum() == 2
        assert solution.required.slot[1].tolist() == [False, True]


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize(
    "changes",
    [
        {"line_order": [], "line_sku": [], "line_units": []},
        {"slots": [0, 0]},
        {"available": [False, False, False]},
        {"stock": [[0, 0], [0, 0], [0, 0]]},
        {"fetch": np.zeros((0, 3))},
        {"fetch": None},
        {
            "slots": [],
            "travel": np.zeros((3, 0)),
            "inbound": [-1, -1, -1],
            "open_units": np.zeros((0, 2)),
        },
        {
            "stock": np.zeros((0, 2)),
            "travel": np.zeros((0, 2)),
            "available": [],
            "inbound": [],
            "fetch": np.zeros((2, 0)),
        },
    ],
)
@pytest.mark.parametrize("variant", Variant)
def test_degenerate_inputs_are_answered(solver: object, changes: dict, variant: Variant) -> None:
    data = example(variant=variant, **changes)
    solution = solver.solve(data)
    assert violations(data, solution.required) == []
    assert solution.objective <= objective(data, nothing(data))


def test_an_infeasible_start_is_refused() -> None:
    data = example()
    wrong = replace(nothing(data), pod_station=np.array([0, -1, -1]))
    assert violations(data, wrong)
    for solver in (cp_sat, highs):
        with pytest.raises(ModelError, match="start"):
            solver.solve(data, start=wrong)


def test_without_time_the_start_is_the_answer() -> None:
    data = example()
    start = greedy.solve(data)
    solution = cp_sat.solve(data, Limits(deterministic_s=0.0), start=start.values)
    assert solution.objective <= start.objective
    assert solution.status in (Status.FEASIBLE, Status.OPTIMAL)


def test_violations_name_each_broken_rule() -> None:
    data = example()
    good = cp_sat.solve(data).required
    full = np.ones_like(good.slot)
    broken = {
        "more orders than it has slots": replace(good, slot=full),
        "slots at several stations": replace(good, slot=full),
        "open line": replace(good, line_station=np.full(3, -1)),
        "has no slot": replace(good, slot=~full),
        "not available": replace(good, pod_station=np.array([-1, -1, 0])),
        "no robot": replace(good, pod_robot=np.full(3, -1)),
        "fetches two": replace(good, pod_robot=np.array([0, 0, -1])),
        "but needs none": replace(nothing(data), pod_robot=np.array([0, -1, -1])),
        "serves no order": replace(nothing(data), pod_station=np.array([0, -1, -1])),
        "does not cover": replace(nothing(data), prospect=np.array([0, -1])),
    }
    assert violations(data, good) == []
    for text, values in broken.items():
        assert any(text in line for line in violations(data, values)), text


def test_a_worth_per_unit_prefers_large_orders() -> None:
    """One slot, a pod for each of two orders; the far pod serves four units, the near one one."""
    data = PileOn(
        slots=[1],
        line_order=[0, 1],
        line_sku=[0, 1],
        line_units=[1, 4],
        stock=[[1, 0], [0, 4]],
        travel=[[10.0], [30.0]],
        available=[1, 1],
        inbound=[-1, -1],
        open_units=np.zeros((1, 2)),
    )
    for unit, chosen in ((0.0, 0), (5.0, 0), (10.0, 1)):
        priced = replace(data, weights=Weights(unit=unit, prospects=False))
        for method in ("cp_sat", "highs", "joint", "greedy", "hadgs"):
            found = solve(priced, method).required
            assert found.slot[:, 0].tolist() == [chosen == 0, chosen == 1], (unit, method)


def test_pods_come_only_where_they_may_be_called() -> None:
    data = PileOn(
        slots=[1, 1],
        line_order=[0, 1],
        line_sku=[0, 0],
        line_units=[1, 1],
        stock=[[5], [5]],
        travel=[[1.0, 2.0], [1.0, 2.0]],
        available=[1, 1],
        inbound=[-1, -1],
        open_units=np.zeros((2, 1)),
        may_call=[0, 1],
    )
    for method in methods():
        found = solve(data, method)
        assert found.required.pod_station[found.required.pod_station >= 0].tolist() == [1]
        assert violations(data, found.required) == []
    elsewhere = replace(found.required, pod_station=np.array([0, 1]))
    assert "pod is called to a station that may call none: 0" in violations(data, elsewhere)
