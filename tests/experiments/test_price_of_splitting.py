"""The study of splitting: where it breaks even, by hand, and the command on a small design."""

from __future__ import annotations

from math import inf, isnan

import numpy as np
import pandas as pd
import pytest

from rmfs.experiments.papers import price_of_splitting
from rmfs.experiments.papers.price_of_splitting import (
    against_better,
    break_even,
    even,
    wall_of,
)
from rmfs.experiments.papers.study import command


def test_a_wall_is_told_by_its_label():
    assert wall_of("16 slots, 60 s") == (16.0, 60.0)
    assert wall_of("any slots, 600 s") == (inf, 600.0)
    with pytest.raises(ValueError, match="no wall"):
        wall_of("whole")


def test_slots_are_interpolated_between_walls():
    assert break_even([8, 16, inf], np.array([-0.02, 0.02, 0.03])) == pytest.approx(12.0)
    # a wall that does worse than a smaller one counts as that one
    assert break_even([8, 16, 32], np.array([-0.01, -0.03, 0.03])) == pytest.approx(20.0)
    assert break_even([8, 16], np.array([0.01, -0.03])) == 8.0
    assert break_even([8, 16], np.array([-0.01, 0.0])) == inf
    assert break_even([8, inf], np.array([-0.01, 0.1])) == 8.0


def results():
    """Two seeds; 600 units per hour whole, 5 % less with 10 slots, 5 % more with 20, 20 % any."""
    rows = []
    for seed in (1, 2):
        for label, units, cycle_s in [
            ("whole", 600.0, 500.0),
            ("10 slots, 60 s", 570.0, 500.0),
            ("20 slots, 60 s", 630.0, 500.0),
            ("20 slots, 60 s, always", 560.0 if seed == 1 else 580.0, 500.0),
            ("any slots, 60 s", 720.0, 600.0 if seed == 1 else 604.0),
        ]:
            rows.append(
                {
                    "demand": "backlog", "orders": label, "replication": seed,
                    "units_per_h": units, "order_cycle_mean_s": cycle_s, "pick_stations": 2,
                    "orders_packed": 100, "duration_s": 1800.0, "totes_per_order": 1.5,
                    "orders_packed_split_share": 0.4,
                }
            )  # fmt: skip
    return pd.DataFrame(rows)


def test_where_splitting_breaks_even():
    row = even(results()).frame.loc["backlog, 60 s"]
    assert row["slots", "mean"] == pytest.approx(15.0)
    assert row["slots", "2.5 %"] == row["slots", "97.5 %"] == pytest.approx(15.0)
    # two pickers save a sixth of 7200 s an hour; 200 orders have 100 further totes
    assert row["packer, s per tote", "mean"] == pytest.approx(12.0)
    # 100 and 104 s later with a way of 60 s for 40 % of the orders
    assert row["way, s", "mean"] == pytest.approx(60 - 102 / 0.4)
    assert not isnan(row["way, s", "±"])


def test_splitting_as_the_wall_goes_is_held_against_the_better_of_both():
    rows = against_better(results()).frame
    assert list(rows.index) == ["backlog, 20 slots, 60 s"]  # the others have no `always`
    row = rows.iloc[0]
    assert row["against whole, %", "mean"] == pytest.approx(5.0)
    assert row["against always, %", "mean"] == pytest.approx(50 * (63 / 56 + 63 / 58 - 2))
    assert row["against better, %", "mean"] == pytest.approx(5.0)  # 600 whole, 570 always


def test_the_study_as_a_command(design, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    split = {"controllers": "pile-on-split", "scenario.packing.slots": 4}
    always = {**split, "controllers.poa.split_orders": 100000}
    path = design(
        seeds=[1, 2],
        base={
            "layout": "small",
            "layout.robots": 6,
            "scenario.warmup_s": 600,
            "scenario.duration_s": 900,
            "scenario.packing.travel.constant_s": 60,
        },
        factors={
            "demand": [{"label": "backlog", "scenario": "small"}],
            "orders": [
                {"label": "whole", "controllers": "pile-on"},
                {"label": "4 slots, 60 s", **split},
                {"label": "4 slots, 60 s, always", **always},
                {"label": "any slots, 60 s", "controllers": "pile-on-split"},
                {
                    "label": "whole, start rule",
                    "controllers": "pile-on",
                    "controllers.poa.method": "greedy",
                },
            ],
        },
    )
    given = ["--design", str(path), "--out", "runs", "--published", "out", "--jobs", "1"]
    assert command(price_of_splitting.main, given) == 0
    rows = pd.read_csv("out/price-of-splitting.csv", index_col=0)
    assert len(rows) == 5
    added = pd.read_csv("out/price-of-splitting-optimiser.csv", index_col=0)
    assert list(added.index) == ["backlog, whole"]
    gained = pd.read_csv("out/price-of-splitting-gains.csv", index_col=0)
    assert len(gained) == 3  # the start rule is not one of them
    assert rows.loc["backlog, 4 slots, 60 s", "wall_slots_max mean"] <= 4
    assert rows.loc["backlog, 4 slots, 60 s, always", "wall_slots_max mean"] > 4  # by hand
    assert rows.loc["backlog, any slots, 60 s", "wall_slots_max mean"] > 4
    better = pd.read_csv("out/price-of-splitting-better.csv", index_col=0)
    assert list(better.index) == ["backlog, 4 slots, 60 s"]
    even = pd.read_csv("out/price-of-splitting-even.csv", index_col=0)
    assert list(even.index) == ["backlog, 60 s"]


def test_one_site_at_a_time(capsys):
    with pytest.raises(SystemExit) as refused:
        price_of_splitting.main(["--default", "--large"])
    assert refused.value.code == 2
    assert "not allowed with" in capsys.readouterr().err
