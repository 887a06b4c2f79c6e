"""The study of charging: robots needed, by hand."""

from __future__ import annotations

from math import isnan

import pandas as pd
import pytest

from rmfs.experiments.papers.charging import needed, robots_for


def test_robots_are_interpolated_between_fleets():
    assert robots_for([10, 12, 14], [0.8, 0.9, 1.0]) == pytest.approx(13.0)
    assert robots_for([10, 12, 14], [0.8, 0.95, 0.94]) == pytest.approx(12.0)
    # a fleet that does worse than a smaller one counts as that one
    assert robots_for([10, 12, 14], [0.85, 0.75, 0.95]) == pytest.approx(14.0)
    assert isnan(robots_for([10, 12], [0.96, 0.97]))
    assert isnan(robots_for([10, 12], [0.5, 0.9]))


def test_more_robots_than_without_batteries():
    rows = [
        (recovery, replication, robots, share)
        for recovery, least in [("none", 10), ("plug-in", 12)]
        for replication in (1, 2)
        for robots, share in [(least - 2, 0.9), (least + 2, 1.0 + replication / 1000)]
    ]
    frame = pd.DataFrame(
        rows, columns=["recovery", "replication", "layout.robots", "station_share"]
    )
    table = needed(frame).frame
    assert table.loc["none", ("robots", "mean")] == pytest.approx(9.98, abs=0.02)
    assert table.loc["plug-in", ("more, %", "mean")] == pytest.approx(20.0, abs=0.5)
    assert isnan(table.loc["none", ("more, %", "mean")])


def test_no_figure_where_a_seed_reaches_it_with_no_fleet():
    """The mean of the other seeds would be too small."""
    rows = [("none", 1, 8, 0.9), ("none", 1, 12, 1.0), ("none", 2, 8, 0.9), ("none", 2, 12, 0.94)]
    frame = pd.DataFrame(
        rows, columns=["recovery", "replication", "layout.robots", "station_share"]
    )
    table = needed(frame).frame
    assert isnan(table.loc["none", ("robots", "mean")])
    assert table.loc["none", ("seeds", "")] == 1
