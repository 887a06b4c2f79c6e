"""What optimisers add to their own start rules: by hand, and in the studies."""

from __future__ import annotations

import pandas as pd
import pytest

from rmfs.experiments.papers import fewer_robots, joint_large, joint_small
from rmfs.experiments.papers.benefit import START, completed, of_optimiser
from rmfs.experiments.papers.study import command

BACKLOG = [{"label": "backlog", "scenario": "small"}]
START_RULE = {"controllers": "pile-on", "controllers.poa.method": "greedy"}


def test_each_is_compared_with_its_own_start_rule_seed_by_seed():
    frame = pd.DataFrame(
        {
            "demand": "backlog",
            "controllers": ["a", "a", f"a{START}", f"a{START}", "b", "b"],
            "replication": [1, 2] * 3,
            "units_per_h": [110.0, 240.0, 100.0, 200.0, 500.0, 500.0],
        }
    )
    made = of_optimiser(frame, ("demand",), ("units_per_h",)).frame
    assert list(made.index) == ["backlog, a"]
    assert made.loc["backlog, a", ("units_per_h", "mean")] == pytest.approx(15.0)


def test_no_percentage_of_zero():
    """A start rule that stores no bundle with one seed: there is no difference in percent."""
    frame = pd.DataFrame(
        {
            "demand": "backlog",
            "controllers": ["a", "a", f"a{START}", f"a{START}"],
            "replication": [1, 2] * 2,
            "bundles_per_h": [10.0, 20.0, 0.0, 10.0],
        }
    )
    made = of_optimiser(frame, ("demand",), ("bundles_per_h",))
    assert made.frame.loc["backlog, a"].isna().all()
    assert "inf" not in made.markdown()


def test_rules_of_a_design_are_its_controllers():
    frame = pd.DataFrame(
        {
            "rules": ["a"],
            "pick_stations": [2],
            "units_per_h": [360.0],
            "distance_m": [50.0],
            "orders_completed": [10],
        }
    )
    made = completed(frame, 360.0)
    assert made["controllers"].tolist() == ["a"]
    assert made["station_share"].tolist() == [0.5]


@pytest.mark.parametrize(
    ("study", "levels"),
    [
        (joint_small, {"demand": BACKLOG, "layout.robots": [6]}),
        (joint_large, {"demand": BACKLOG}),
        (fewer_robots, {"layout.robots": [6]}),
    ],
    ids=["joint_small", "joint_large", "fewer_robots"],
)
def test_studies_publish_what_the_optimiser_adds(study, levels, design, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    baseline = getattr(study, "BASELINE", "default")
    path = design(
        seeds=[1, 2],
        base={
            "layout": "small",
            "layout.robots": 6,
            "scenario": "small",
            "scenario.warmup_s": 600,
            "scenario.duration_s": 900,
        },
        factors={
            **levels,
            "rules": [
                {"label": baseline, "controllers": baseline},
                {"label": "pile-on", "controllers": "pile-on"},
                {"label": "pile-on-split", "controllers": "pile-on-split"},
                {"label": f"pile-on{START}", **START_RULE},
            ],
        },
    )
    given = ["--design", str(path), "--out", "runs", "--published", "out", "--jobs", "1"]
    assert command(study.main, given) == 0
    (table,) = (tmp_path / "out").glob("*-optimiser.csv")
    rows = pd.read_csv(table, index_col=0)
    assert len(rows) == 1
    assert "pile-on" in rows.index[0] and START not in rows.index[0]
