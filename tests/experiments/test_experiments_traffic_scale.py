"""How work grows with the fleet: `rmfs traffic scale`."""

import json
from dataclasses import asdict

import pandas as pd
import pytest
from typer.testing import CliRunner

from rmfs.experiments.traffic import scale
from rmfs.experiments.traffic.commands import app


def frame(cpu_s):
    robots = [32, 64, 128]
    rows = {"trips/h": [100.0, 200.0, 400.0], "km/h": [10.0, 40.0, 160.0], "CPU s per h": cpu_s}
    return pd.DataFrame({**rows, "peak MB": 200.0}, index=pd.Index(robots, name="robots"))


@pytest.mark.parametrize(
    ("cpu_s", "by_trips", "by_metres"),
    [((3.0, 6.0, 12.0), 1.0, 0.5), ((1.0, 4.0, 16.0), 2.0, 1.0)],
)
def test_exponents_of_exact_powers(cpu_s, by_trips, by_metres):
    assert scale.exponent(frame(cpu_s)) == pytest.approx(by_trips)
    assert scale.exponent(frame(cpu_s), "km/h") == pytest.approx(by_metres)


@pytest.mark.parametrize("size", scale.SIZES[:4], ids=lambda size: str(size.robots))
def test_sizes_keep_their_density(size):
    """28 to 31 waypoints and at least 1/18 of a station a robot."""
    layout = size.layout()
    assert layout.robots == size.robots
    assert layout.waypoints / layout.robots == pytest.approx(29.5, abs=1.5)
    assert len(layout.stations) >= layout.robots / 18


def test_the_smallest_fleet(tmp_path):
    """A row, a picture, and beside each file what it was made by."""
    result = CliRunner().invoke(
        app, ["scale", "--most", "32", "--duration", "60", "--out", str(tmp_path)]
    )
    assert result.exit_code == 0, result.output
    table = pd.read_csv(tmp_path / "scale.csv").set_index("robots")
    row = table.loc[32]
    assert row["planner"] == "time-windows:swift=true"
    # a robot fetches, brings and stores a pod in one to three minutes
    assert 32 * 3 * 20 < row["trips/h"] < 32 * 3 * 60
    assert row["times faster"] == pytest.approx(3600.0 / row["CPU s per h"], rel=1e-6)
    assert (tmp_path / "scale.png").read_bytes().startswith(b"\x89PNG")
    told = json.loads((tmp_path / "scale.csv.provenance.json").read_text())
    assert told["planner"] == row["planner"]
    assert [size["robots"] for size in told["sizes"]] == [32]


@pytest.mark.slow
def test_two_thousand_robots_on_fifty_thousand_waypoints():
    """All of them work, in less than a gigabyte."""
    row = scale.measure(asdict(scale.SIZES[-1]), "time-windows:swift=true", 60.0, 1)
    assert row["robots"] == 2000
    assert row["waypoints"] > 50_000
    assert row["trips/h"] > 20_000
    assert row["peak MB"] < 1000
