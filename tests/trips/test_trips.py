"""Streams of trips: the same for every planner, safe, and measured as they were driven."""

import numpy as np
import pytest

from rmfs.cli import main
from rmfs.errors import InputError
from rmfs.experiments.traffic import duel
from rmfs.layout import load
from rmfs.layout.mapf import read_map
from rmfs.traffic import PlannerSettings
from rmfs.trips import PodTrips, PointTrips, drive, random_trips

FAR = {"period_s": 1, "runs_granted": 1, "reroute": 1, "patience_s": 30, "wait_s": 2}
FAR = PlannerSettings("far", {**FAR, "avoid_evading_back": 1})


def hall(robots=8):
    return load("default", [(["robots"], robots)])


def told(layout, planner, duration_s=600):
    """What each robot is told, in order."""
    stream = random_trips(layout, 3)
    programs = [[] for _ in range(layout.robots)]
    given = stream.given

    def noted(command):
        programs[command.robot].append(command.program)
        return given(command)

    stream.given = noted
    return programs, drive(layout, stream, planner, duration_s=duration_s, proven=True)


def test_planners_drive_the_same_trips():
    """One planner gets further than the other, on the same way."""
    layout = hall()
    (ours, run), (theirs, other) = (
        told(layout, planner)
        for planner in (PlannerSettings("time-windows", {"labels": 5000}), FAR)
    )
    assert run.report.ok
    assert other.report.ok
    assert ours != theirs
    for one, another in zip(ours, theirs, strict=True):
        common = min(len(one), len(another))
        assert common >= 3
        assert one[:common] == another[:common]


def test_a_robot_alone_is_never_delayed():
    """What is unhindered takes as long as the bound says, to the microseconds of its runs."""
    run = drive(hall(1), random_trips(hall(1), 1), duration_s=1800)
    assert len(run.delays_s) > 30
    assert np.abs(run.delays_s).max() < 1e-4
    assert run.idle_robots == 0


def test_trips_are_counted_after_the_warm_up():
    whole = drive(hall(), random_trips(hall(), 1), duration_s=900)
    later = drive(hall(), random_trips(hall(), 1), duration_s=600, warmup_s=300)
    first = drive(hall(), random_trips(hall(), 1), duration_s=300)
    assert len(first.delays_s) + len(later.delays_s) == len(whole.delays_s)
    assert later.trips_per_h == len(later.delays_s) * 6


@pytest.mark.parametrize(("warmup_s", "trips"), [(0.0, 2), (300.0, 0)])
def test_rates_of_a_run_that_stalls_refer_to_the_whole_measured_time(tmp_path, warmup_s, trips):
    """Two robots in a corridor reach their first goals, and can never pass each other then."""
    corridor = tmp_path / "corridor.map"
    corridor.write_text("type octile\nheight 1\nwidth 5\nmap\n.....\n", encoding="ascii")
    layout = read_map(corridor, [1, 3])
    stream = PointTrips([[0, 4], [4, 0]])
    run = drive(layout, stream, duration_s=600, warmup_s=warmup_s, stall_s=60)
    assert run.stalled and run.end_s < 100
    assert len(run.delays_s) == trips
    row = duel.row(run)
    assert run.trips_per_h == row["trips/h"] == pytest.approx(6 * trips)
    assert row["km/h"] == pytest.approx(6 * trips * 1e-3)
    assert row["sim/wall"] >= 0


def test_more_robots_than_queue_places_wait_beneath_their_pods():
    """Never more robots are bound for a station than its queue has places (W3)."""
    layout = hall(120)
    assert layout.robots > sum(len(station.queue) - 1 for station in layout.stations)
    run = drive(layout, random_trips(layout, 1), duration_s=600, proven=True)
    assert run.report.ok, run.report.summary()
    assert run.stalled == ""
    assert run.idle_robots == 0


def test_goals_one_by_one():
    """A list per robot, then the common list, then rest."""
    layout = hall(2)
    places = np.flatnonzero(layout.is_storage)[[0, 50, 100, 150]].tolist()
    stream = PointTrips([places[:1], places[1:2]], shared=places[2:])
    run = drive(layout, stream, duration_s=900)
    assert sorted(run.traffic.trips()["to_wp"].tolist()) == sorted(places)


def test_what_trips_need():
    with pytest.raises(InputError, match="a pod per robot"):
        PodTrips(load("demonstrator", [(["robots"], 7)]), 1)


def test_the_commands(tmp_path, capsys):
    path = tmp_path / "duel.csv"
    common = ["default", "--robots", "4", "--duration", "120"]
    assert main(["traffic", "bench", *common, "--check", "--planner", "far:reroute=false"]) == 0
    assert "| far:reroute=false |" in capsys.readouterr().out
    several = ["--planner", "time-windows", "--planner", "whca-n", "--out", str(path)]
    assert main(["traffic", "duel", *common, *several]) == 0
    assert [line.split(",")[0] for line in path.read_text().splitlines()] == [
        "planner",
        "time-windows",
        "whca-n",
    ]
    assert main(["traffic", "bench", *common, "--planner", "fra"]) == 2
    assert "did you mean far?" in capsys.readouterr().err
    assert main(["traffic", "bench", *common, "--out", str(tmp_path / "duel.doc")]) == 2
