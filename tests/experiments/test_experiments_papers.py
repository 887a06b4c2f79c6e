"""The reproduced experiments: what they compute, by hand, and that they run as commands."""

from __future__ import annotations

import json
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from rmfs.experiments.papers import demonstrator, figure_5b, fleet_size, path_planning
from rmfs.experiments.papers.study import WRONG_INPUT, command


def warehouse() -> SimpleNamespace:
    """A row of six waypoints: a queue place, hall, storage, aisle, storage, hall."""
    return SimpleNamespace(
        waypoints=6,
        x_m=np.array([0.0, 1.0, 2.0, 3.0, 4.0, 5.0]),
        y_m=np.zeros(6),
        is_storage=np.array([False, False, True, False, True, False]),
        is_queue=np.array([True, False, False, False, False, False]),
    )


def counted(replication: int, visits: list[int], waiting_s: list[float]) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "replication": replication,
            "waypoint": range(6),
            "tier": 0,
            "x_m": range(6),
            "y_m": 0.0,
            "visits": visits,
            "waiting_s": waiting_s,
        }
    )


HEAT = pd.concat(
    [
        counted(1, [40, 20, 5, 20, 5, 10], [90.0, 0.0, 5.0, 0.0, 5.0, 0.0]),
        counted(2, [60, 10, 10, 10, 0, 10], [60.0, 20.0, 0.0, 10.0, 0.0, 10.0]),
    ]
)


def test_areas_of_a_layout():
    halls, storage = "halls and ring road", "storage places"
    assert list(figure_5b.areas(warehouse())) == [
        "queues of stations", halls, storage, "aisles", storage, halls,
    ]  # fmt: skip


def test_visits_and_waiting_are_spread_over_the_areas():
    spread = figure_5b.spread(HEAT, figure_5b.areas(warehouse())).set_index(["replication", "area"])
    first = spread.loc[1]
    assert first["waypoints"].to_dict() == {
        "aisles": 1, "halls and ring road": 2, "queues of stations": 1, "storage places": 2,
    }  # fmt: skip
    assert list(first["visits per waypoint"]) == [20.0, 15.0, 40.0, 5.0]
    assert list(first["share of visits %"]) == [20.0, 30.0, 40.0, 10.0]
    assert list(first["share of waiting %"]) == [0.0, 0.0, 90.0, 10.0]
    assert list(spread.loc[2]["share of waiting %"]) == [10.0, 30.0, 60.0, 0.0]


def test_the_busiest_area_comes_first_and_seeds_are_averaged():
    table = figure_5b.as_table(figure_5b.spread(HEAT, figure_5b.areas(warehouse())))
    assert table.frame.index[0] == "queues of stations"
    assert table.frame.loc["queues of stations", ("visits per waypoint", "mean")] == 50.0
    mean = figure_5b.together(HEAT)
    assert list(mean["visits"]) == [50.0, 15.0, 7.5, 15.0, 2.5, 10.0]


def test_the_demonstrator_is_run_and_published(design, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = design(
        keep=["heat"],
        check=True,
        seeds=[1, 2],
        base={
            "layout": "demonstrator",
            "scenario": "demonstrator",
            "controllers": "default",
            "scenario.warmup_s": 0,
            "scenario.duration_s": 600,
        },
        factors={"layout.robots": [1, 4]},
    )
    given = ["--design", str(path), "--out", "runs", "--published", "out", "--jobs", "2"]
    assert command(demonstrator.main, given) == 0
    rows = pd.read_csv("out/demonstrator.csv", index_col=0)
    # four robots of this speed do more than one, and none touches another
    units = rows["units_per_h mean"]
    assert units.iloc[1] > 1.5 * units.iloc[0]
    assert list(rows["collisions mean"]) == [0.0, 0.0]
    for name in ("demonstrator.tex", "demonstrator-heat.png", "demonstrator-layout.png"):
        told = json.loads((tmp_path / "out" / f"{name}.provenance.json").read_text())
        assert told["file"] == name and told["rows"]["count"] == 4


def test_a_folder_without_the_layout_is_refused(tmp_path, capsys):
    assert command(demonstrator.main, ["--reference", str(tmp_path)]) == WRONG_INPUT
    assert "office-4bot.xinst does not exist" in capsys.readouterr().err


def test_every_layout_is_looked_for_before_the_first_run(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(path_planning, "done", lambda *_, **__: pytest.fail("a run was begun"))
    (tmp_path / "pp").mkdir()
    (tmp_path / path_planning.INSTANCES[0].reference).write_text("")
    assert command(path_planning.main, ["--reference", str(tmp_path)]) == WRONG_INPUT
    assert "1-12-20-128-1965.xinst does not exist" in capsys.readouterr().err


@pytest.mark.parametrize("study", [demonstrator, figure_5b])
def test_a_missing_design_lists_the_shipped_ones(study, capsys):
    assert command(study.main, ["--design", "nothing"]) == WRONG_INPUT
    told = capsys.readouterr().err
    assert "; shipped: " in told and "demonstrator" in told


def fleets() -> pd.DataFrame:
    """Two rules, three fleets, two seeds; the second seed is 2 units better throughout."""
    units = {
        ("near", 8): 100,
        ("near", 16): 180,
        ("near", 32): 176,
        ("far", 8): 90,
        ("far", 16): 150,
    }
    rows = [
        {
            "arm": f"robots={robots},psa={rule}",
            "controllers.psa": rule,
            "layout.robots": robots,
            "robots": robots,
            "replication": seed,
            "units_per_h": float(base + 2 * (seed - 1) + (4 if robots == 16 and seed == 2 else 0)),
        }
        for (rule, robots), base in units.items()
        for seed in (1, 2)
    ]
    return pd.DataFrame(rows)


def test_what_a_further_robot_adds_is_paired_by_seed():
    table = fleet_size.added(fleets()).frame
    assert list(table.index) == [
        "near, 8 to 16 robots", "near, 16 to 32 robots", "far, 8 to 16 robots",
    ]  # fmt: skip
    # (80, 84) / 8 and (-4, -8) / 16: means 10.25 and -0.375
    assert list(table["units_per_h", "mean"]) == [10.25, -0.375, 7.75]
    # half width for two seeds: 12.7062 sd / sqrt(2), sd = 0.5 / sqrt(2)
    assert table["units_per_h", "±"].iloc[0] == pytest.approx(12.7062 * 0.25, rel=1e-4)
    assert list(table["seeds", ""]) == [2, 2, 2]


def test_fleets_that_others_beat_are_not_on_the_front():
    table = fleet_size.unbeaten(fleets())
    assert list(table.frame.index) == ["robots=8,psa=near", "robots=16,psa=near"]
    assert list(table.frame["robots", "mean"]) == [8.0, 16.0]
    assert "no other arm dominates" in table.caption


def test_the_fleet_size_study_is_published(design, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = design(seeds=[1, 2], factors={"layout.robots": [8, 12], "controllers.psa": ["nearest"]})
    given = ["--design", str(path), "--out", "runs", "--published", "out", "--jobs", "2"]
    assert command(fleet_size.main, given) == 0
    written = sorted(p.name for p in (tmp_path / "out").iterdir() if "provenance" not in p.name)
    assert written == sorted(
        ["fleet-size.png"]
        + [f"fleet-size{part}.{form}" for part in ("", "-added", "-front") for form in
           ("csv", "md", "tex")]
    )  # fmt: skip
