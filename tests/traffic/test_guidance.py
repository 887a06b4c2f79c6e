"""Guidance: extra costs of edges, in files and in plans."""

from __future__ import annotations

import hashlib
import heapq
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rmfs
from rmfs import layout as layouts
from rmfs.control.choices import choose
from rmfs.control.pp import planner_settings
from rmfs.control.problems import Problem
from rmfs.errors import InputError
from rmfs.layout import Layout
from rmfs.layout.graph import edge_sources
from rmfs.traffic import TIME_WINDOWS, EventKind, Motion, PlannerSettings, Step, Traffic
from rmfs.traffic.guidance import (
    MOST_EXTRA_S,
    graph_digest,
    guided_edges,
    read_guidance,
    write_guidance,
)

PICTURE = """\
robots = 1
---
Rqqq.......qqqP
...............
.xxxxxx.xxxxxx.
.xxxxxx.xxxxxx.
...............
.xxxxxx.xxxxxx.
.xxxxxx.xxxxxx.
...............
...............
"""


@pytest.fixture
def hall(tmp_path: Path) -> Layout:
    """Return two rows of blocks with two-way aisles, and one robot."""
    path = tmp_path / "hall.txt"
    path.write_text(PICTURE)
    return layouts.load(path)


def at(layout: Layout, x: int, y: int) -> int:
    """Return the waypoint in a column and row of the picture."""
    columns, rows = np.unique(layout.x_m), np.unique(layout.y_m)
    found = (layout.x_m == columns[x]) & (layout.y_m == rows[y])
    return int(np.flatnonzero(found)[0])


def guided(layout: Layout, extra_s: Any, **parameters: float) -> PlannerSettings:
    return TIME_WINDOWS._replace(
        parameters=TIME_WINDOWS.parameters | parameters, guidance=guided_edges(layout, extra_s)
    )


def nothing(layout: Layout) -> Any:
    return np.zeros(len(layout.edge_target))


def driven(
    layout: Layout, planner: PlannerSettings, goal: int
) -> tuple[list[tuple[int, int]], int]:
    """Return the edges on the way of the only robot to a goal, and its time in us."""
    traffic = Traffic(layout, planner=planner)
    traffic.command(0, [(Step.DRIVE, goal)])
    end = 0
    while not end:
        events = traffic.advance(10**9)
        end = next((event[0] for event in events if event[1] == EventKind.IDLE), 0)
    used = traffic.edges()
    edges = list(zip(used["from_wp"].tolist(), used["to_wp"].tolist(), strict=True))
    assert traffic.trips()["unhindered_s"][0] * 1e6 <= end
    return edges, end


