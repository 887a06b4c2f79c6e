"""The study of splitting: where it breaks even, by hand, and the command at smoke size."""

from __future__ import annotations

from math import inf, isnan

import numpy as np
import pandas as pd
import pytest

from rmfs.experiments.papers import price_of_splitting
from rmfs.experiments.papers.price_of_splitting import break_even, even, wall_of


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


@pytest.mark.slow
def test_the_study_as_a_command(tmp_path, capsys):
    given = ["--smoke", "--jobs", "1", "--out", str(tmp_path / "runs")]
    price_of_splitting.main([*given, "--published", str(tmp_path)])
    for name in ("", "-gains", "-even"):
        assert (tmp_path / f"price-of-splitting{name}-smoke.md").is_file()
    told = (tmp_path / "price-of-splitting-smoke.csv").read_text("utf-8").splitlines()
    assert sum(row.startswith(('"backlog', '"arrivals')) for row in told) == 16
    assert "| backlog, any slots, 60 s" in capsys.readouterr().out
