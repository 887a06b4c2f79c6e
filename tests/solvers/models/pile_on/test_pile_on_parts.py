"""Pruning, restriction, attribution, bounds and repetition."""

from dataclasses import replace

import numpy as np
import pytest
from pile_on_oracle import optimum, small_site, tiny
from pile_on_sample import MEDIUM, SMALL, Size, snapshot

from rmfs.solvers.models import Limits, ModelError
from rmfs.solvers.models.pile_on import (
    PileOn,
    Pruning,
    Variant,
    Weights,
    cp_sat,
    everything,
    greedy,
    hadgs,
    highs,
    joint,
    neighbourhood,
    objective,
    prune,
    violations,
)
from rmfs.solvers.models.pile_on.program import formulate
from rmfs.solvers.models.pile_on.relaxation import PileOnRelaxation, bound
from rmfs.solvers.models.pile_on.restrict import compact, part
from rmfs.solvers.models.pile_on.values import called_supply, demand, nothing, uncovered


def test_columns_say_the_same_as_the_objective() -> None:
    for variant in Variant:
        for seed in range(30):
            data = tiny(seed, variant)
            values = cp_sat.solve(data).required
            formulation = formulate(data, everything(data))
            x = formulation.encode(values)
            assert formulation.program.violation(x) < 1e-9
            assert formulation.program.objective(x) == pytest.approx(objective(data, values))
            again = formulation.decode(x)
            for field in vars(values):
                assert np.array_equal(getattr(again, field), getattr(values, field))


def test_candidates_are_nested_and_generous_pruning_loses_nothing() -> None:
    for seed in range(10):
        data = small_site(seed)
        few, many = prune(data, Pruning(1, 1, 1, 1)), prune(data, Pruning(99, 99, 99, 99))
        all_pairs = everything(data)
        for table in ("calls", "places", "fetches"):
            assert not (getattr(few, table) & ~getattr(many, table)).any()
            assert not (getattr(many, table) & ~getattr(all_pairs, table)).any()
        assert np.array_equal(many.places, all_pairs.places)
        assert few.calls.sum() < all_pairs.calls.sum()


def test_pruned_solutions_are_feasible_and_claim_no_bound() -> None:
    data = small_site(3)
    solution = highs.solve(data, candidates=prune(data, Pruning(2, 4, 2, 2)))
    assert violations(data, solution.required) == []
    assert solution.bound == -np.inf
    assert highs.solve(data).objective <= solution.objective


def test_compacting_loses_nothing() -> None:
    for seed in range(10):
        data = tiny(seed, Variant.WHOLE)
        small = compact(data, everything(data))
        inner = cp_sat.solve(small.data, candidates=small.candidates)
        values = small.expand(inner.required)
        assert violations(data, values) == []
        assert objective(data, values) == pytest.approx(optimum(data))
        back = small.shrink(values)
        assert np.array_equal(back.pod_station, inner.required.pod_station)


def test_a_part_starts_where_the_whole_stands_and_merges_into_it() -> None:
    for seed in range(10):
        data = small_site(seed)
        values = greedy.solve(data).required
        stage = part(data, everything(data), values, np.array([0, 2]))
        assert stage is not None
        start = stage.start()
        assert violations(stage.data, start) == []
        same = stage.merge(start)
        for field in vars(values):
            assert np.array_equal(getattr(same, field), getattr(values, field))
        better = highs.solve(stage.data, candidates=stage.candidates, start=start)
        merged = stage.merge(better.required)
        assert violations(data, merged) == []
        gained = objective(stage.data, start) - better.objective
        assert objective(data, values) - objective(data, merged) == pytest.approx(gained)


def test_a_part_leaves_orders_that_are_split_beyond_it_as_they_are() -> None:
    split = 0
    for seed in range(8):
        # Fewer orders than slots: what fills the slots is splitting.
        size = Size(stations=3, slots=3, pods=15, skus=12, orders=5, robots=9, skus_per_pod=3)
        weights = Weights(part=0.0, prospects=False)
        data = snapshot(size, seed, variant=Variant.SPLIT_BOTH, weights=weights)
        values = cp_sat.solve(data, Limits(deterministic_s=0.3)).required
        stations = np.array([0, 1])
        inside, beyond = values.slot[:, :2].any(axis=1), values.slot[:, 2]
        split += np.count_nonzero(inside & beyond)
        stage = part(data, everything(data), values, stations)
        if stage is None:
            continue
        start = stage.start()
        assert violations(stage.data, start) == []
        better = highs.solve(stage.data, candidates=stage.candidates, start=start)
        merged = stage.merge(better.required)
        assert violations(data, merged) == []
        assert np.array_equal(merged.slot[beyond], values.slot[beyond])
        gained = objective(stage.data, start) - better.objective
        assert objective(data, values) - objective(data, merged) == pytest.approx(gained)
    assert split > 3


