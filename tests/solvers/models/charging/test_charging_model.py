"""The charging model: against enumeration of all plans, and what it should do in plain cases."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise, product
from typing import Any

import numpy as np
import pytest
from decision_samples import sample
from hypothesis import given
from hypothesis import strategies as some

from rmfs.solvers.decisions.models import model_data
from rmfs.solvers.models import Limits, ModelError, Status
from rmfs.solvers.models.charging import (
    AWAY,
    ChargePlan,
    Charging,
    methods,
    objective,
    solve,
    violations,
)


def small(seed: int) -> Charging:
    data = model_data(sample("charging", seed))
    assert isinstance(data, Charging)
    return data


def enumerated(data: Charging) -> float:
    """Least cost over all plans that break no rule."""
    stays = [(AWAY, 0, 0)]
    stays += product(range(len(data.gain)), range(data.slots), range(1, data.longest + 1))
    best = np.inf
    for chosen in product(stays, repeat=data.robots):
        plan = ChargePlan(*(np.array(part) for part in zip(*chosen, strict=True)))
        if not violations(data, plan):
            best = min(best, objective(data, plan))
    return best


@pytest.mark.parametrize("seed", range(6))
def test_exact_methods_find_the_enumerated_optimum(seed: int) -> None:
    data = small(seed)
    best = enumerated(data)
    for method in ("highs", "cp_sat"):
        found = solve(data, method)
        assert found.status is Status.OPTIMAL
        assert found.objective == pytest.approx(best, rel=1e-9)
        assert not violations(data, found.required)
    rule = solve(data, "greedy")
    assert not violations(data, rule.required)
    assert rule.bound <= best + 1e-6
    assert best <= rule.objective + 1e-6


@pytest.mark.parametrize("seed", range(20, 60))
def test_the_rule_is_between_its_bound_and_what_it_costs(seed: int) -> None:
    data = small(seed)
    rule, best = solve(data, "greedy"), solve(data)
    assert rule.bound - 1e-6 <= best.objective <= rule.objective + 1e-6
    again = solve(data, "greedy", start=best.values)
    assert again.objective <= best.objective + 1e-6


def fleet(**more: Any) -> Charging:
    """Four robots, one place, ten slots, work for all."""
    plain: dict[str, Any] = {
        "level": [0.3, 0.5, 0.6, 0.7],
        "drain": np.full(4, 0.01),
        "ready": np.zeros(4),
        "waits": np.zeros(4),
        "here": np.full(4, AWAY),
        "way_s": np.full((4, 1), 10.0),
        "places": np.full((1, 10), 1),
        "gain": [0.1],
        "swapped": [0.0],
        "wanted": np.full((1, 10), 4),
        "slot_s": 60.0,
        "worth_s": 500.0,
    }
    return Charging(**plain | more)


def test_nobody_charges_who_is_wanted_and_has_enough() -> None:
    """Energy is worth 500 s per battery, and costs 600 s."""
    plan = solve(fleet(curve=0.0)).required
    assert plan.group.tolist() == [AWAY] * 4


def test_who_is_not_wanted_charges() -> None:
    plan = solve(fleet(wanted=np.full((1, 10), 3))).required
    assert (plan.group == 0).sum() >= 2
    away = np.zeros(10)
    for begin, length in zip(plan.begin, plan.length, strict=True):
        away[begin : begin + length] += 1
    assert away.max() == 1


def test_who_runs_low_charges_before() -> None:
    data = fleet(level=[0.18, 0.5, 0.6, 0.7], least=0.15)
    plan = solve(data).required
    assert plan.group.tolist() == [0, AWAY, AWAY, AWAY]
    assert data.level[0] - data.drain[0] * plan.begin[0] >= 0.15 - 1e-12


def test_one_place_is_shared_in_turn() -> None:
    plan = solve(fleet(level=[0.2, 0.2, 0.2, 0.9], drain=np.full(4, 0.02), least=0.15)).required
    stays = sorted(zip(plan.begin.tolist(), plan.length.tolist(), strict=True))
    for (begin, length), (other, _) in pairwise(stays):
        assert begin + length <= other or length == 0


def test_who_is_there_leaves_when_it_is_wanted() -> None:
    stays = solve(fleet(here=[0, -1, -1, -1], level=[0.9, 0.5, 0.6, 0.7])).required
    assert stays.group[0] == AWAY
    low = solve(fleet(here=[0, -1, -1, -1], level=[0.2, 0.5, 0.6, 0.7], least=0.4)).required
    assert low.group[0] == 0


def test_a_swap_takes_one_slot() -> None:
    plan = solve(fleet(swapped=[0.9], gain=[0.0], worth_s=900.0)).required
    assert plan.length.max() == 1
    assert (plan.group == 0).sum() == 4


@given(
    level=some.floats(0, 1),
    gain=some.floats(0.01, 0.5),
    first=some.floats(0, 9),
    rest=some.floats(0, 9),
    bend=some.floats(0.3, 1),
)
def test_charging_in_two_goes_is_charging_in_one(
    level: float, gain: float, first: float, rest: float, bend: float
) -> None:
    data = fleet(taper_from=bend, full=0.98)

    def charged(level: Any, slots: float) -> Any:
        return data.charged(np.array([level]), np.array([gain]), np.array([slots]))[0]

    at_once = charged(level, first + rest)
    assert charged(charged(level, first), rest) == pytest.approx(at_once, abs=1e-9)
    assert at_once <= max(level, 0.98) + 1e-12


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ({"level": [0.3, -0.1, 0.6, 0.7]}, r"level\[1\]: must be at least 0"),
        ({"wanted": np.zeros((0, 10))}, "wanted: must have at least one case"),
        (
            {"wanted": np.zeros((1, 0)), "places": np.zeros((1, 0))},
            "wanted: must have at least one slot",
        ),
        ({"slot_s": 0.0}, "slot_s: must be positive"),
        ({"here": [1, -1, -1, -1]}, r"here\[0\]: must be at most 0"),
        (
            {"here": [0, -1, -1, -1], "waits": [1, 0, 0, 0]},
            "waits: must be false for a robot that is at a group",
        ),
        ({"here": [0, -1, -1, -1], "swapped": [0.9]}, "here: must not be a group that swaps"),
        ({"places": np.full((1, 9), 1)}, "places: shape must be"),
        ({"idle": 1.5}, "idle: must be at most 1"),
    ],
)
def test_wrong_arrays_are_refused(wrong: dict[str, Any], says: str) -> None:
    with pytest.raises(ModelError, match=says):
        fleet(**wrong)


def plan_of(group: list[int], begin: list[int], length: list[int]) -> ChargePlan:
    return ChargePlan(np.array(group), np.array(begin), np.array(length))


@pytest.mark.parametrize(
    ("plan", "says"),
    [
        (plan_of([0], [0], [1]), "group, begin and length must have one value for each robot"),
        (
            plan_of([1, -1, -1, -1], [0] * 4, [1, 0, 0, 0]),
            "a robot is sent to a group that does not exist",
        ),
        (plan_of([-1] * 4, [0, 1, 0, 0], [0] * 4), "must be 0 for a robot without a stay"),
        (plan_of([0, -1, -1, -1], [9, 0, 0, 0], [2, 0, 0, 0]), "outside the slots"),
        (plan_of([0, -1, -1, -1], [0] * 4, [9, 0, 0, 0]), "too short or too long"),
        (plan_of([-1, 0, -1, -1], [0] * 4, [0, 1, 0, 0]), "before its robot is ready"),
        (plan_of([-1, -1, 0, -1], [0, 0, 1, 0], [0, 0, 1, 0]), "must stay there, from slot 0"),
        (plan_of([-1, -1, -1, 0], [0] * 4, [0, 0, 0, 1]), "that it may not use"),
        (plan_of([0, -1, 0, -1], [0] * 4, [1, 0, 1, 0]), "a group has more robots than places"),
    ],
)
def test_what_is_wrong_with_a_plan_is_said(plan: ChargePlan, says: str) -> None:
    way_s = np.full((4, 1), 10.0)
    way_s[3] = np.inf
    data = fleet(ready=[0, 2, 0, 0], here=[-1, -1, 0, -1], way_s=way_s)
    assert any(says in line for line in violations(data, plan))


def test_a_start_with_too_many_robots_is_refused() -> None:
    start = plan_of([0, 0, -1, -1], [0] * 4, [1, 1, 0, 0])
    for method in methods():
        with pytest.raises(ModelError, match="start: a group has more robots than places"):
            solve(fleet(), method, start=start)


def test_no_robots_and_no_places() -> None:
    nobody = fleet(
        level=[],
        drain=[],
        ready=[],
        waits=[],
        here=[],
        way_s=np.zeros((0, 1)),
        wanted=np.zeros((1, 10)),
    )
    nowhere = fleet(way_s=np.zeros((4, 0)), places=np.zeros((0, 10)), gain=[], swapped=[])
    for method in methods():
        assert solve(nobody, method).objective == 0
        assert solve(nowhere, method).required.group.tolist() == [AWAY] * 4


def test_limits_end_the_search_with_a_plan_and_a_bound() -> None:
    data = replace(small(3), longest=3)
    start = solve(data, "greedy", Limits(iterations=0))
    for method, limits in [("highs", Limits(nodes=1)), ("cp_sat", Limits(deterministic_s=1e-6))]:
        found = solve(data, method, limits, start=start.values)
        assert found.objective <= start.objective + 1e-9
        assert np.isfinite(found.bound)
