"""How the work of whole warehouses grows with the fleet: `rmfs traffic warehouses`."""

import json

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

from rmfs import Simulation
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


def test_robots_that_stand_still_are_counted_in_every_window():
    """A robot with work that neither moves nor is served for a whole window; others are not."""
    parts = ("moving_s", "turning_s", "transfer_s", "served_s", "waiting_s")
    stood, served, rested = np.eye(3) * warehouses.WINDOW_S
    motion = dict.fromkeys(parts, np.zeros(3)) | {"waiting_s": stood, "served_s": served}
    assert warehouses.standing_with_work(motion) == 1
    assert warehouses.standing_with_work(motion | {"moving_s": stood}) == 0
    assert warehouses.standing_with_work(motion | {"waiting_s": rested * 0}) == 0


def test_windows_cover_the_run_from_its_start(monkeypatch):
    def simulation():
        return Simulation("small", set={"scenario.warmup_s": 1500.0, "scenario.duration_s": 1.0})

    windows = []

    def counted(motion):
        windows.append(motion["distance_m"])
        return len(windows)

    monkeypatch.setattr(warehouses, "standing_with_work", counted)
    made, again = simulation(), simulation()
    assert warehouses.advance_by_windows(made, 1500.0) == 2
    assert made.world.now_s == 1500.0
    again.run_until(1200.0)
    assert sum(windows) == pytest.approx(again.traffic.motion()["distance_m"])


def test_no_site_of_that_size():
    result = CliRunner().invoke(app, ["warehouses", "--least", "300", "--most", "400"])
    assert isinstance(result.exception, InputError)
    assert "--least 300" in str(result.exception)
