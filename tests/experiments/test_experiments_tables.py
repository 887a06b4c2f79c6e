"""Tables, figures and where they come from."""

from __future__ import annotations

import json
import re

import pandas as pd
import pytest
from stand_in import Inline

from rmfs import experiments
from rmfs.errors import InputError
from rmfs.experiments import arranging, provenance, tables
from rmfs.experiments.design.planning import plan_of
from rmfs.experiments.figures import effects, front, interaction, pareto, progression
from rmfs.experiments.figures.progression import per_bin
from rmfs.experiments.figures.style import axis_label, saving
from rmfs.experiments.plotting import KINDS, Wish, draw
from rmfs.experiments.running.driver import drive
from rmfs.experiments.statistics import anova
from rmfs.experiments.store import Store
from rmfs.experiments.study import Study

RULES = ("nearest", "random")


@pytest.fixture
def results(design, tmp_path):
    plan = experiments.plan(design(keep=["series"]))
    store = Store(tmp_path / "out")
    drive(plan, store, Inline())
    return plan, experiments.load(store.folder), store.folder


def test_means_in_every_format(results, tmp_path):
    _, frame, _ = results
    table = tables.means(frame, ["units_per_h", "robots"])
    latex = table.to("latex")
    assert r"\toprule" in latex and r"\bottomrule" in latex
    assert r"\multicolumn{2}{c}{{units per hour}}" in latex
    assert "S[table-format=" in latex
    body = latex.split(r"\midrule")[1]
    assert body.count(r"\\") == 4
    markdown = table.to("markdown")
    row = next(line for line in markdown.splitlines() if "robots=8,psa=nearest" in line)
    assert re.search(r"\| +3 \| +6\d\d(\.\d)? ± \d+(\.\d)? \| +8 ± 0 \|", row), row
    html = table.to("html")
    assert html.count("<tr>") == 7 and "units per hour" in html and "robots=8,psa=nearest" in html
    assert html == table.to("html")
    csv = table.to("csv").splitlines()
    assert csv[0] == "arm,seeds,units_per_h mean,units_per_h ±,robots mean,robots ±"
    assert len(csv) == 5
    for suffix in tables.SUFFIXES:
        table.write(tmp_path / f"table{suffix}")
    with pytest.raises(InputError, match="unknown kind of table"):
        table.write(tmp_path / "table.docx")


def test_differences_are_corrected_over_the_whole_table(results):
    _, frame, _ = results
    table = tables.differences(frame, ["units_per_h", "robots"], "robots=8,psa=nearest")
    found = table.frame
    assert list(found.index) == [
        *("robots=8,psa=random", "robots=16,psa=nearest", "robots=16,psa=random")
    ]
    assert found["pairs", ""].tolist() == [3, 3, 3]
    assert found["robots", "difference"].tolist() == [0.0, 8.0, 8.0]
    assert found["robots", "p"].tolist() == [1.0, 0.0, 0.0]
    text = table.to("markdown")
    assert "units per hour, p" in text and "<0.001" in text and "1.000" in text
    assert "<0.001" in table.to("latex") and "table-format=<1.3" in table.to("latex")
    assert "&lt;0.001" in table.to("html")
    assert "<0.001" not in table.to("csv") and "units_per_h p" in table.to("csv")


def test_factors_as_columns_and_side_by_side(results):
    plan, frame, _ = results
    table = tables.means(frame, ["units_per_h"])
    apart = arranging.by_factors(table, plan)
    assert apart.frame.index.names == ["robots", "psa"]
    assert apart.frame.index.tolist() == [(r, p) for r in ("8", "16") for p in RULES]
    assert apart.frame.to_numpy().tolist() == table.frame.to_numpy().tolist()
    assert re.search(r"\| 8 +\| nearest +\|", apart.to("markdown"))
    wide = arranging.across(table, plan, "psa")
    assert wide.frame.index.tolist() == ["8", "16"] and wide.frame.index.name == "robots"
    for rule in RULES:
        cell = wide.frame.loc["16", (f"units_per_h, psa={rule}", "mean")]
        assert cell == table.frame.loc[f"robots=16,psa={rule}", ("units_per_h", "mean")]
    text = wide.to("markdown")
    assert "units per hour, psa=random" in text and "3 seeds per cell." in text
    assert arranging.across(table, plan, "controllers.psa").to("csv") == wide.to("csv")
    fewer = tables.means(frame[frame["arm"] != "robots=16,psa=random"], ["units_per_h"])
    assert "- |" in arranging.across(fewer, plan, "psa").to("markdown")
    for form in tables.SUFFIXES.values():
        assert "random" in wide.to(form) and "random" in apart.to(form)
    with pytest.raises(
        InputError, match=r"--across poa: not one of several factors; valid: robots, psa"
    ):
        arranging.across(table, plan, "poa")


