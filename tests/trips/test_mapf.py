"""Maps, robots and trips of the path-finding community's files, made here."""

import pytest

from rmfs.cli import main
from rmfs.errors import InputError
from rmfs.layout import load
from rmfs.trips import drive
from rmfs.trips.mapf import league, scenario

GRID = "type octile\nheight 3\nwidth 5\nmap\n.....\n.@@@.\n..S.E\n"


@pytest.fixture
def grid(tmp_path):
    path = tmp_path / "grid.map"
    path.write_text(GRID)
    return path


def test_free_cells_are_waypoints_with_lanes_both_ways(grid):
    """12 free cells in a ring: 12 undirected edges; the first row lies on top."""
    layout = load(str(grid))
    assert layout.waypoints == 12
    assert len(layout.edge_target) == 24
    assert (layout.x_m[0], layout.y_m[0]) == (0.5, 2.5)
    assert (layout.x_m[-1], layout.y_m[-1]) == (4.5, 0.5)


def test_a_scenario(grid, tmp_path):
    """Two robots go round the ring in one sense: both arrive, at the cells of the file."""
    scen = tmp_path / "grid.scen"
    rows = ["0\tgrid.map\t5\t3\t0\t0\t4\t0\t4", "0\tgrid.map\t5\t3\t4\t2\t0\t2\t4"]
    scen.write_text("\n".join(["version 1", *rows]) + "\n")
    layout, trips = scenario(grid, scen)
    assert layout.robot_waypoint.tolist() == [0, 11]
    run = drive(layout, trips(), duration_s=120, proven=True)
    assert run.report.ok
    assert sorted(run.traffic.trips()["to_wp"].tolist()) == [4, 7]
    with pytest.raises(InputError, match="has 2 robots, not 3"):
        scenario(grid, scen, 3)


@pytest.mark.parametrize("cells", ["5 0 4 0", "0 0 -1 1"])
def test_a_column_outside_the_map_is_refused(grid, tmp_path, cells):
    """Column 5 of row 0 would be counted as column 0 of row 1."""
    scen = tmp_path / "grid.scen"
    scen.write_text(f"version 1\n0 grid.map 5 3 {cells} 4\n")
    with pytest.raises(InputError, match="is outside the map, which has 5 columns"):
        scenario(grid, scen)


def test_a_line_without_a_cell_is_refused(grid, tmp_path):
    agents = tmp_path / "a.agents"
    agents.write_text("2\n0\n,\n")
    with pytest.raises(InputError, match="expected whole numbers"):
        league(grid, agents, None)


def test_robots_and_tasks_of_the_league(grid, tmp_path):
    agents, tasks = tmp_path / "a.agents", tmp_path / "t.tasks"
    agents.write_text("1\n0\n")
    tasks.write_text("2\n4\n14,10\n")
    layout, trips = league(grid, agents, tasks)
    run = drive(layout, trips(), duration_s=120, proven=True)
    assert run.report.ok
    assert run.traffic.trips()["to_wp"].tolist() == [4, 11, 7]
    tasks.write_text("1\n6\n")
    with pytest.raises(InputError, match="cell 6 is not a free cell"):
        league(grid, agents, tasks)


def test_a_duel_on_a_map(grid, tmp_path, capsys):
    agents = tmp_path / "a.agents"
    agents.write_text("2\n0\n14\n")
    command = ["traffic", "duel", str(grid), "--agents", str(agents), "--duration", "60"]
    assert main([*command, "--planner", "time-windows", "--check"]) == 0
    assert "time-windows" in capsys.readouterr().out


def test_what_is_no_map(tmp_path):
    path = tmp_path / "x.map"
    path.write_text("type octile\nheight 2\nwidth 2\nmap\n..\n")
    with pytest.raises(InputError, match="expected 2 rows of 2 cells"):
        load(str(path))
