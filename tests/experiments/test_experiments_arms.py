"""Factors, lists and files become arms; exclusions and names."""

from __future__ import annotations

from pathlib import Path

import pytest

from rmfs import experiments
from rmfs.errors import InputError
from rmfs.experiments.design.arms import _read_csv, factor_names


def names(path) -> list[str]:
    plan = experiments.plan(path)
    assert plan.problems == []
    return [arm.name for arm in plan.arms]


def test_a_grid_holds_every_combination_in_the_order_of_the_factors(design):
    assert names(design()) == [
        "robots=8,psa=nearest",
        "robots=8,psa=random",
        "robots=16,psa=nearest",
        "robots=16,psa=random",
    ]


def test_excluded_combinations_are_left_out(design):
    path = design(exclude=[{"layout.robots": [8, 16], "controllers.psa": "random"}])
    assert names(path) == ["robots=8,psa=nearest", "robots=16,psa=nearest"]


def test_levels_may_be_tables_with_and_without_labels(design):
    levels = [
        "random",
        {"name": "pod-match", "fast_lane": False},
        {"label": "usual", "value": {"name": "pod-match", "fast_lane": True}},
    ]
    plan = experiments.plan(design(factors={"controllers.poa": levels}))
    assert plan.problems == []
    assert [arm.name for arm in plan.arms] == [
        "poa=random",
        "poa=pod-match(fast_lane=false)",
        "poa=usual",
    ]
    assert plan.arms[2].levels == {"controllers.poa": "usual"}


def test_parameters_of_pacing_can_be_factors(design):
    levels = ["instant", "fixed=1", "fixed=2"]
    plan = experiments.plan(design(factors={"pacing.planning": levels}))
    assert plan.problems == []
    assert len({arm.digest for arm in plan.arms}) == 3
    problems = experiments.plan(design(factors={"pacing.planning": ["fixd=1"]})).problems
    assert "pacing.planning: fixd=1: no such mode; did you mean fixed?" in "\n".join(problems)


def test_a_factor_of_its_own_sets_several_parameters(design):
    levels = [
        {"label": "small", "layout.robots": 8, "scenario.demand.orders": 50},
        {"label": "big", "layout.robots": 16, "scenario.demand.orders": 100},
    ]
    plan = experiments.plan(design(factors={"size": levels}))
    assert plan.problems == []
    assert [arm.name for arm in plan.arms] == ["size=small", "size=big"]
    assert (["scenario", "demand", "orders"], 100) in plan.arms[1].overrides


def test_arms_of_a_list_are_combined_with_the_grid(design):
    arms = [{"name": "few", "layout.robots": 8}, {"layout.robots": 16}]
    path = design(arms=arms, factors={"controllers.psa": ["nearest", "random"]})
    assert names(path) == ["few,psa=nearest", "few,psa=random", "robots=16,psa=nearest",
                           "robots=16,psa=random"]  # fmt: skip


def test_a_named_arm_keeps_its_name_whatever_its_level_is_called(design):
    arms = [
        {"name": "random", "controllers.psa": "random"},
        {"name": "8", "layout.robots": 8},
        {"name": "as it is"},
    ]
    path = design(arms=arms, factors=None)
    assert names(path) == ["random", "8", "as it is"]
    path = design(arms=arms[:1], factors={"layout.robots": [8, 16]})
    assert names(path) == ["random,robots=8", "random,robots=16"]


@pytest.mark.parametrize(
    ("file", "text"),
    [
        ("arms.csv", "name,layout.robots,controllers.psa\nfew,8,\n,16,random\n"),
        (
            "arms.toml",
            '[[arms]]\nname = "few"\n"layout.robots" = 8\n'
            '[[arms]]\n"layout.robots" = 16\n"controllers.psa" = "random"\n',
        ),
    ],
)
def test_arms_from_a_file_beside_the_design(design, tmp_path, file, text):
    (tmp_path / file).write_text(text)
    path = design(arms_file=file, factors=None)
    plan = experiments.plan(path)
    assert plan.problems == []
    assert [arm.name for arm in plan.arms] == ["few", "robots=16,psa=random"]
    assert plan.arms[0].levels == {"layout.robots": 8, "controllers.psa": None}


