"""The study of planning ahead, with runs of some minutes."""

from __future__ import annotations

import pandas as pd
import pytest

from rmfs.experiments.papers import fleet_large, planning
from rmfs.experiments.papers.study import command


def test_the_study_is_run_and_published(design, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = design(
        seeds=[1, 2],
        base={"layout": "small", "scenario.warmup_s": 0, "scenario.duration_s": 400},
        factors={
            "demand": [{"label": "backlog", "scenario": "small"}],
            "layout.robots": [3],
            "planned": [
                {"label": "planning", "controllers": "planning", "controllers.ta.steps": 5},
                {
                    "label": "start rule",
                    "controllers": "planning",
                    "controllers.ta.method": "greedy",
                },
            ],
        },
    )
    given = ["--design", str(path), "--out", "runs", "--published", "out", "--jobs", "1"]
    assert command(planning.main, given) == 0
    rows = pd.read_csv("out/planning.csv", index_col=0)
    assert list(rows.index) == ["backlog, 3, planning", "backlog, 3, start rule"]
    assert (rows["units_per_h mean"] > 100).all()
    gained = pd.read_csv("out/planning-gains.csv", index_col=0)
    assert list(gained.index) == ["backlog, 3, planning"]
    assert gained["units_per_h mean"].iloc[0] == pytest.approx(
        100 * (rows["units_per_h mean"].iloc[0] / rows["units_per_h mean"].iloc[1] - 1), abs=5
    )


def test_fleets_are_compared_and_drawn(design, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    path = design(
        seeds=[1, 2],
        base={"layout": "small", "scenario": "small", "scenario.duration_s": 900},
        factors={
            "layout.robots": [5, 10],
            "planned": [
                {"label": "planning", "controllers": "planning-split"},
                {
                    "label": "start rule",
                    "controllers": "planning-split",
                    "controllers.ta.method": "greedy",
                },
                {"label": "default rules", "controllers": "default"},
            ],
        },
    )
    given = ["--design", str(path), "--out", "runs", "--published", "out", "--jobs", "1"]
    assert command(fleet_large.main, given) == 0
    rows = pd.read_csv("out/fleet-large.csv", index_col=0)
    assert len(rows) == 6
    gained = pd.read_csv("out/fleet-large-gains.csv", index_col=0)
    assert list(gained.index) == ["5, planning", "10, planning"]
    assert (tmp_path / "out" / "fleet-large.png").is_file()
    bound = pd.read_csv("out/fleet-large-bound.csv", index_col=0)
    assert bound["units_per_h"].is_monotonic_increasing
    assert bound["station_share"].iloc[0] < 0.95
    assert bound["units_per_h"].iloc[-1] >= rows["units_per_h mean"].max()
    capsys.readouterr()
    assert command(fleet_large.main, [*given, "--bound"]) == 0
    assert capsys.readouterr().out.splitlines()[2].split()[1] == "1"
