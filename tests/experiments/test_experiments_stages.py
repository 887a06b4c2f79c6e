"""Stages: screening, sequential stopping, selection; the same whatever came in between."""

from __future__ import annotations

from math import nan

import pandas as pd
import pytest
from stand_in import Inline, footprint

from rmfs import experiments
from rmfs.errors import InputError
from rmfs.experiments.complete import lacking
from rmfs.experiments.design.stages import schedule
from rmfs.experiments.running.driver import drive
from rmfs.experiments.running.job import Outcome
from rmfs.experiments.store import Store

FACTORS = {"layout.robots": [8, 12, 16], "controllers.psa": ["nearest", "random"]}


def made(design, **changes):
    return experiments.plan(design(factors=FACTORS, **changes))


def runs(frame: pd.DataFrame) -> dict[str, list[int]]:
    return {str(arm): list(one["replication"]) for arm, one in frame.groupby("arm", sort=False)}


def test_only_the_best_arms_go_on(design, tmp_path):
    stages = [
        {"name": "screening", "seeds": [1, 2]},
        {"name": "final", "seeds": [1, 2, 3, 4], "arms": {"best": 2, "by": "units_per_h"}},
    ]
    plan = made(design, seeds=None, stages=stages)
    store = Store(tmp_path / "out")
    done = drive(plan, store, Inline())
    assert done.ran == 6 * 2 + 2 * 2
    frame = experiments.load(store.folder)
    screened = frame[frame["replication"] <= 2].groupby("arm")["units_per_h"].mean()
    best = {key: [1, 2, 3, 4] for key in screened.nlargest(2).index}
    assert "robots=16,psa=nearest" in best
    assert {arm: seeds for arm, seeds in runs(frame).items() if len(seeds) > 2} == best
    assert set(frame.loc[frame["replication"] > 2, "stage"]) == {"final"}
    assert set(frame.loc[frame["replication"] <= 2, "stage"]) == {"screening"}


UNTIL = {"column": "units_per_h", "relative_half_width": 0.03, "max_seeds": 40}


@pytest.mark.parametrize("step", [1, 4])
def test_seeds_are_added_until_the_interval_is_narrow(design, tmp_path, step):
    stages = [{"name": "all", "seeds": [1, 2, 3], "until": {**UNTIL, "step": step}}]
    plan = made(design, seeds=None, stages=stages)
    store = Store(tmp_path / "out")
    drive(plan, store, Inline())
    frame = experiments.load(store.folder)
    found = experiments.statistics.per_arm(frame, "units_per_h")
    assert (found["relative_half_width"] <= 0.03).all()
    assert (found["count"] > 3).any() and (found["count"] < 40).all()
    assert all(seeds == list(range(1, len(seeds) + 1)) for seeds in runs(frame).values())
    assert schedule(plan, frame).complete


def test_an_interrupted_sequential_experiment_wants_the_same_runs(design, tmp_path):
    stages = [{"name": "all", "seeds": [1, 2, 3], "until": UNTIL}]
    plan = made(design, seeds=None, stages=stages)
    store = Store(tmp_path / "out")
    for after in (7, 5, 11):
        with pytest.raises(KeyboardInterrupt):
            drive(plan, store, Inline(after=after))
    drive(plan, store, Inline(slots=1))
    drive(plan, Store(tmp_path / "whole"), Inline())
    first, second = (experiments.load(tmp_path / name) for name in ("out", "whole"))
    assert runs(first) == runs(second)


def test_the_best_arm_is_selected(design, tmp_path):
    select = {"column": "units_per_h", "indifference": 0.5, "max_seeds": 60}
    stages = [{"name": "select", "seeds": [1, 2, 3, 4, 5], "select": select}]
    plan = made(design, seeds=None, stages=stages)
    store = Store(tmp_path / "out")
    drive(plan, store, Inline())
    frame = experiments.load(store.folder)
    (remark,) = schedule(plan, frame).remarks
    assert "robots=16,psa=nearest selected after" in remark
    counts = {arm: len(seeds) for arm, seeds in runs(frame).items()}
    assert counts["robots=16,psa=nearest"] == max(counts.values()) < 60
    assert counts["robots=8,psa=random"] < counts["robots=16,psa=nearest"]


def test_failed_runs_do_not_hold_up_a_stage(design, tmp_path):
    def work(job):
        if job.seed == 4 and "robots=16" in job.arm:
            return Outcome(error="ValueError: lost")
        return Outcome(footprint(job))

    select = {"column": "units_per_h", "indifference": 0.5, "max_seeds": 60}
    for number, rule in enumerate(({"select": select}, {"until": UNTIL})):
        stages = [
            {"name": "first", "seeds": [1, 2, 3], **rule},
            {"name": "then", "seeds": [100], "arms": {"best": 1, "by": "units_per_h"}},
        ]
        plan = made(design, seeds=None, stages=stages)
        store = Store(tmp_path / str(number))
        done = drive(plan, store, Inline(do=work))
        assert done.failed
        assert (experiments.load(store.folder)["replication"] == 100).sum() == 1


@pytest.mark.parametrize("lost", ["failed", "without a value"])
def test_arms_with_lost_runs_do_not_go_on(design, lost):
    """The arm that looks best lost its worse seed; the next best has both."""
    stages = [
        {"name": "screening", "seeds": [1, 2]},
        {"name": "final", "seeds": [100], "arms": {"best": 2, "by": "units_per_h"}},
    ]
    plan = made(design, seeds=None, stages=stages)
    first, second, third, *others = (arm.name for arm in plan.arms)
    known = {first: [900.0, nan], second: [800.0, 400.0], third: [500.0, 500.0]}
    known |= {arm: [100.0, 100.0] for arm in others}
    frame = pd.DataFrame(
        [(arm, seed, both[seed - 1]) for arm, both in known.items() for seed in (1, 2)],
        columns=["arm", "replication", "units_per_h"],
    )
    failed = []
    if lost == "failed":
        frame, failed = frame.dropna(), [(first, 2)]
    now = schedule(plan, frame, failed)
    assert [wanted.arm for wanted in now.runs if wanted.stage == "final"] == [second, third]
    assert now.remarks == [
        f"stage final: left out, as not all runs have a value of units_per_h: {first}",
        f"stage final: 2 arms go on: {second} | {third}",
    ]


def test_replications_of_stages_are_not_replaced(design):
    """Each stage states its own seeds."""
    path = design(seeds=None, stages=[{"name": "all", "seeds": [1, 2]}])
    assert experiments.plan(path).design.stages
    with pytest.raises(InputError, match=r"design\.toml: stages: .* replications cannot be set"):
        experiments.plan(path, replications=1)


@pytest.mark.parametrize("common", [True, False])
def test_stages_decide_by_the_seeds_of_the_plan(design, tmp_path, common):
    """Earlier runs in the folder have other seeds: with, or without, common random numbers."""
    stages = [
        {"name": "screening", "seeds": [1, 2]},
        {"name": "final", "seeds": [3, 4], "arms": {"best": 1, "by": "units_per_h"}},
    ]
    factors = {"layout.robots": [15, 16], "controllers.psa": ["nearest"]}
    for shared in (not common, common):
        path = design(seeds=None, stages=stages, factors=factors, common_random_numbers=shared)
        plan = experiments.plan(path)
        store = Store(tmp_path / "out")
        drive(plan, store, Inline())
    assert lacking(plan, store) == ""
    drive(plan, Store(tmp_path / "alone"), Inline())
    first, second = (experiments.load(tmp_path / name) for name in ("out", "alone"))
    assert runs(first) == runs(second)
