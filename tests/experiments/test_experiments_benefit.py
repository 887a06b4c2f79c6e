"""What joint decisions are worth: the tables by hand, and the studies as commands at smoke size."""

from __future__ import annotations

import json
from types import SimpleNamespace

import pandas as pd
import pytest

from rmfs.experiments.papers import (
    benefit,
    fewer_robots,
    joint_large,
    joint_small,
    price_of_thinking,
)
from rmfs.experiments.papers.study import FAILED

SMALL = {"layout": "small", "scenario": "small", "layout.robots": 6}


def results(**shares: float) -> pd.DataFrame:
    """Two seeds of two controllers: 700 and 500 units, then 900 and 600, per hour."""
    rows = []
    for seed, (joint, rule) in {1: (700.0, 500.0), 2: (900.0, 600.0)}.items():
        for name, units in (("joint", joint), ("rule", rule)):
            asks = name == "joint"
            row = {
                "arm": name, "controllers": name, "demand": "backlog", "replication": seed,
                "units_per_h": units, "units_per_h_bound": 1000.0, "pick_stations": 2,
                "distance_m": 100 * units, "orders_completed": units / 2,
                "layout.robots": 6 if asks else 10,
                "optimiser_calls": 5 if asks else 0, "optimiser_wall_median_s": 0.01,
            }  # fmt: skip
            row |= {share: shares.get(share, float(asks)) for share in benefit.SHARES}
            rows.append(row if asks else row | dict.fromkeys(benefit.SHARES, float("nan")))
    return benefit.completed(pd.DataFrame(rows), station_units_per_h=450.0)


def test_gains_are_taken_seed_by_seed() -> None:
    """40 % and 50 % more units: 45 % in the mean, not 800 / 550 - 1."""
    table = benefit.gains(results(), ("demand",), "rule", ("units_per_h", "distance_per_order_m"))
    assert list(table.frame.index) == ["backlog, joint"]
    row = table.frame.loc["backlog, joint"]
    assert row["units_per_h", "mean"] == pytest.approx(45.0)
    # Student's t of two values 40 and 50: 12.706 x 5
    assert row["units_per_h", "±"] == pytest.approx(63.53, abs=0.01)
    assert row["distance_per_order_m", "mean"] == pytest.approx(0.0)


def test_shares_and_bound_stand_in_every_overview() -> None:
    table = benefit.overview(results(), ("demand", "controllers"), ("units_per_h", "station_share"))
    row = table.frame.loc["backlog, joint"]
    assert row["station_share", "mean"] == pytest.approx(800 / 900)
    assert row["units_per_h_bound", ""] == 1000.0
    assert [row[share, ""] for share in benefit.SHARES] == [1.0] * 4
    assert table.frame.loc["backlog, rule"][list(benefit.SHARES)].isna().all()


def test_under_nine_of_ten_decisions_by_optimisers_nothing_is_shown(capsys) -> None:
    enough, few = results(optimiser_decision_share=0.9), results(optimiser_decision_share=0.89)
    benefit.require_optimised(SimpleNamespace(frame=enough, smoke=False))
    with pytest.raises(SystemExit) as failed:
        benefit.require_optimised(SimpleNamespace(frame=few, smoke=False))
    assert failed.value.code == FAILED
    assert "joint" in capsys.readouterr().err


def test_the_smallest_fleet_that_feeds_the_stations() -> None:
    """Of 900 units: joint has 800 on average with six robots, the rule 550 with ten."""
    found = fewer_robots.needed(results(), ("controllers",), enough=0.88).frame
    assert found.loc["joint", ("robots", "")] == 6
    assert pd.isna(found.loc["rule", ("robots", "")])


@pytest.mark.parametrize(
    ("study", "factors", "tables"),
    [
        (
            joint_small,
            {
                "demand": [{"label": "backlog", "scenario": "small"}],
                "layout.robots": [6],
                "controllers": ["sequ", "pile-on", "pile-on-split"],
            },
            ["joint-small", "joint-small-gains", "joint-small-split"],
        ),
        (
            joint_large,
            {
                "demand": [{"label": "arrivals", "scenario": "small-arrivals"}],
                "controllers": ["default", "pile-on-split"],
            },
            ["joint-large", "joint-large-gains"],
        ),
        (
            fewer_robots,
            {"controllers": ["default", "pile-on-split"], "layout.robots": [10]},
            ["fewer-robots", "fewer-robots-needed"],
        ),
        (
            fewer_robots,
            {
                "demand": [{"label": "arrivals", "scenario": "small-arrivals"}],
                "controllers": ["default", "pile-on-dispatch"],
                "layout.robots": [4],
            },
            ["fewer-robots-later", "fewer-robots-later-needed"],
        ),
        (
            price_of_thinking,
            {
                "thinking": [
                    {"label": "none"},
                    {"label": "fixed 30 s", "pacing": "fixed=30"},
                    {"label": "work 1 s", "pacing": "work", "controllers.poa.work_s": 1.0},
                ]
            },
            ["price-of-thinking"],
        ),
    ],
    ids=["joint-small", "joint-large", "fewer-robots", "fewer-robots-later", "price-of-thinking"],
)
def test_smoke(study, factors, tables, design, tmp_path, monkeypatch) -> None:
    """Two seeds, five minutes: every table is there, with its provenance."""
    monkeypatch.chdir(tmp_path)
    base = {**SMALL, "controllers": "pile-on-split"}
    name = tables[0]
    path = design(name=name, base=base, factors=factors)
    published = tmp_path / "published"
    given = ["--design", str(path), "--smoke", "--jobs", "1", "--published", str(published)]
    study.main(given)
    for table in tables:
        told = json.loads((published / f"{table}-smoke.md.provenance.json").read_text())
        assert told["design"] == name
    assert "±" in (published / f"{name}-smoke.md").read_text()
