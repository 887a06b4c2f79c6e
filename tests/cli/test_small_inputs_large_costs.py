"""Small inputs that would cost gigabytes or minutes: refused, naming key and limit."""

from __future__ import annotations

import resource
import time

import pytest

from rmfs.cli import main

RUN = ["run", "--layout", "small", "--scenario", "small-arrivals", "--set"]
STOCKED = ["run", "--layout", "small", "--scenario", "small", "--set"]


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ([*RUN, "layout.pod_capacity=1e20"], "pod_capacity"),
        ([*RUN, 'scenario.skus.space={distribution="constant", value=1e-300}'], "space"),
        ([*STOCKED, 'scenario.demand={mode="backlog", orders=10000000}'], "100000"),
        ([*RUN, "scenario.demand.initial_orders=10000000"], "initial_orders"),
        (["layout", "check", "default", "--set", "layout.hall_width=100000"], "hall_width"),
    ],
)
def test_numbers(arguments, told, capsys):
    begun = time.process_time()
    assert main(arguments) == 2
    assert time.process_time() - begun < 10
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert told in error


def test_a_map_of_five_million_cells(tmp_path, capsys):
    path = tmp_path / "wide.map"
    row = "." * 2500 + "\n"
    path.write_text("type octile\nheight 2000\nwidth 2500\nmap\n" + row * 2000)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    assert main(["layout", "check", str(path)]) == 2
    assert "height and width: 5,000,000 cells; at most 1,200,000" in capsys.readouterr().err
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 200_000  # KiB


def test_arms_by_the_million(tmp_path, capsys):
    design = tmp_path / "many.toml"
    design.write_text(
        'format = "rmfs-design/1"\nname = "many"\nseeds = [1]\narms_file = "arms.csv"\n'
        '[base]\nlayout = "small"\nscenario = "small"\n'
    )
    arms = tmp_path / "arms.csv"
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    arms.write_text("layout.robots\n" + "16\n" * 8_000_000)
    assert main(["experiment", "plan", str(design)]) == 2
    assert "arms.csv: larger than 16 MiB" in capsys.readouterr().err
    arms.write_text("layout.robots\n" + "16\n" * 200_000)
    assert main(["experiment", "plan", str(design)]) == 2
    assert "arms.csv: more than 100,000 lines" in capsys.readouterr().err
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 300_000


def test_factors_that_multiply(tmp_path, capsys):
    design = tmp_path / "many.toml"
    levels = str(list(range(1, 1001)))
    design.write_text(
        'format = "rmfs-design/1"\nname = "many"\nseeds = [1]\n'
        '[base]\nlayout = "small"\nscenario = "small"\n[factors]\n'
        f'"layout.robots" = {levels}\n"layout.tiers" = {levels}\n"layout.seed" = {levels}\n'
    )
    assert main(["experiment", "plan", str(design)]) == 2
    assert "1,000,000,000 combinations; at most 1,000,000" in capsys.readouterr().err