def test_cells_of_independent_seeds_do_not_count_pairs(design, tmp_path):
    plan = experiments.plan(design(common_random_numbers=False))
    drive(plan, Store(tmp_path / "out"), Inline())
    frame = experiments.load(tmp_path / "out")
    table = tables.differences(frame, ["units_per_h"], "robots=8,psa=nearest")
    assert arranging.across(table, plan, "psa").caption == table.caption


def test_anova_as_a_table(results):
    plan, frame, _ = results
    found = anova(frame, "units_per_h", plan.factors, names=plan.short_names)
    text = tables.effects(found, "units_per_h").to("markdown")
    assert "| robots" in text and "| robots x psa" in text and "partial η²" in text
    latex = tables.effects(found, "units_per_h").to("latex")
    assert r"{$\eta$$^2$}" in latex and "ω" not in latex
    assert "each interaction of two factors has a row" in text
    assert "the 95% confidence interval" in text
    less = anova(frame, "units_per_h", plan.factors, names=plan.short_names, confidence=0.9)
    assert "the 90% confidence interval" in tables.effects(less, "units_per_h").to("markdown")


def test_digits_follow_the_spread():
    assert tables.digits(pd.Series([0.0123, 0.02]), pd.Series([1.0])) == 3
    assert tables.digits(pd.Series([343.0]), pd.Series([1000.0])) == 0
    assert tables.digits(pd.Series([float("nan")]), pd.Series([0.5])) == 4
    assert tables.digits(pd.Series([0.0, 0.0]), pd.Series([16.0, 32.0])) == 0


def test_rounding_is_not_printed():
    runs = [(arm, seed) for arm in "ab" for seed in (1, 2)]
    frame = pd.DataFrame(runs, columns=["arm", "replication"])
    frame["idle_share"] = -2.2e-16
    text = tables.means(frame, ["idle_share"]).to("markdown")
    assert "| 0 ± 0 |" in " ".join(text.split())
    frame["idle_share"] = [0.0, -0.0004, 0.3, 0.2]
    assert "-0.00 " not in tables.means(frame, ["idle_share"]).to("markdown")


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_of_picture_is_drawn(results, tmp_path, kind):
    plan, frame, folder = results
    for suffix in (".png", ".svg"):
        paths = [tmp_path / f"{n}{suffix}" for n in range(2)]
        for path in paths:
            draw(kind, plan, frame, folder, list(KINDS[kind]), path)
        assert paths[0].stat().st_size > 5000
        assert paths[0].read_bytes() == paths[1].read_bytes()
    with pytest.raises(InputError, match="unknown suffix"):
        draw(kind, plan, frame, folder, list(KINDS[kind]), tmp_path / "x.bmp")


def test_the_front_holds_what_nothing_dominates():
    robots = pd.Series({"a": 8, "b": 16, "c": 16, "d": 24, "e": 8})
    units = pd.Series({"a": 600, "b": 900, "c": 800, "d": 900, "e": 600})
    assert front(robots, units, "less", "more") == ["a", "e", "b"]
    assert front(robots, units, "more", "more") == ["d"]


def test_the_front_does_not_depend_on_the_order_of_the_columns(results, tmp_path):
    _, frame, _ = results
    with saving(tmp_path / "x.svg") as figure:
        first, second, third = figure.subplots(1, 3)
        best = pareto(frame, "robots", "units_per_h", first)
        assert set(pareto(frame, "units_per_h", "robots", second)) == set(best)
        assert best == ["robots=8,psa=nearest", "robots=16,psa=nearest"]
        assert first.get_xlabel() == "robots, less is better ←"
        assert first.get_ylabel() == "units per hour, more is better ↑"
        assert second.get_xlabel() == "units per hour, more is better →"
        assert pareto(frame, "robots", "units_per_h", third, x_goal="more") == best[1:]
        with pytest.raises(InputError, match="give one: --goal tasks_pick=more or"):
            pareto(frame, "tasks_pick", "units_per_h", third)


