"""Distances in four metrics, and the shortest ways in the waypoint graph."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from doubles import FreeTraffic, small_layout

from rmfs import layout as layouts
from rmfs.control.paths import PathLengths
from rmfs.control.travel import Travel
from rmfs.layout.model import Elevator, Tier


def with_edges(edges, **changes):
    """Places at (0, 0), (1, 0), (2, 0); robots at (0, 2), (1, 2), (2, 2); stations 6 and 7.

    The pick station (6) is at (0, 10), the replenishment station (7) at (5, 10).
    """
    plan = small_layout(places=3, pods=1, robots=3)
    count = len(plan.x_m)
    start = np.zeros(count + 1, np.int32)
    for tail, _ in edges:
        start[tail + 1] += 1
    heads = np.array([head for _, head in sorted(edges)], np.int32)
    return replace(plan, edge_start=np.cumsum(start).astype(np.int32), edge_target=heads, **changes)


@pytest.fixture
def plan():
    """A ring 3 -> 4 -> 5 -> 3 of waypoints without storage; place 1 joins 0 and 2, and 4.

    Lengths: 3 to 4 and 4 to 5 are 1 m, 5 to 3 is 2 m; between places 1 m; 1 to 4 is 2 m.
    """
    ring = [(3, 4), (4, 5), (5, 3)]
    both = [(0, 1), (1, 2), (1, 4), (0, 3)]
    return with_edges([*ring, *both, *[(b, a) for a, b in both]])


class TestPathLengths:
    def test_an_empty_robot_passes_beneath_pods(self, plan) -> None:
        """From 2: to 1 (1), 0 (2), 4 (3), 3 over 0 (4), 5 over 4 (4)."""
        lengths = PathLengths(plan).away(2, loaded=False)
        assert lengths[:6].tolist() == [2.0, 1.0, 0.0, 4.0, 3.0, 4.0]
        assert lengths[6] == np.inf

    def test_a_loaded_robot_passes_no_other_place(self, plan) -> None:
        """From 2 only the neighbour 1 is reached: on from there it would have to pass 1."""
        lengths = PathLengths(plan).away(2, loaded=True)
        assert lengths[:6].tolist() == [np.inf, 1.0, 0.0, np.inf, np.inf, np.inf]

    def test_its_way_may_begin_and_end_at_one(self, plan) -> None:
        """From 1: to 0 and 2 directly (1), to 4 (2), 5 (3), 3 (5)."""
        lengths = PathLengths(plan).away(1, loaded=True)
        assert lengths[:6].tolist() == [1.0, 0.0, 1.0, 5.0, 2.0, 3.0]

    def test_edges_have_a_direction(self, plan) -> None:
        """To 4: from 3 (1), 5 over 3 (3), 1 (2), 0 over 3 (3, its way over 1 is for empty robots
        and as long); 2 only over 1: 3 empty, never loaded."""
        paths = PathLengths(plan)
        assert paths.to(4, loaded=False)[:6].tolist() == [3.0, 2.0, 3.0, 1.0, 0.0, 3.0]
        assert paths.to(4, loaded=True)[:6].tolist() == [3.0, 2.0, np.inf, 1.0, 0.0, 3.0]

    def test_a_ride_is_as_long_as_the_tiers_are_apart(self) -> None:
        """From 3 on the ground to 4 on the tier above, 4 m up."""
        tier = np.array([0, 0, 0, 0, 1, 1, 0, 0], np.int16)
        plan = with_edges(
            [(4, 5)],
            tier=tier,
            tiers=(Tier(20.0, 12.0), Tier(20.0, 12.0, 4.0)),
            elevators=(Elevator((3, 4), {(3, 4): 10.0, (4, 3): 10.0}, {}),),
        )
        assert PathLengths(plan).away(3, loaded=True)[[4, 5]].tolist() == [4.0, 5.0]

    def test_in_a_real_layout_no_way_is_shorter_than_the_straight_one(self) -> None:
        """Every place can be reached from every station and back, and both ways agree."""
        plan = layouts.load("basic")
        travel, paths = Travel(plan, FreeTraffic(plan)), PathLengths(plan)
        places = np.flatnonzero(plan.is_storage)
        for station in plan.stations:
            away = paths.away(station.waypoint, loaded=True)
            assert np.isfinite(away[places]).all()
            straight = travel.metres(station.waypoint, np.arange(plan.waypoints))
            assert (away >= straight - 1e-9).all()
            for place in places[::40].tolist():
                assert np.isclose(paths.to(place, loaded=True)[station.waypoint], away[place])


class TestMetrics:
    @pytest.fixture
    def travel(self, plan) -> Travel:
        return Travel(plan, FreeTraffic(plan))

    def test_from_a_waypoint(self, travel) -> None:
        """From 1 (1, 0) to 5 (2, 2): sqrt(1 + 4), 1 + 2, 3 along the ring, 3 s for FreeTraffic."""
        found = [
            travel.distances_from(1, metric).item(5)
            for metric in ("euclidean", "manhattan", "path", "time")
        ]
        assert found == [5**0.5, 3.0, 3.0, 3.0]

    def test_to_a_waypoint(self, travel) -> None:
        """From 5 to 4 it is 1 m, but 3 m along the ring, which has one direction."""
        found = [
            travel.distances_to(4, metric).item(5)
            for metric in ("euclidean", "manhattan", "path", "time")
        ]
        assert found == [1.0, 1.0, 3.0, 1.0]

    def test_to_some_waypoints(self, travel) -> None:
        others = np.array([4, 5])
        for metric in ("euclidean", "manhattan", "path", "time"):
            everywhere = travel.distances_from(1, metric)
            assert travel.between(1, others, metric).tolist() == everywhere[others].tolist()

    def test_they_are_worked_out_once(self, travel) -> None:
        for metric in ("euclidean", "manhattan", "path"):
            assert travel.distances_to(4, metric) is travel.distances_to(4, metric)
            assert travel.distances_from(4, metric) is travel.distances_from(4, metric)
        assert travel.distances_from(4, "path") is not travel.distances_to(4, "path")


@pytest.mark.parametrize("tiers", [1, 2])
def test_one_estimate_is_that_of_many(tiers) -> None:
    plan = small_layout(places=6, pods=1, robots=3)
    if tiers == 2:
        tier = np.zeros(len(plan.x_m), np.int16)
        tier[:3] = 1
        plan = replace(plan, tier=tier, tiers=[*plan.tiers, plan.tiers[0]])
    travel = Travel(plan, FreeTraffic(plan))
    assert travel.tiers == tiers
    everywhere = np.arange(len(plan.x_m))
    for waypoint in everywhere.tolist():
        one_by_one = [travel.one_estimate_s(waypoint, other) for other in everywhere.tolist()]
        assert one_by_one == travel.estimate_s(waypoint, everywhere).tolist()
