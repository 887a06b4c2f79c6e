"""Plans: hashes, jobs, and everything that is wrong, with arm and key."""

from __future__ import annotations

import pytest

from rmfs import experiments
from rmfs.errors import InputError
from rmfs.experiments.design.planning import PlanError, load
from rmfs.instances import ROOT


def test_every_problem_is_told_with_its_arms(design):
    plan = experiments.plan(
        design(
            base={"layout": "basic", "scenario": "basic", "controllers": "default"},
            factors={
                "layout.robts": [1],
                "scenario.duration_s": [600, -1],
                "controllers.psa": ["nearest", "nearst"],
            },
        )
    )
    told = "\n".join(plan.problems)
    assert "unknown key robts; did you mean robots?" in told
    assert "duration_s" in told and "did you mean nearest?" in told
    assert "duration_s=-1,psa=nearest" in told
    with pytest.raises(PlanError) as raised:
        plan.require_sound()
    assert raised.value.problems == plan.problems


def test_a_layout_that_cannot_be_simulated_is_a_problem(design):
    problems = experiments.plan(design(factors={"layout.robots": [16, 5000]})).problems
    assert len(problems) == 1
    assert problems[0].startswith("arm robots=5000: ")


def test_arms_that_are_the_same_warehouse_are_a_problem(design):
    arms = [{"name": "a", "layout.robots": 16}, {"name": "b"}]
    assert experiments.plan(design(arms=arms, factors=None)).problems == [
        "arms a | b: are the same"
    ]


def test_the_hash_is_of_meaning(design, tmp_path):
    scenario = (ROOT / "scenarios" / "basic.toml").read_text()
    (tmp_path / "own.toml").write_text(scenario)
    base = {"layout": "basic", "scenario": "own.toml", "controllers": "default"}
    first = experiments.plan(design(base=base))
    path = design(base=base)
    path.write_text("# a remark\n" + path.read_text())
    assert experiments.plan(path).hash == first.hash

    (tmp_path / "own.toml").write_text("# a remark\n" + scenario)
    remarked = experiments.plan(path)
    assert remarked.hash != first.hash  # the file is another one ...
    assert remarked.arms == first.arms  # ... and means the same

    (tmp_path / "own.toml").write_text(scenario.replace("orders = 200", "orders = 201"))
    changed = experiments.plan(path)
    assert all(a.digest != b.digest for a, b in zip(changed.arms, first.arms, strict=True))


def test_the_content_of_a_file_that_an_input_names_counts(design, tmp_path):
    from rmfs.experiments.design.resolve import Resolver

    named = tmp_path / "skus.xgenc"
    named.write_text("one")
    before = Resolver()._with_files({"skus": {"file": str(named)}})
    named.write_text("two")
    resolver = Resolver()
    assert resolver._with_files({"skus": {"file": str(named)}}) != before
    assert list(resolver.files) == [str(named)]


def test_common_random_numbers_and_their_absence(design):
    plan = experiments.plan(design())
    assert {plan.seed(arm, 2) for arm in plan.arms} == {2}
    other = experiments.plan(design(common_random_numbers=False))
    seeds = [other.seed(arm, r) for arm in other.arms for r in (1, 2, 3)]
    assert len(set(seeds)) == len(seeds)
    again = experiments.plan(design(common_random_numbers=False))
    assert seeds == [again.seed(arm, r) for arm in again.arms for r in (1, 2, 3)]


def test_fewer_replications_are_the_first_seeds(design):
    path = design(replications=None, seeds=[31, 12, 53])
    assert experiments.plan(path, replications=2).design.seeds == [31, 12]
    with pytest.raises(InputError, match="lists 3 seeds; not 4"):
        experiments.plan(path, replications=4)
    assert experiments.plan(design(), replications=1).design.seeds_of() == [1]


def test_seeded_parameters_take_the_seed(design):
    plan = experiments.plan(design(seeded=["layout.seed"]))
    assert plan.problems == []
    job = plan.job(plan.arms[0], 3)
    assert (["layout", "seed"], 3) in job.overrides
    assert job.arm_digest != experiments.plan(design()).arms[0].digest
    assert experiments.plan(design(seeded=["layout.sed"])).problems


def test_runs_have_different_keys_and_the_same_ones_again(design):
    plan = experiments.plan(design())
    keys = [plan.job(arm, seed).key for arm in plan.arms for seed in (1, 2, 3)]
    assert len(set(keys)) == 12
    again = experiments.plan(design(name="other", description="renamed"))
    assert [again.job(arm, seed).key for arm in again.arms for seed in (1, 2, 3)] == keys


def test_a_plan_is_read_back(design, tmp_path):
    plan = experiments.plan(design(factors={"controllers.psa": [{"name": "random"}, "nearest"]}))
    plan.save(tmp_path / "out")
    read = load(tmp_path / "out")
    assert (read.arms, read.hash, read.files) == (plan.arms, plan.hash, plan.files)


@pytest.mark.parametrize("name", ["smoke", "fleet-size"])
def test_shipped_designs_are_sound(name):
    assert experiments.plan(name).problems == []