def test_a_file_beside_the_design_comes_before_a_shipped_one(design, tmp_path):
    from rmfs.instances import ROOT

    shipped = (ROOT / "controllers" / "default.toml").read_text()
    (tmp_path / "mine.toml").write_text(shipped.replace("fast_lane = true", "fast_lane = false"))
    path = design(factors={"controllers": ["default", "mine.toml"]})
    plan = experiments.plan(path)
    assert plan.problems == []
    assert plan.arms[1].inputs["controllers"] == str(tmp_path / "mine.toml")
    assert any(name.endswith("mine.toml") for name in plan.files)


def test_short_names_tell_factors_apart():
    keys = ["layout.robots", "controllers.psa.name", "controllers.pps.weight", "a.b.weight"]
    assert list(factor_names(keys).values()) == ["robots", "psa", "pps.weight", "b.weight"]


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"exclude": [{"layout.robot": 8}]}, "exclude 1: layout.robot is not a factor; did you"),
        ({"factors": {"robots": [8]}}, "factor robots: is no parameter"),
        ({"factors": {"layout.robots": [8, 8]}}, "level 8 occurs more than once"),
        (
            {"factors": {"seed": [{"label": "a"}]}},
            "factor seed: this is the name of another column",
        ),
        ({"base": {"layout": 7}}, "base: layout = 7 is neither a name nor a file"),
        ({"seeded": ["seed"]}, "seeded: seed: must begin with"),
        ({"arms_file": "nothing.csv"}, "nothing.csv: no such file"),
        ({"exclude": [{"layout.robots": [8, 16]}]}, "no arms are left"),
        (
            {"stages": [{"name": "a"}, {"name": "b", "arms": {"best": 7, "by": "units_per_h"}}]},
            "stage b: arms.best = 7: must be from 1 to 4, the number of arms in the stage before",
        ),
        (
            {
                "stages": [
                    {"name": "a"},
                    {"name": "b", "arms": {"best": 2, "by": "units_per_h"}},
                    {"name": "c", "arms": {"best": 3, "by": "units_per_h"}},
                ]
            },
            "stage c: arms.best = 3: must be from 1 to 2, the number of arms in the stage before",
        ),
    ],
)
def test_problems_of_arms_are_told(design, changes, told):
    problems = experiments.plan(design(**changes)).problems
    assert any(told in problem for problem in problems), problems


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"seeds": []}, "seeds: must be different"),
        ({"seeds": [1, 1]}, "seeds: must be different"),
        ({"replications": 3}, "exclude each other"),
        ({"seeds": None}, "seeds: missing"),
        ({"seed": 3}, "unknown key seed; did you mean seeds?"),
        ({"keep": ["serie"]}, "keep: no table serie"),
        ({"factors": {"layout.robots": []}}, "factor layout.robots: has no levels"),
        ({"name": "a/b"}, "name"),
        ({"format": "rmfs-design/2"}, "format"),
        (
            {"stages": [{"name": "a", "until": {"column": "wall_s"}}]},
            "is a measured time",
        ),
        ({"stages": [{"name": "a", "arms": {"best": 1, "by": "units_per_h"}}]}, "stage before"),
        (
            {"stages": [{"name": "a", "seeds": [1], "until": {"column": "units_per_h"}}]},
            "needs from 2 to max_seeds seeds",
        ),
    ],
)
def test_a_wrong_design_file_is_refused(design, changes, told):
    with pytest.raises(InputError, match=told):
        experiments.plan(design(**changes))


def test_what_a_design_does_not_name_is_the_default(design):
    plan = experiments.plan(design(base={"layout": "basic"}))
    assert plan.problems == []
    assert plan.arms[0].inputs == {
        "layout": "basic",
        "scenario": "default",
        "controllers": "default",
    }


def test_an_unknown_design_lists_the_shipped_ones():
    with pytest.raises(InputError, match=r"shipped: .*smoke"):
        experiments.plan("smoek")


def test_a_doubled_column_of_an_arms_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "arms.csv").write_text("layout.robots,layout.robots\n4,8\n")
    with pytest.raises(InputError, match=r"line 1 names the column layout\.robots more than once"):
        _read_csv(tmp_path / "arms.csv")
