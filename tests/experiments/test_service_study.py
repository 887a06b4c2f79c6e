"""The study of orders on time, with runs of some minutes."""

from __future__ import annotations

import pandas as pd
import pytest

from rmfs.experiments.papers import service
from rmfs.experiments.papers.study import command


def test_the_study_is_run_and_published(design, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    planning = {"controllers": "planning", "controllers.ta.steps": 5}
    late = {**planning, "controllers.ta.late_s": 200}
    path = design(
        seeds=[1, 2],
        base={"layout": "small", "scenario.warmup_s": 0},
        factors={
            "due": [
                {
                    "label": "tight",
                    "scenario": "small-arrivals",
                    "scenario.orders.due.urgent_offset_s": 60,
                    "scenario.orders.due.ordinary_offset_s": 200,
                }
            ],
            "decided": [
                {"label": "first-come", "controllers.poa.name": "first-come"},
                {"label": "pod-match", "controllers.poa.name": "pod-match"},
                {"label": "optimiser", **late},
                {"label": "optimiser, work", **late, "pacing": "work"},
                {"label": "start rule", **late, "controllers.ta.method": "greedy"},
                {"label": "without due times", **planning},
            ],
        },
    )
    given = ["--smoke", "--design", str(path), "--out", "runs", "--published", "out", "--jobs", "1"]
    assert command(service.main, given) == 0
    means = pd.read_csv("out/service-smoke.csv", index_col=0)["on_time_share mean"]
    assert len(means) == 6
    best = max(("first-come", "pod-match"), key=lambda rule: means[f"tight, {rule}"])
    gained = pd.read_csv("out/service-gains-smoke.csv", index_col=0)
    assert gained.index[0] == f"tight, optimiser against best rule ({best})"
    assert gained["on_time_share, points mean"].iloc[0] == pytest.approx(
        100 * (means["tight, optimiser"] - means[f"tight, {best}"])
    )
