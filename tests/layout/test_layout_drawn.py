"""Layouts drawn as text, and grid maps with stations."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import rmfs
from rmfs.cli import main
from rmfs.errors import InputError
from rmfs.layout import check, load
from rmfs.layout.explicit import read_json

HALL = """format = "rmfs-layout-drawn/1"
robots = 6
---
Rqqq.......qqqP
...............
.xxxxxx.xxxxxx.
.xxxxxx.xxxxxx.
...............
.xxxxxx.xxxxxx.
.xxxxxx.xxxxxx.
...............
Rqqq.......qqqP
"""
RWARE = """
...........
.xx.xx.xx..
.xx.xx.xx..
...........
.xx.xx.xx..
.xx.xx.xx..
...........
...........
R.........g
"""


def written(folder: Path, text: str, name: str = "drawn.txt") -> Path:
    path = folder / name
    path.write_text(text)
    return path


def edges(layout) -> set[tuple[tuple[float, float], tuple[float, float]]]:
    """Edges by the cells (column, row from the bottom) at their ends."""
    tails = np.repeat(np.arange(layout.waypoints), np.diff(layout.edge_start))
    cell = list(zip((layout.x_m - 0.5).tolist(), (layout.y_m - 0.5).tolist(), strict=True))
    return {(cell[a], cell[b]) for a, b in zip(tails, layout.edge_target, strict=True)}


def test_a_drawn_layout_is_well_formed_and_as_drawn(tmp_path: Path):
    layout = load(written(tmp_path, HALL))
    assert check(layout) == []
    assert (layout.name, layout.robots, layout.pods) == ("drawn", 6, 40)
    assert int(layout.is_storage.sum()) == 48
    assert len(layout.pick_stations) == len(layout.replenishment_stations) == 2
    assert [len(station.queue) for station in layout.stations] == [4, 4, 4, 4]
    first = layout.pick_stations[0]
    assert (layout.x_m[first.waypoint], layout.y_m[first.waypoint]) == (14.5, 8.5)
    assert layout.tiers[0].length_m == 15.0 and layout.tiers[0].width_m == 9.0
    assert {station.activation for station in layout.pick_stations} == {1, 2}


def test_queues_are_entered_at_their_entrance_only_and_lead_to_the_station(tmp_path: Path):
    found = edges(load(written(tmp_path, HALL)))
    queue = [(14.0, 8.0), (13.0, 8.0), (12.0, 8.0), (11.0, 8.0)]
    for ahead, place in pairwise(queue):
        assert {head for tail, head in found if tail == place} == {ahead}
    assert {tail for tail, head in found if head == queue[-1]} == {(10.0, 8.0), (11.0, 7.0)}
    assert {tail for tail, head in found if head == queue[0]} == {queue[1]}
    assert {head for tail, head in found if tail == queue[0]} == {(14.0, 7.0)}


def test_arrows_are_left_in_their_direction_only(tmp_path: Path):
    picture = "P.....R\n.>>>>v.\n.^xoXv.\n.^<<<<.\n......."
    layout = load(written(tmp_path, f"queue_length = 0\nrobots = 1\n---\n{picture}\n"))
    found = edges(layout)
    assert {head for tail, head in found if tail == (2.0, 3.0)} == {(3.0, 3.0), (2.0, 2.0)}
    # from everywhere but against the arrow
    assert {tail for tail, head in found if head == (2.0, 3.0)} == {
        (1.0, 3.0), (2.0, 4.0), (2.0, 2.0)
    }  # fmt: skip
    assert ((6.0, 1.0), (5.0, 1.0)) in found
    assert ((2.0, 1.0), (2.0, 0.0)) not in found


def test_pods_stand_where_they_are_drawn(tmp_path: Path):
    picture = "P.....R\n..XXoo.\n..xxxx.\n.......\n"
    layout = load(written(tmp_path, f"pod_share = 0.5\nrobots = 1\n---\n{picture}"))
    row = layout.y_m[layout.pod_waypoint] - 0.5
    column = layout.x_m[layout.pod_waypoint] - 0.5
    upper = sorted(column[row == 2].tolist())
    assert upper == [2.0, 3.0]
    assert (row == 1).sum() == 2


def test_robots_are_those_drawn_those_asked_for_or_four_a_pick_station(tmp_path: Path):
    picture = "P.....R\n..xxxx.\n..xxxxr\n.......\n"
    drawn = load(written(tmp_path, picture))
    assert drawn.robots == 1
    place = drawn.robot_waypoint[0]
    assert (drawn.x_m[place], drawn.y_m[place]) == (6.5, 1.5)
    more = load(tmp_path / "drawn.txt", [(["robots"], 3)])
    assert more.robots == 3 and more.robot_waypoint[0] == place
    assert len(set(more.robot_waypoint.tolist())) == 3
    nothing_said = load(written(tmp_path, picture.replace("r", ".")))
    assert nothing_said.robots == 4
    with pytest.raises(InputError, match=r"drawn.txt: robots: must be from 0, .* \(given: 99\)"):
        load(tmp_path / "drawn.txt", [(["robots"], 99)])


def test_a_picture_alone_is_a_layout_with_straight_queues(tmp_path: Path):
    """As RWARE draws it: shelves x, highway ., goals g."""
    layout = load(written(tmp_path, RWARE))
    assert check(layout) == []
    assert [len(station.queue) for station in layout.stations] == [4, 4]
    short = load(tmp_path / "drawn.txt", [(["queue_length"], 1), (["cell_m"], 1.5)])
    assert [len(station.queue) for station in short.stations] == [2, 2]
    assert np.diff(np.unique(short.x_m)).tolist() == [1.5] * 10


def test_queues_side_by_side_are_numbered(tmp_path: Path):
    picture = "P12....\nP12....\n.......\n..xxxx.\nR12....\n"
    layout = load(written(tmp_path, picture))
    assert [len(station.queue) for station in layout.stations] == [3, 3, 3]
    assert load(tmp_path / "drawn.txt", [(["pick_station_share"], 0.5)]).pick_stations
    with pytest.raises(InputError) as caught:
        load(written(tmp_path, picture.replace("12", "qq")))
    assert str(caught.value).endswith(
        "drawn.txt: line 1, column 2: the queue of the station at line 1, column 1 continues in "
        "several directions; number its places 1, 2, ... from the station"
    )


WRONG = {
    "P.R\n.xz\n": "line 2, column 3: 'z' is not a valid sign; valid: ., > < ^ v, x, X, o,",
    "name = 3\n---\nP.R\n.x.\n": "name: Input should be a valid string",
    "robts = 3\n---\nP.R\n.x.\n": "unknown key robts; did you mean robots?",
    "name = \n---\nP.R\n.x.\n": "the head is not valid TOML",
    'name = "a"\nP.R\n.x.\n': "line 1, column 1: 'n' is not a valid sign",
    "---\n\n\n": "must hold a picture of 1 to 1000000 cells",
    "P.q\n.x.\nR..\n": "line 1, column 3: 'q' belongs to no queue: no path over q, or",
    "...\n.x.\n": "the layout has no pick station, no replenishment station",
    "P.R\n...\n": "the layout has no storage location",
}


@pytest.mark.parametrize(("text", "problem"), WRONG.items())
def test_what_is_wrong_is_one_line(tmp_path: Path, text: str, problem: str):
    path = written(tmp_path, text)
    with pytest.raises(InputError) as caught:
        load(path)
    assert str(caught.value).startswith(f"{path}: {problem}")
    assert "\n" not in str(caught.value)


def test_commands_work_on_drawn_layouts(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    path = written(tmp_path, HALL)
    assert main(["layout", "check", str(path)]) == 0
    assert main(["layout", "show", str(path), "--out", str(tmp_path / "a.svg")]) == 0
    assert main(["layout", "convert", str(path), "--out", str(tmp_path / "a.json")]) == 0
    told = capsys.readouterr().out
    assert "well-formed: 135 waypoints" in told
    assert (tmp_path / "a.svg").stat().st_size > 1000
    layout, again = load(path), read_json(tmp_path / "a.json")
    assert edges(again) == edges(layout)
    assert again.robot_waypoint.tolist() == layout.robot_waypoint.tolist()
    assert again.stations == layout.stations
    assert main(["layout", "convert", str(path), "--out", str(tmp_path / "a.json")]) == 2
    assert main(["layout", "convert", str(path), "--out", str(tmp_path / "a.toml")]) == 2
    broken = written(tmp_path, "P.R\n.z.\n", "broken.txt")
    assert main(["layout", "check", str(broken)]) == 2


def test_a_run_on_a_drawn_layout_is_safe(tmp_path: Path):
    run = rmfs.simulate(
        written(tmp_path, HALL),
        "small",
        seed=1,
        set={"scenario.duration_s": 1200, "layout.pod_capacity": 100.0},
        trace=True,
    )
    assert run.check().ok
    assert run.footprint["units_picked"] > 50


MAP = """type octile
height 7
width 12
map
............
.TTTT.TTTTT.
.TTTT.TTTTT.
.TTTT.TTTTT.
............
.....@@.....
............
"""
STATIONS = """format = "rmfs-map-stations/1"
storage = "T"
robots = 3
pick_stations = [[[6, 0], [6, 1], [6, 2]]]
replenishment_stations = [[[6, 11]]]
"""


def test_a_map_with_stations(tmp_path: Path):
    path = written(tmp_path, MAP, "hall.map")
    alone = load(path)
    assert alone.pods == 0 and not alone.stations
    written(tmp_path, STATIONS, "hall.map.toml")
    layout = load(path)
    assert check(layout) == []
    # the row inside the blocks has no aisle beside it but at its ends
    assert int(layout.is_storage.sum()) == 4 + 5 + 4 + 5 + 4
    assert (layout.robots, layout.name) == (3, "hall")
    assert [len(station.queue) for station in layout.stations] == [3, 4]
    run = rmfs.simulate(
        path, "small", seed=1, trace=True, set={"scenario.duration_s": 900, "layout.robots": 2}
    )
    assert run.check().ok
    assert run.footprint["units_picked"] > 0


WRONG_STATIONS = {
    "pick_stations = [[[9, 0]]]": "pick_stations.0: [9, 0] is not a free cell of the 7 rows and 12",
    "pick_stations = [[[1, 1]]]": "pick_stations.0: [1, 1] is not a free cell",
    "pick_stations = [[[6, 0], [6, 2]]]": "pick_stations.0: [6, 2] is not adjacent to the previous",
    "pick_stations = [[[6, 0]], [[6, 0]]]": "pick_stations.1: [6, 0] is given twice",
    "pick_stations = []": "the layout has no pick station",
    "pick_stations = [[6, 0]]": "pick_stations.0.0: Input should be a valid list",
}


@pytest.mark.parametrize(("line", "problem"), WRONG_STATIONS.items())
def test_wrong_stations_of_a_map(tmp_path: Path, line: str, problem: str):
    text = STATIONS.replace("pick_stations = [[[6, 0], [6, 1], [6, 2]]]", line, 1)
    written(tmp_path, MAP, "hall.map")
    beside = written(tmp_path, text, "hall.map.toml")
    with pytest.raises(InputError) as caught:
        load(tmp_path / "hall.map")
    assert str(caught.value).startswith(f"{beside}: {problem}")