def test_supply_and_demand_of_a_decision_agree() -> None:
    for seed in range(20):
        data = small_site(seed)
        values = greedy.solve(data).required
        have = data.surplus + called_supply(data, values) + uncovered(data, values)
        assert (demand(data, values) + data.shortage <= have).all()


def test_the_relaxation_is_a_bound_and_strengthening_improves_it() -> None:
    for seed in range(15):
        data = tiny(seed, Variant.WHOLE)
        assert bound(data) <= optimum(data) + 1e-9
    data = small_site(1)
    best = highs.solve(data).objective
    assert bound(data) <= best
    plain = highs.solve(data, Limits(nodes=0), strengthen=False).bound
    assert plain <= best


def test_the_relaxation_compiles_once_per_pattern() -> None:
    relaxation = PileOnRelaxation()
    data = small_site(1)
    first = relaxation.solve(data)
    dearer = relaxation.solve(replace(data, travel=data.travel * 2))
    assert relaxation.compilations == 1
    assert dearer.bound >= first.bound
    relaxation.solve(small_site(2))
    assert relaxation.compilations == 2


@pytest.mark.parametrize("solver", [cp_sat, hadgs, greedy, neighbourhood, joint])
def test_the_same_input_gives_the_same_output(solver: object) -> None:
    data = small_site(5)
    runs = [solver.solve(data, Limits(deterministic_s=0.05), seed=3) for _ in range(2)]
    for field in vars(runs[0].required):
        assert np.array_equal(getattr(runs[0].required, field), getattr(runs[1].required, field))
    assert (runs[0].objective, runs[0].work) == (runs[1].objective, runs[1].work)


def test_ties_go_to_the_lower_index() -> None:
    data = PileOn(
        slots=[1, 1],
        line_order=[0, 1],
        line_sku=[0, 0],
        line_units=[1, 1],
        stock=[[1], [1], [1]],
        travel=np.ones((3, 2)),
        available=[1, 1, 1],
        inbound=[-1, -1, -1],
        open_units=np.zeros((2, 1)),
    )
    for rule in (greedy, hadgs):
        values = rule.solve(data).required
        assert values.pod_station.tolist() == [0, 1, -1]
        assert values.slot.tolist() == [[True, False], [False, True]]


def test_neighbourhood_search_is_between_its_start_and_the_optimum() -> None:
    for seed in range(3):
        data = small_site(seed)
        start = hadgs.solve(data)
        solution = neighbourhood.solve(data, Limits(deterministic_s=0.3), start=start.values)
        assert violations(data, solution.required) == []
        assert solution.objective <= start.objective
        assert highs.solve(data).objective <= solution.objective + 1e-6


def test_parts_of_split_orders_start_where_the_whole_stands() -> None:
    """Orders with slots elsewhere take the slots and the pods that prospects and calls count on."""
    prospects = 0
    for variant in (Variant.SPLIT_STATIONS, Variant.SPLIT_BOTH):
        for seed in range(25):
            size = Size(
                stations=3 + seed % 3, slots=1 + seed % 2, pods=15, skus=8, orders=8, robots=9
            )
            weights = Weights(part=100.0 * (seed % 2))
            data = snapshot(size, seed, variant=variant, weights=weights)
            found = neighbourhood.solve(data, Limits(deterministic_s=0.05))
            assert violations(data, found.required) == []
            values = greedy.solve(data).required
            prospects += np.count_nonzero(found.required.prospect >= 0)
            for stations in ([0, 1], [1, 2]):
                for whole in (values, found.required):
                    stage = part(data, everything(data), whole, np.array(stations))
                    assert stage is None or violations(stage.data, stage.start()) == []
    assert prospects > 20