@pytest.mark.parametrize("swift", [0, 1])
def test_a_dear_aisle_is_left_where_a_detour_is_cheaper(hall: Layout, swift: int) -> None:
    goal = at(hall, 14, 4)
    usual, quickest = driven(hall, guided(hall, nothing(hall), swift=swift), goal)
    detours = []
    for extra in (0.5, 100.0):
        extra_s = nothing(hall)
        tails, heads = edge_sources(hall), hall.edge_target
        on_way = [pair in set(usual) for pair in zip(tails.tolist(), heads.tolist(), strict=True)]
        middle = np.flatnonzero(on_way)[len(usual) // 2]
        extra_s[middle] = extra
        way, time = driven(hall, guided(hall, extra_s, swift=swift), goal)
        dear = (int(tails[middle]), int(heads[middle]))
        detours.append((dear in way, time - quickest))
    # half a second is less than any detour costs, a hundred seconds are more; or there is another
    # way that takes as long
    assert not detours[1][0]
    assert detours[0][1] <= 500_000
    assert 0 <= detours[1][1] < 100_000_000


def test_a_dear_edge_without_a_detour_is_driven(hall: Layout) -> None:
    goal = at(hall, 13, 0)  # a place of a queue, with one way in
    extra_s = nothing(hall)
    usual, quickest = driven(hall, guided(hall, extra_s), goal)
    extra_s[hall.edge_target == goal] = MOST_EXTRA_S
    way, time = driven(hall, guided(hall, extra_s), goal)
    assert (way, time) == (usual, quickest)


def cheapest(layout: Layout, extra_s: Any, start: int, heading: int, goal: int) -> float:
    """Return the least time plus extra cost of a way, in s, by Dijkstra over rests and headings."""
    (kind,) = layout.robot_kinds
    ahead: dict[tuple[int, int], tuple[int, float, float]] = {}
    for tail, head, extra in zip(
        edge_sources(layout).tolist(), layout.edge_target.tolist(), extra_s, strict=True
    ):
        dx = layout.x_m[head] - layout.x_m[tail]
        dy = layout.y_m[head] - layout.y_m[tail]
        quarter = round(float(np.arctan2(dy, dx)) / (np.pi / 2)) % 4
        ahead[tail, quarter] = (head, float(np.hypot(dx, dy)), float(extra))
    queues = {place for station in layout.stations for place in station.queue}

    def seconds(metres: float) -> float:
        motion = (kind.acceleration_m_s2, kind.deceleration_m_s2, kind.top_speed_m_s)
        return Motion(*motion, 0.0, metres).duration()

    open_ = [(0.0, start, heading)]
    done = set()
    while open_:
        cost, node, towards = heapq.heappop(open_)
        if node == goal:
            return cost
        if (node, towards) in done:
            continue
        done.add((node, towards))
        for turned in range(4):
            quarters = min((turned - towards) % 4, (towards - turned) % 4)
            here, metres, dear = node, 0.0, 0.0
            while (here, turned) in ahead:
                here, length, extra = ahead[here, turned]
                if here in queues and here != goal:
                    break
                metres, dear = metres + length, dear + extra
                total = cost + quarters / 4 * kind.full_turn_s + seconds(metres) + dear
                heapq.heappush(open_, (total, here, turned))
    return np.inf


def test_plans_are_as_cheap_as_those_of_dijkstra(hall: Layout) -> None:
    random = np.random.default_rng(5)
    start = int(hall.robot_waypoint[0])
    heading = round(float(hall.robot_heading_rad[0]) / (np.pi / 2)) % 4
    free = np.flatnonzero(~hall.is_queue)
    dearer = 0
    for _ in range(25):
        extra_s = random.uniform(0, 4, len(hall.edge_target)) * (
            random.uniform(size=len(hall.edge_target)) < 0.5
        )
        goal = int(random.choice(free[free != start]))
        cost_of = {(tail, head): extra for tail, head, extra in guided_edges(hall, extra_s)}
        way, time_us = driven(hall, guided(hall, extra_s), goal)
        cost = time_us / 1e6 + sum(cost_of.get(edge, 0.0) for edge in way)
        best = cheapest(hall, extra_s, start, heading, goal)
        assert cost == pytest.approx(best, abs=1e-4)
        _, quickest = driven(hall, guided(hall, nothing(hall)), goal)
        dearer += time_us > quickest + 1
    assert dearer > 5  # some ways are not the quickest


def test_files_are_read_back(hall: Layout, tmp_path: Path) -> None:
    extra_s = np.random.default_rng(2).uniform(0, 3, len(hall.edge_target))
    extra_s[::3] = 0.0
    path = tmp_path / "g.json"
    write_guidance(path, hall, extra_s, description="for a test", origin={"seeds": [1]})
    assert read_guidance(path, hall) == guided_edges(hall, extra_s)
    assert len(read_guidance(path, hall)) == np.count_nonzero(np.round(extra_s, 6))


def test_more_robots_use_the_same_guidance() -> None:
    few, many = (layouts.load("default", [(["robots"], n)]) for n in (16, 64))
    assert graph_digest(few) == graph_digest(many)
    assert graph_digest(few) != graph_digest(layouts.load("small"))


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"to": [99999]}, "no edge of the layout leads from 0 to 99999"),
        ({"extra_s": [-1.0]}, "extra_s.*greater than or equal to 0"),
        ({"extra_s": [1e6]}, "extra_s.*less than or equal to 600"),
        ({"extra_s": [float("nan")]}, "extra_s.*finite"),
        ({"extra_s": [float("inf")]}, "extra_s"),
        ({"extra_s": []}, "same number of values"),
        ({"graph": "0" * 64}, "guidance for another layout"),
        ({"waypoints": 3}, "guidance for another layout"),
        ({"costs": []}, "unknown key costs"),
        ({"format": "rmfs-guidance/9"}, "format"),
    ],
)
def test_wrong_files_are_refused(
    hall: Layout, tmp_path: Path, change: dict[str, Any], told: str
) -> None:
    extra_s = nothing(hall)
    extra_s[0] = 1.0
    path = tmp_path / "g.json"
    write_guidance(path, hall, extra_s)
    path.write_text(json.dumps(json.loads(path.read_text()) | change))
    with pytest.raises(InputError, match=told) as error:
        read_guidance(path, hall)
    assert str(error.value).startswith(str(path))
    assert "\n" not in str(error.value)


def test_damaged_and_missing_files_are_refused(hall: Layout, tmp_path: Path) -> None:
    path = tmp_path / "g.json"
    with pytest.raises(InputError, match=f"^{path}: no such file$"):
        read_guidance(path, hall)
    for text in ('{"format": "rmfs-gui', "[]", "\xff"):
        path.write_text(text, encoding="latin-1")
        with pytest.raises(InputError, match=r"g\.json: (not valid JSON|expected an object)"):
            read_guidance(path, hall)
    write_guidance(path, hall, nothing(hall) + 1.0)
    table = json.loads(path.read_text())
    for key in ("from", "to", "extra_s"):
        table[key].append(table[key][0])
    path.write_text(json.dumps(table))
    with pytest.raises(InputError, match="occurs twice"):
        read_guidance(path, hall)


