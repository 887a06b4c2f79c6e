"""Both back ends against brute force, in every variant; heuristics between them and the worst."""

from dataclasses import replace

import numpy as np
import pytest
from pile_on_oracle import optimum, small_site, tiny

from rmfs.solvers.models import Limits, Status
from rmfs.solvers.models.pile_on import cp_sat, greedy, hadgs, highs, joint, neighbourhood, prices
from rmfs.solvers.models.pile_on.values import nothing, objective, violations
from rmfs.solvers.models.pile_on.variant import Variant

CASES = 40


@pytest.mark.parametrize("variant", Variant)
def test_cp_sat_finds_the_optimum_of_brute_force(variant: Variant) -> None:
    for seed in range(CASES):
        data = tiny(seed, variant)
        best = optimum(data)
        solution = cp_sat.solve(data)
        assert violations(data, solution.required) == [], seed
        assert solution.status is Status.OPTIMAL
        assert solution.objective == pytest.approx(best), seed
        assert solution.objective == objective(data, solution.required)
        assert best - 1e-6 <= solution.bound <= best + 1e-9


@pytest.mark.parametrize("variant", Variant)
@pytest.mark.parametrize("strengthen", [True, False])
def test_highs_finds_the_optimum_of_brute_force(variant: Variant, strengthen: bool) -> None:
    for seed in range(100, 100 + CASES // 2):
        data = tiny(seed, variant, fractions=True)
        best = optimum(data)
        solution = highs.solve(data, strengthen=strengthen)
        assert violations(data, solution.required) == [], seed
        assert solution.objective == pytest.approx(best, abs=1e-6), seed
        assert solution.bound <= best + 1e-9


@pytest.mark.parametrize("variant", Variant)
@pytest.mark.parametrize("rule", [greedy, hadgs, joint, neighbourhood])
def test_heuristics_are_feasible_and_never_beat_the_optimum(rule: object, variant: Variant) -> None:
    for seed in range(CASES):
        data = tiny(seed, variant)
        solution = rule.solve(data)
        assert violations(data, solution.required) == [], seed
        assert solution.objective == objective(data, solution.required)
        assert optimum(data) - 1e-6 <= solution.objective


def test_heuristics_are_mostly_near_the_optimum() -> None:
    met = [
        greedy.solve(data).objective == pytest.approx(optimum(data))
        for data in (tiny(seed, Variant.WHOLE) for seed in range(60))
    ]
    assert np.mean(met) > 0.8


@pytest.mark.parametrize("variant", Variant)
def test_back_ends_agree_on_larger_inputs(variant: Variant) -> None:
    data = small_site(1, variant)
    start = greedy.solve(data).values
    one, other = cp_sat.solve(data, start=start), highs.solve(data, start=start)
    assert violations(data, one.required) == violations(data, other.required) == []
    assert one.objective == pytest.approx(other.objective, rel=1e-6)


def test_the_joint_decision_is_no_worse_than_its_rules_and_its_start() -> None:
    for seed in range(3):
        data = small_site(seed)
        exact = cp_sat.solve(data, Limits(deterministic_s=0.2))
        limits = Limits(deterministic_s=0.02)
        solution = joint.solve(data, limits, start=exact.values)
        assert violations(data, solution.required) == []
        assert solution.objective <= exact.objective
        assert solution.objective <= joint.solve(data, limits).objective
        assert joint.solve(data, limits).objective <= greedy.solve(data).objective


@pytest.mark.parametrize("variant", Variant)
def test_prices_bound_every_decision_wherever_they_aim(variant: Variant) -> None:
    met = []
    for seed in range(200, 300):
        data = tiny(seed, variant, fractions=bool(seed % 2))
        best = optimum(data)
        for upper in (best, objective(data, nothing(data)) + 1e4):
            for steps in (0, 50):
                assert prices.bound(data, upper, steps) <= best + 1e-9, seed
        met.append(prices.bound(data, best, 50) == pytest.approx(best, rel=1e-4, abs=1e-4))
    assert np.mean(met) > 0.4


def test_prices_bound_well_where_no_prospects_are_rewarded() -> None:
    for seed in range(5):
        data = small_site(seed, prospects=False)
        best = highs.solve(data).objective
        scale = data.weights.empty_slot * data.slots.sum()
        assert best - 0.01 * scale <= prices.bound(data, best, 100) <= best


@pytest.mark.parametrize("variant", Variant)
def test_the_joint_decision_has_a_bound_of_the_whole_problem(variant: Variant) -> None:
    for seed in range(300, 340):
        data = tiny(seed, variant)
        solution = joint.solve(data)
        assert solution.bound <= optimum(data) + 1e-9
        if solution.status is Status.OPTIMAL:
            assert solution.objective == pytest.approx(optimum(data))


def test_deciding_nothing_is_always_allowed() -> None:
    for variant in Variant:
        for seed in range(20):
            data = tiny(seed, variant)
            assert violations(data, nothing(data)) == []


def test_the_programme_is_m1g_but_for_what_its_text_says() -> None:
    """M1G as printed is worth more only where a station without free slots has prospects."""
    others = 0
    for seed in range(200):
        drawn = tiny(seed, Variant.WHOLE)
        data = replace(drawn, weights=replace(drawn.weights, prospects=True), worth=None)
        least, printed = optimum(data), optimum(data, as_printed=True)
        assert cp_sat.solve(data).objective == pytest.approx(least, abs=1e-6)
        if (data.slots > 0).all():
            assert printed == least
        else:
            assert printed <= least
            others += printed < least
    assert others > 0