def test_the_default_keeps_the_lines_that_one_pod_serves() -> None:
    """Twenty lines that only one pod serves, behind thirty that cheaper pods serve one by one."""
    skus = 50
    stock = np.zeros((31, skus), np.int64)
    stock[np.arange(30), np.arange(30)] = 1
    stock[30, 30:] = 1
    data = PileOn(
        slots=[1],
        line_order=np.arange(skus),
        line_sku=np.arange(skus),
        line_units=np.ones(skus),
        stock=stock,
        travel=np.append(np.full(30, 1.0), 100.0)[:, None],
        available=np.ones(31),
        inbound=np.full(31, -1),
        open_units=np.zeros((1, skus)),
    )
    best = cp_sat.solve(data)
    kept = cp_sat.solve(data, candidates=prune(data))
    few = cp_sat.solve(data, candidates=prune(data, Pruning(orders_per_slot=16)))
    assert kept.objective == best.objective < few.objective


def test_a_way_that_weighs_nothing_is_none_without_a_robot() -> None:
    """Zero times infinity: no pod is called, and no number is none."""
    data = replace(small_site(1), weights=Weights(travel=0.0))
    assert data.fetch is not None
    nobody = replace(data, fetch=data.fetch[:0], robot_pod=np.zeros(0))
    for rule in (greedy, hadgs):
        with np.errstate(invalid="raise"):
            found = rule.solve(nobody)
        assert violations(nobody, found.required) == []
        assert not (nobody.needs_robot & (found.required.pod_station >= 0)).any()


def test_numbers_that_the_solver_cannot_count_are_refused() -> None:
    data = small_site(1)
    far = replace(data, travel=np.full(data.travel.shape, 1e300))
    with pytest.raises(ModelError, match=r"cost: adds up to .*; CP-SAT counts to 4.6e"):
        cp_sat.solve(far)


@pytest.mark.parametrize("limit", [0.005, 0.02])
def test_work_keeps_to_the_limit_whatever_the_size(limit: float) -> None:
    """Only the step in which CP-SAT ends may lie beyond; the rule counts as built, not as work."""
    for size in (SMALL, MEDIUM):
        data = snapshot(size, 3)
        found = joint.solve(data, Limits(deterministic_s=limit), bound_steps=0)
        assert found.work <= 1.25 * limit
        assert found.built >= data.pods * data.lines / 32


def test_what_is_built_grows_with_the_input() -> None:
    limits = Limits(deterministic_s=0.001)
    small, medium = (joint.solve(snapshot(size, 1), limits) for size in (SMALL, MEDIUM))
    assert medium.built > 1.5 * small.built


@pytest.mark.parametrize("method", [joint, cp_sat, neighbourhood])
def test_a_start_that_is_not_feasible_is_refused(method: object) -> None:
    data = PileOn(
        slots=[1, 1, 1],
        line_order=[0],
        line_sku=[0],
        line_units=[1],
        stock=[[1]],
        travel=np.ones((1, 3)),
        available=[True],
        inbound=[-1],
        open_units=np.zeros((3, 1)),
    )
    served = replace(nothing(data), slot=np.eye(1, 3, dtype=bool), line_station=np.array([0]))
    with pytest.raises(ModelError, match="start: stock of station does not cover what it serves"):
        method.solve(data, Limits(deterministic_s=0.001), start=served)


def test_open_demand_may_go_short_for_a_line_beside_a_split_order() -> None:
    """A part would give the pod kept for the split order to the open demand, not to the line."""
    data = PileOn(
        slots=[2, 1, 1],
        line_order=[0, 0, 1],
        line_sku=[0, 1, 0],
        line_units=[1, 1, 1],
        stock=[[2, 0], [0, 1]],
        travel=np.ones((2, 3)),
        available=[True, True],
        inbound=[-1, -1],
        open_units=[[1, 0], [0, 0], [0, 0]],
        variant=Variant.SPLIT_BOTH,
    )
    start = replace(
        nothing(data),
        slot=np.array([[True, False, True], [True, False, False]]),
        line_station=np.array([0, 2, 0]),
        pod_station=np.array([0, 2]),
    )
    assert violations(data, start) == []
    found = neighbourhood.solve(data, start=start)
    assert violations(data, found.required) == []
    assert found.objective <= objective(data, start)