def test_costs_out_of_range_are_not_written(hall: Layout, tmp_path: Path) -> None:
    for extra in (-1.0, np.nan, MOST_EXTRA_S + 1):
        with pytest.raises(InputError, match="between 0 and 600"):
            write_guidance(tmp_path / "g.json", hall, nothing(hall) + extra)
    with pytest.raises(InputError, match=r"must end in \.json"):
        write_guidance(tmp_path / "g.txt", hall, nothing(hall))
    with pytest.raises(InputError, match="cost for each"):
        write_guidance(tmp_path / "g.json", hall, np.zeros(3))
    assert not list(tmp_path.glob("g.*"))


def test_only_trip_planners_use_guidance(hall: Layout) -> None:
    far = planner_settings(choose(Problem.PP, {"name": "far"}, "test"), 1)
    with pytest.raises(ValueError, match="only trip planners"):
        Traffic(hall, planner=far._replace(guidance=((0, 1, 1.0),)))
    with pytest.raises(InputError, match=r"unknown key pp\.guidance"):
        choose(Problem.PP, {"name": "far", "guidance": "g.json"}, "test")


# --- whole runs

KEYS = {"scenario.duration_s": 600.0, "layout.robots": 8}


def run(path: Path | None = None, **more: Any) -> Any:
    given = {} if path is None else {"controllers.pp.guidance": str(path)}
    return rmfs.simulate("small", "small", seed=4, set=KEYS | given | more, trace=True)


@pytest.fixture
def lanes(tmp_path: Path) -> Path:
    """Return guidance that makes driving under pods, and in one direction, dear."""
    layout = layouts.load("small")
    tails, heads = edge_sources(layout), layout.edge_target
    extra_s = 1.0 * layout.is_storage[heads] + 0.7 * (layout.x_m[heads] < layout.x_m[tails])
    path = tmp_path / "lanes.json"
    write_guidance(path, layout, extra_s)
    return path


def same(one: Any, other: Any) -> bool:
    pairs = ((value, other.trace[name]) for name, value in one.trace.items())
    return all(np.array_equal(value, compared) for value, compared in pairs)


def test_guidance_of_zeros_changes_no_bit(tmp_path: Path) -> None:
    layout = layouts.load("small")
    path = tmp_path / "zeros.json"
    write_guidance(path, layout, nothing(layout))
    assert same(run(), run(path))


def test_guided_runs_are_safe_and_different(lanes: Path) -> None:
    guided_run = run(lanes)
    assert guided_run.check().ok
    assert not same(run(), guided_run)
    assert same(guided_run, run(lanes))
    assert guided_run.footprint["units_picked"] > 20


def test_copies_and_checkpoints_keep_guidance(lanes: Path, tmp_path: Path) -> None:
    keys = KEYS | {"controllers.pp.guidance": str(lanes)}
    simulation = rmfs.Simulation("small", "small", "default", seed=4, set=keys, trace=True)
    simulation.run_until(200)
    copy = simulation.fork()
    simulation.save(tmp_path / "checkpoint")
    lanes.unlink()  # the costs are part of the state
    saved = rmfs.Simulation.load(tmp_path / "checkpoint")
    ends = []
    for one in (simulation, copy, saved):
        one.run_until(600)
        ends.append([one.traffic.rest_waypoint(robot) for robot in range(8)])
        ends.append(one.traffic.motion()["distance_m"].tolist())
    assert ends[0] == ends[2] == ends[4]
    assert ends[1] == ends[3] == ends[5]


def test_controllers_files_name_guidance_beside_them(lanes: Path, tmp_path: Path) -> None:
    file = tmp_path / "rules.toml"
    file.write_text(
        'format = "rmfs-controllers/1"\nname = "guided"\n[pp]\nname = "time-windows"\n'
        f'guidance = "{lanes.name}"\n'
    )
    named = rmfs.simulate("small", "small", str(file), seed=4, set=KEYS, trace=True)
    assert same(named, run(lanes))


def test_runs_record_the_file(lanes: Path, tmp_path: Path) -> None:
    keys = KEYS | {"controllers.pp.guidance": str(lanes), "scenario.duration_s": 60.0}
    rmfs.simulate("small", "small", set=keys).save(tmp_path / "run")
    written = json.loads((tmp_path / "run" / "run.json").read_text())
    assert written["controllers"]["files"] == {
        "pp.guidance": hashlib.sha256(lanes.read_bytes()).hexdigest()
    }


def test_guidance_of_another_layout_is_refused(lanes: Path) -> None:
    with pytest.raises(InputError, match=r"lanes\.json: is guidance for another layout \(small"):
        rmfs.simulate("default", "small", set={"controllers.pp.guidance": str(lanes)})
