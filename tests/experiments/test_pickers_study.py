"""The study of pickers, with runs of some minutes."""

from __future__ import annotations

import pandas as pd
import pytest

from rmfs.experiments.papers import pickers
from rmfs.experiments.papers.study import command


def test_the_study_is_run_and_published(design, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(pickers, "COMPARED", (("planning, balance", "planning"),))
    path = design(
        seeds=[1, 3],
        base={
            "layout": "small",
            "scenario": "small-arrivals",
            "layout.robots": 5,
            "scenario.warmup_s": 600,
            "scenario.duration_s": 2400,
            "scenario.demand.orders_per_h": 150,
            "scenario.demand.initial_orders": 20,
            "scenario.pickers.speeds": [1.2, 0.8],
        },
        factors={
            "decided": [
                {"label": "planning", "controllers": "planning"},
                {
                    "label": "planning, balance",
                    "controllers": "planning",
                    "controllers.ta.balance": 2.0,
                },
            ],
        },
    )
    given = ["--design", str(path), "--out", "runs", "--published", "out", "--jobs", "1"]
    assert command(pickers.main, given) == 0
    means = pd.read_csv("out/pickers.csv", index_col=0)["picker_work_variation mean"]
    assert means["planning, balance"] != means["planning"]
    assert means.between(0, 1).all()
    told = pd.read_csv("out/pickers-differences.csv", index_col=0)
    assert told["picker_work_variation mean"].iloc[0] == pytest.approx(
        means["planning, balance"] - means["planning"]
    )
