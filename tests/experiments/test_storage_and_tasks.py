"""The study of storage locations and tasks, at smoke size."""

from __future__ import annotations

import pandas as pd
import pytest

from rmfs.experiments.papers import benefit, storage_and_tasks
from rmfs.experiments.papers.study import command


def test_the_study_is_run_and_published(design, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = design(
        seeds=[1, 2],
        base={
            "layout": "default",
            "layout.robots": 4,
            "layout.pick_stations.east": 2,
            "layout.replenishment_stations.west": 2,
            "scenario.skus.count": 200,
            "scenario.warmup_s": 0,
            "scenario.duration_s": 300,
        },
        factors={
            "demand": [
                {"label": "backlog", "scenario": "default"},
                {"label": "arrivals", "scenario": "poisson"},
            ],
            "rules": [
                {"label": "nearest, balanced", "controllers": "default"},
                {"label": "PSA placement", "controllers": "psa-placement"},
                {
                    "label": "PSA placement, start rule",
                    "controllers": "psa-placement",
                    "controllers.psa.method": "greedy",
                },
            ],
        },
    )
    given = ["--design", str(path), "--out", "runs", "--published", "out", "--jobs", "1"]
    assert command(storage_and_tasks.main, given) == 0
    for demand in ("backlog", "arrivals"):
        rows = pd.read_csv(f"out/storage-and-tasks-{demand}.csv", index_col=0)
        assert list(rows.index)[:2] == ["nearest, balanced", "PSA placement"]
        added = pd.read_csv(f"out/storage-and-tasks-{demand}-optimiser.csv", index_col=0)
        assert list(added.index) == [f"{demand}, PSA placement"]
        compared = pd.read_csv(f"out/storage-and-tasks-{demand}-differences.csv", index_col=0)
        assert list(compared.index) == ["PSA placement"]
        both = rows["units_per_h mean"]
        apart = compared.loc["PSA placement", "units_per_h difference"]
        assert apart == pytest.approx(both.iloc[1] - both.iloc[0], abs=0.11)
        shares = pd.read_csv(f"out/storage-and-tasks-{demand}-decisions.csv", index_col=0)
        assert list(shares["seeds"]) == [2, 2]
        assert shares["optimiser_decision_share mean"].min() >= 0.9


def test_runs_with_too_few_decisions_by_the_optimiser_are_not_published():
    frame = pd.DataFrame(
        {
            "arm": ["rules", "a", "a", "b"],
            "optimiser_calls": [0, 10, 10, 10],
            "optimiser_decision_share": [float("nan"), 0.95, 0.89, 0.9],
        }
    )
    assert benefit.too_few(frame) == ["a"]
