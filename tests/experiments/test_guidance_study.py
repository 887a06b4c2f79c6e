"""The study of guidance: its tables, by hand, and its design."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest

from rmfs import layout as layouts
from rmfs.experiments.design.planning import plan
from rmfs.experiments.papers.guidance import gains, levels, trip_gains
from rmfs.traffic.guidance import read_guidance


def runs() -> pd.DataFrame:
    """Return three seeds of two sites; guidance picks 10 % more units at the first."""
    rows = []
    for seed, units in enumerate((100.0, 110.0, 120.0), 1):
        for case, factor, delay_s in (
            ("hall, 8 robots: none", 1.0, 2.0),
            ("hall, 8 robots: optimised", 1.1, 1.5 + 0.1 * seed),
            ("street, 9 robots: none", 1.0, 3.0),
            ("street, 9 robots: lanes", 1.0 + 0.01 * (seed - 2), 3.0 + 0.1 * (seed - 2)),
        ):
            rows.append(
                {
                    "case": case,
                    "replication": seed,
                    "units_per_h": units * factor,
                    "trip_delay_mean_s": delay_s,
                    "trip_delay_share": delay_s / 20.0,
                    "distance_per_unit_m": 30.0 / factor,
                    "robot_idle_share": 0.25,
                }
            )
    return pd.DataFrame(rows)


def test_levels_are_those_without_guidance() -> None:
    frame = levels(runs()).frame
    assert list(frame.index) == ["hall, 8 robots", "street, 9 robots"]
    assert frame["units per hour", "mean"].tolist() == [110.0, 110.0]
    assert frame["delay, % of trip time", "mean"].tolist() == [10.0, 15.0]
    assert frame["robots without a task, %", "mean"].tolist() == [25.0, 25.0]


def test_gains_are_paired_and_corrected() -> None:
    frame = gains(runs()).frame
    assert list(frame.index) == ["hall, 8 robots, optimised", "street, 9 robots, lanes"]
    assert frame["units per hour, %", "mean"].tolist() == pytest.approx([10.0, 0.0], abs=1e-9)
    assert frame["delay per trip, s", "mean"].tolist() == pytest.approx([-0.3, 0.0], abs=1e-9)
    assert frame["metres per unit, %", "mean"].iloc[0] == pytest.approx(100 / 1.1 - 100)
    # t = -0.3 / (0.1 / sqrt(3)) with 2 degrees of freedom: p = 0.0351, doubled by Holm
    assert frame["p of delay", "Holm"].iloc[0] == pytest.approx(0.0702, abs=1e-4)
    assert frame["p of delay", "Holm"].iloc[1] == pytest.approx(1.0)


def test_trips_are_paired_and_corrected() -> None:
    frame = runs().rename(columns={"units_per_h": "trips_per_h"}).assign(labels_per_plan=7.0)
    table = trip_gains(frame).frame
    guided, usual = "hall, 8 robots, optimised", "hall, 8 robots, none"
    assert table.loc[usual, ("trips per hour", "mean")] == 110.0
    assert table.loc[guided, ("trips, %", "mean")] == pytest.approx(10.0)
    assert pd.isna(table.loc[usual, ("trips, %", "mean")])
    # t = 11 * sqrt(3) with 2 degrees of freedom: p = 0.00274, doubled by Holm
    assert table.loc[guided, ("p of trips", "Holm")] == pytest.approx(0.00549, abs=1e-5)
    # differences of -1, 0 and 1.2 trips: t = 0.105
    lanes = table.loc["street, 9 robots, lanes", ("p of trips", "Holm")]
    assert lanes == pytest.approx(0.926, abs=1e-3)
    assert set(table["labels per plan", "mean"]) == {7.0}


def test_the_design_pairs_every_site_with_a_run_without_guidance() -> None:
    made = plan("guidance")
    cases = [arm.name.removeprefix("case=") for arm in made.arms]
    sites = {case.partition(": ")[0] for case in cases}
    assert {f"{site}: none" for site in sites} <= set(cases)
    assert len(sites) >= 4
    for arm in made.arms:
        files = [Path(value) for path, value in arm.overrides if path[-1] == "guidance"]
        assert bool(files) != arm.name.endswith(": none")
        own = [(path[1:], value) for path, value in arm.overrides if path[0] == "layout"]
        layout = layouts.load(arm.inputs["layout"], own)
        assert all(read_guidance(file, layout) for file in files)