def test_effects_show_pairs_of_factors_where_they_can_be_told(results, tmp_path, monkeypatch):
    plan, frame, folder = results
    drawn: list[tuple[str, str]] = []
    monkeypatch.setattr(
        "rmfs.experiments.plotting.interaction",
        lambda frame, column, across, by, ax, **more: drawn.append((across, by)),
    )
    robots, psa = plan.factors

    def effects(frame, **wish):
        drawn.clear()
        draw("effects", plan, frame, folder, ["units_per_h"], tmp_path / "x.png", Wish(**wish))
        return drawn

    assert set(effects(frame)) == {(robots, psa), (psa, robots)}
    assert effects(frame, interactions=False) == []
    # one of four combinations is lacking: main effects and interaction are one
    assert effects(frame[frame["arm"] != frame["arm"].iloc[-1]]) == []
    draw("interaction", plan, frame, folder, ["units_per_h"], tmp_path / "x.png")
    assert drawn == [(robots, psa)]
    drawn.clear()
    wish = Wish(factors=["psa", "robots"])
    draw("interaction", plan, frame, folder, ["units_per_h"], tmp_path / "x.png", wish)
    assert drawn == [(psa, robots)]
    for factors, text in ((["robots"], "needs two factors"), (["poa", "psa"], "factor poa: no")):
        wish = Wish(factors=factors)
        with pytest.raises(InputError, match=text):
            draw("interaction", plan, frame, folder, ["units_per_h"], tmp_path / "x.png", wish)


def test_lines_of_an_interaction_are_means_of_the_arms_with_both_levels(results, tmp_path):
    plan, frame, _ = results
    robots, psa = plan.factors
    frame = frame.assign(**{psa: frame[psa].where(frame[psa] != "random", None)})
    with saving(tmp_path / "x.png") as figure:
        ax = figure.subplots()
        interaction(frame, "units_per_h", robots, psa, ax)
        assert [text.get_text() for text in ax.get_legend().get_texts()] == ["nearest", "none"]
        told = frame.assign(psa=frame[psa].isna())
        means = told.pivot_table(index="psa", columns=robots, values="units_per_h")
        lines = [container.lines[0].get_ydata() for container in ax.containers]
        for line, expected in zip(lines, means.to_numpy(), strict=True):
            assert list(line) == pytest.approx(expected)
        ax = figure.add_subplot()
        effects(frame, "units_per_h", [psa], [ax])
        assert list(ax.containers[0].lines[0].get_ydata()) == pytest.approx(means.mean(axis=1))


def test_figures_draw_into_the_axes_they_are_given(results, tmp_path):
    _, frame, folder = results
    with saving(tmp_path / "x.png") as figure:
        left, right = figure.subplots(1, 2)
        best = pareto(frame, "robots", "units_per_h", left)
        assert set(best) <= set(frame["arm"])
        series = experiments.load(folder, table="series")
        progression(series, "orders_completed", right, bin_s=1800)
        assert len(right.lines) == 4


def test_progress_in_bins():
    series = pd.DataFrame(
        {
            "arm": "a",
            "replication": 1,
            "time_s": [900.0, 1800.0, 2700.0, 3600.0, 4000.0],
            "interval_s": [900.0] * 4 + [400.0],
            "orders": [1, 2, 3, 4, 5],
        }
    )
    found = per_bin(series, "orders", 1800.0)
    assert found["rate"].tolist() == [6.0, 14.0]
    assert found["hour"].tolist() == [0.25, 0.75]


def test_labels_say_the_unit():
    assert axis_label("units_per_h") == "units per hour"
    assert axis_label("distance_per_unit_m") == "distance per unit (m)"
    assert axis_label("robots") == "robots"
    assert axis_label("pick_station_idle_share") == "pick station idle (share)"
    assert axis_label("distance_m", "series", per="hour") == "distance (m per hour)"
    assert axis_label("orders_completed", "series", per="hour") == "orders completed per hour"


def test_provenance_names_design_code_and_rows(results, tmp_path):
    plan, frame, _ = results
    path = tmp_path / "table.tex"
    beside = provenance.write(
        path, frame, design=plan.design.name, design_hash=plan.hash, columns=["units_per_h"]
    )
    told = json.loads(beside.read_text())
    assert beside.name == "table.tex.provenance.json"
    assert told["design_hash"] == plan.hash
    assert told["rows"]["count"] == 12 and told["rows"]["arms"] == 4
    assert told["rows"]["seeds"] == [1, 2, 3]
    assert told["runs_made_by"][0]["code"] == told["written_by"]["code"]
    other = frame.assign(wall_s=0.0).sample(frac=1.0, random_state=1)
    assert provenance.rows_hash(other, ["units_per_h"]) == told["rows"]["sha256"]
    assert provenance.rows_hash(frame.head(11), ["units_per_h"]) != told["rows"]["sha256"]


