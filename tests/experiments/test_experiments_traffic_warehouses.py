"""How the work of whole warehouses grows with the fleet: `rmfs traffic warehouses`."""

import json

import pandas as pd
import pytest
from typer.testing import CliRunner

from rmfs.errors import InputError
from rmfs.experiments.traffic import warehouses
from rmfs.experiments.traffic.commands import app


@pytest.mark.parametrize("site", warehouses.SITES, ids=lambda site: str(site.robots))
def test_sites_keep_their_density(site):
    """Ten to eleven pods a robot, eleven to twelve robots a pick station."""
    layout = site.layout()
    assert layout.robots == site.robots
    assert 10.0 <= layout.pods / layout.robots <= 11.0
    assert 11.0 <= layout.robots / sum(site.picks) <= 12.0


def test_growth_is_from_the_smallest_to_the_biggest():
    rows = {"rules": ["a", "b", "a", "b"], "CPU s per robot-hour": [1.0, 2.0, 3.0, 3.0]}
    frame = pd.DataFrame(rows, index=pd.Index([1, 1, 2, 2], name="robots"))
    assert warehouses.growth(frame) == {"a": 3.0, "b": 1.5}


def test_the_smallest_site_proven_safe(tmp_path):
    """A row whose figures fit each other, and beside each file what it was made by."""
    sizes = ["--least", "125", "--most", "125"]
    told = ["--rules", "default", "--later", "60", "--check", "--out", str(tmp_path)]
    result = CliRunner().invoke(app, ["warehouses", *sizes, *told])
    assert result.exit_code == 0, result.output
    row = pd.read_csv(tmp_path / "scale-warehouses.csv").set_index("robots").loc[125]
    assert row["rules"] == "default"
    assert row["faster"] == pytest.approx(600.0 / row["CPU s"])
    assert row["faster with the start"] == pytest.approx(60.0 / row["CPU s, start"])
    assert row["CPU s per robot-hour"] == pytest.approx(row["CPU s"] / 125 * 6)
    # a unit takes a station 10 s; orders have a few units each
    assert 50.0 < row["stations busy %"] <= 100.0
    assert 11 * 60 < row["orders/h"] < 11 * 360
    assert (row["collisions"], row["standing"]) == (0, 0)
    made = json.loads((tmp_path / "scale-warehouses.md.provenance.json").read_text())
    assert made["check"] is True
    assert [site["robots"] for site in made["sites"]] == [125]


def test_no_site_of_that_size():
    result = CliRunner().invoke(app, ["warehouses", "--least", "300", "--most", "400"])
    assert isinstance(result.exception, InputError)
    assert "--least 300" in str(result.exception)
