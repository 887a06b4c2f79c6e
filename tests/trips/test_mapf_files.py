"""The public warehouse maps of the League of Robot Runners, as the documentation says."""

from pathlib import Path

import pytest

from rmfs.cli import main
from rmfs.experiments.traffic.duel import all_planners

FOLDER = Path(__file__).resolve().parents[2] / "../shared/reference/instances/mapf"

pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason=f"{FOLDER} is not here")


def duel(capsys, name, *options):
    """Drive trips on a map, prove the motion safe, and return the cells of the table's row."""
    command = ["traffic", "duel", str(FOLDER / name), "--check", *map(str, options)]
    assert main(command) == 0
    row = [cell.strip() for cell in capsys.readouterr().out.splitlines()[-1].split("|")[1:-1]]
    assert row[-1] == "0", "collisions"
    return row


@pytest.mark.parametrize("planner", all_planners())
def test_small_warehouse(planner, capsys):
    """A third of the robots of the file, with its tasks: all planners are safe and get on."""
    agents, tasks = FOLDER / "warehouse_small_100.agents", FOLDER / "warehouse_small.tasks"
    row = duel(
        capsys, "warehouse_small.map", "--agents", agents, "--tasks", tasks,
        "--robots", 30, "--duration", 30, "--planner", planner,
    )  # fmt: skip
    assert row[0] == planner
    assert float(row[1].replace(",", "")) > 500, "trips/h"


def test_all_robots_of_the_small_warehouse(capsys):
    """A hundred robots in lanes both ways: whoever finds no way waits."""
    agents, tasks = FOLDER / "warehouse_small_100.agents", FOLDER / "warehouse_small.tasks"
    row = duel(
        capsys, "warehouse_small.map", "--agents", agents, "--tasks", tasks,
        "--duration", 120, "--planner", "time-windows",
    )  # fmt: skip
    assert float(row[1].replace(",", "")) > 1000, "trips/h"


@pytest.mark.parametrize("planner", ["time-windows", "pibt"])
def test_large_warehouse(planner, capsys):
    """38,586 cells and random trips."""
    agents = FOLDER / "warehouse_large_1000.agents"
    row = duel(
        capsys, "warehouse_large.map", "--agents", agents,
        "--robots", 30, "--duration", 60, "--planner", planner,
    )  # fmt: skip
    assert float(row[1].replace(",", "")) > 100, "trips/h"
