"""The study of planning time: where planning begins to cost, worked out by hand."""

from __future__ import annotations

from math import isnan

import pandas as pd
import pytest

from rmfs.experiments.papers import price_of_planning as study


def runs(**units: list[float]) -> pd.DataFrame:
    """Make the runs of one fleet with two seeds, by kind of planning."""
    rows = [
        {
            "fleet": "eight",
            "planning": planning.replace("_", " "),
            "replication": replication,
            "units_per_h": value,
            "plans": 50,
            "duration_s": 1000.0,
        }
        for planning, values in units.items()
        for replication, value in enumerate(values)
    ]
    return pd.DataFrame(rows)


def made(**units: list[float]) -> pd.DataFrame:
    names = {"a": "0.1 s", "b": "1 s", "c": "10 s", "each": "1 s, each", "work": "work x 1,000"}
    frame = runs(instant=[100.0, 200.0], **units)
    return frame.assign(planning=frame["planning"].replace(names))


def test_planning_costs_from_where_all_longer_times_cost() -> None:
    frame = made(a=[99.0, 198.0], b=[101.0, 199.0], c=[50.0, 101.0], each=[90.0, 180.0])
    # 1 s: changes of 1 and -0.5 percent; that 0.1 s lost one percent twice does not count
    assert study.begins(frame, "eight", each=False) == (10.0, 1.0)
    begin, before = study.begins(frame, "eight", each=True)
    assert begin == 1.0 and isnan(before)
    begin, before = study.begins(made(a=[100.0, 200.0]), "eight", each=False)
    assert isnan(begin) and before == 0.1


def test_the_tables_show_changes_in_percent_and_plans() -> None:
    frame = made(b=[90.0, 180.0], work=[100.0, 210.0])
    losses = study.losses(frame).frame
    assert losses[("eight", "mean")].tolist() == pytest.approx([-10.0, 2.5])
    thresholds = study.thresholds(frame).frame
    assert thresholds[("plans per hour", "")].tolist() == pytest.approx([180.0])
    assert thresholds[("busy at, s", "")].tolist() == pytest.approx([20.0])
