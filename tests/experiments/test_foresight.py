"""What perfect foresight could save: the problems are those of the run, and bound what it drove."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pandas as pd
import pytest

import rmfs
from rmfs.experiments.foresight import Foresight, lifts_of, stays_of
from rmfs.experiments.papers import foresight
from rmfs.experiments.papers.study import command
from rmfs.solvers.models.storage.stays import objective, solve, violations

SHORT = {"scenario.warmup_s": 300, "scenario.duration_s": 900, "layout.robots": 8}


@pytest.fixture(scope="module")
def run():
    return rmfs.simulate("default", "poisson", "default", set=SHORT, seed=3, measures=[Foresight])


def test_the_places_of_the_run_solve_its_own_problem(run):
    trips = run.table("trips")
    data, spent_s = stays_of(run, trips, run.traffic)
    stored = trips[trips["kind"] == "to_storage"].sort_values("start_s")
    fixed = len(data.begin_s) - len(stored)
    # pods that stood there from the start may only stay; the others went where the trips led
    first = [int(np.flatnonzero(np.isfinite(row))[0]) for row in data.cost_s[:fixed]]
    moved = sorted(
        {*trips.loc[trips["loaded"], "from_waypoint"], *stored["to_waypoint"]}
        | {p for p in np.flatnonzero(run.layout.is_storage) if run.world.storage.pod_at[p] < 0}
    )
    moved = [place for place in moved if run.layout.is_storage[place]]
    zone = np.array([*first, *(moved.index(place) for place in stored["to_waypoint"])])
    assert violations(data, zone) == []
    assert objective(data, zone) == pytest.approx(spent_s)
    best = solve(data, "highs")
    assert best.bound == pytest.approx(objective(data, best.values), rel=1e-5)
    assert violations(data, best.values) == []
    assert 0.5 * spent_s < best.bound < spent_s


def test_columns_of_the_footprint(run):
    row = run.footprint
    assert 0 < row["foresight_storage_share"] < 0.1
    assert 0 < row["foresight_tasks_share"] < 0.1
    robot_s = 8 * 900
    assert row["foresight_storage_s"] == pytest.approx(row["foresight_storage_share"] * robot_s)
    trips = run.table("trips")
    assert row["lifts"] == (trips["kind"] == "to_pod").sum()


class Line:
    """Waypoints one second apart in a row."""

    def travel_times_to(self, waypoint, loaded, robot=-1):
        return np.abs(np.arange(20.0) - waypoint)

    def travel_times_from(self, waypoint, loaded, robot=-1):
        return self.travel_times_to(waypoint, loaded)

    def robot_waypoint(self, robot):
        raise NotImplementedError


def test_robots_are_chosen_so_that_no_pod_is_lifted_later():
    trips = pd.DataFrame(
        {
            "kind": "to_pod",
            "from_waypoint": [0, 10, 5, 12],
            "to_waypoint": [9, 1, 11, 6],
            "start_s": [0.0, 1.0, 4.0, 20.0],
            "end_s": [9.0, 10.0, 10.0, 26.0],
        }
    )
    own_s, least_s, lifts = lifts_of(trips, Line())
    assert (own_s, lifts) == (9 + 9 + 6 + 6, 4)
    ways = np.abs(trips["to_waypoint"].to_numpy()[:, None] - trips["from_waypoint"].to_numpy())
    in_time = trips["start_s"].to_numpy() + ways <= trips["end_s"].to_numpy()[:, None]
    least = min(
        sum(ways[row, col] for row, col in enumerate(order))
        for order in permutations(range(4))
        if all(in_time[row, col] for row, col in enumerate(order))
    )
    assert least_s == least < own_s


def test_the_study_is_published(design, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = design(
        seeds=[1, 2],
        base={"layout": "default", "layout.robots": 6, "scenario.duration_s": 300},
        factors={"demand": [{"label": "backlog", "scenario": "default"}]},
        measures=["rmfs.experiments.foresight:Foresight"],
    )
    given = ["--design", str(path), "--out", "runs", "--published", "out", "--jobs", "1"]
    assert command(foresight.main, given) == 0
    rows = pd.read_csv("out/foresight.csv", index_col=0)
    assert list(rows.index) == ["backlog"]
    assert rows["foresight_storage_share mean"].between(0, 0.2).all()