def test_each_measure_has_its_own_number_of_seeds_if_some_runs_have_no_value():
    """The first arm has three values of one measure and four of the other."""
    gaps = pd.DataFrame(
        {
            "arm": ["a"] * 4 + ["b"] * 4,
            "replication": [1, 2, 3, 4] * 2,
            "order_turnover_mean_s": [10.0, 20.0, 30.0, float("nan"), 1.0, 2.0, 3.0, 4.0],
            "units_per_h": [5.0, 6.0, 7.0, 8.0, 6.0, 8.0, 10.0, 12.0],
        }
    )
    for columns in (
        ["order_turnover_mean_s", "units_per_h"],
        ["units_per_h", "order_turnover_mean_s"],
    ):
        found = tables.means(gaps, columns)
        assert found.frame["order_turnover_mean_s", "seeds"].tolist() == [3, 4]
        assert found.frame["units_per_h", "seeds"].tolist() == [4, 4]
        assert [pair[0] for pair in found.frame][::3] == columns
        text = found.to("markdown")
        assert "order turnover mean (s), seeds" in text and "units per hour, seeds" in text
        apart = tables.differences(gaps, columns, "a").frame.loc["b"]
        assert apart["order_turnover_mean_s", "pairs"] == 3
        assert apart["units_per_h", "pairs"] == 4
        assert apart["order_turnover_mean_s", "difference"] == pytest.approx(2.0 - 20.0)
    for form in tables.SUFFIXES.values():
        assert "seeds" in found.to(form)


@pytest.mark.parametrize(("confidence", "percent"), [(0.975, "97.5%"), (0.999, "99.9%")])
def test_the_caption_states_the_confidence_unrounded(results, confidence, percent):
    _, frame, _ = results
    found = tables.means(frame, ["units_per_h"], confidence=confidence)
    assert f"with {percent} confidence" in found.caption
    base = "robots=8,psa=nearest"
    apart = tables.differences(frame, ["units_per_h"], base, confidence=confidence)
    assert f"with {percent} confidence" in apart.caption


def test_counts_that_some_runs_do_not_have():
    """As `charges`, which is NA in a run without batteries."""
    charges = pd.array([1, None, 3, 5, None, None], dtype="Int64")
    frame = pd.DataFrame({"arm": [*"aabbcc"], "replication": [1, 2] * 3, "charges": charges})
    found = tables.means(frame, ["charges"]).frame
    assert found["charges", "mean"].tolist() == pytest.approx([1.0, 4.0, float("nan")], nan_ok=True)
    assert found["seeds", ""].tolist() == [1, 2, 0]
    apart = tables.differences(frame, ["charges"], "a").frame
    assert apart.loc["b", ("charges", "difference")] == 2.0
    assert apart.loc["b", ("pairs", "")] == 1
    for baseline, arms in (("a", "ac"), ("b", "b")):
        some = frame[frame["arm"].isin([*arms])]
        with pytest.raises(InputError, match=f"no arm with values to compare with {baseline}"):
            tables.differences(some, ["charges"], baseline)


def test_the_level_none_is_a_level(design, tmp_path):
    """As the number of slots of a put wall, of which there are any number by default."""
    slots = "scenario.packing.slots"
    table = {**experiments.plan(design()).table, "factors": {slots: [None, 4, 8]}}
    plan = plan_of(table, tmp_path, "test")
    drive(plan, Store(tmp_path / "out"), Inline())
    study = Study(plan, tmp_path / "out")
    assert study.table(by=slots).frame.index.tolist() == ["none", 4, 8]
    apart = study.compare(by=slots)
    assert apart.frame.index.tolist() == [4, 8] and "Arm minus none" in apart.caption
    by_arm = study.compare().frame["units_per_h", "difference"].tolist()
    assert apart.frame["units_per_h", "difference"].tolist() == pytest.approx(by_arm)
    assert study.compare(by=slots, baseline=8).frame.index.tolist() == ["none", 4]
    assert len(study.plot(by=slots).axes[0].get_yticks()) == 3


def test_an_arm_without_a_value_is_not_on_the_front():
    nan = float("nan")
    robots = pd.Series({"a": 4.0, "b": 8.0, "c": 6.0, "d": nan})
    units = pd.Series({"a": 100.0, "b": 200.0, "c": nan, "d": 300.0})
    assert front(robots, units, "less", "more") == ["a", "b"]
    assert front(robots[["c"]], units, "less", "more") == []
