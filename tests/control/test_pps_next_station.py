"""PPS: the next station of a robot that carries a pod, worked out by hand."""

from __future__ import annotations

import pytest
from doubles import Situation, small_layout

from rmfs.control.pps.lexicographic import Lexicographic
from rmfs.control.pps.station_criteria import MostWork, NearestNextStation


class TestNextStation:
    """Stations at x = 0, 10, 20; robot 0 stands with pod 0 at the first."""

    @pytest.fixture
    def three(self) -> Situation:
        situation = Situation(small_layout(pick_stations=3))
        situation.stock(0, s0=9)
        situation.assigned(station=0, s1=1)
        situation.stock(0, s1=1)
        situation.carry(robot=0, pod=0)
        return situation

    def choose(self, situation, *criteria) -> int:
        rule = situation.make(Lexicographic, next_station=criteria)
        return rule.next_station(situation.world.robots[0], [1, 2])

    def test_age(self, three) -> None:
        """At 50 s: station 1 wants one unit since 40 s: 10; station 2 two since 0 s: 25 each."""
        three.assigned(2, s0=2)
        three.world.now_s = 40.0
        three.assigned(1, s0=1)
        three.world.now_s = 50.0
        assert self.choose(three, "age") == 2
        scores = MostWork(metric="age").score(three.view, three.world.robots[0], [1, 2], three.rng)
        assert scores.tolist() == [10.0, 50.0]

    def test_age_of_each_part_of_an_order(self, three) -> None:
        """At 50 s: station 1 wants two units since 10 s; station 2, the rest, two since 40 s."""
        order = three.order(s0=2, s1=2)
        three.stock(0, s1=2)
        three.world.now_s = 10.0
        three.world.assign_lines(order, 1, [0])
        three.world.now_s = 40.0
        three.world.assign_lines(order, 2, [1])
        three.world.now_s = 50.0
        scores = MostWork(metric="age").score(three.view, three.world.robots[0], [1, 2], three.rng)
        assert scores.tolist() == [40.0, 10.0]

    def test_lateness_takes_the_latest_requests_first(self, three) -> None:
        """Nine units for 6 requests due at 0 (per request 60 / 6) and 6 due at 90 (-30 / 6), at 60
        s: 6 x 10 - 3 x 5 = 45."""
        three.assigned(1, due_s=90.0, s0=6)
        three.assigned(1, due_s=0.0, s0=6)
        three.world.now_s = 60.0
        robot = three.world.robots[0]
        scores = MostWork(metric="lateness").score(three.view, robot, [1], three.rng)
        assert scores.tolist() == [45.0]
        criterion = MostWork(metric="lateness", only_positive_lateness=True)
        assert criterion.score(three.view, robot, [1], three.rng).tolist() == [60.0]

    def test_nearest(self, three) -> None:
        scores = NearestNextStation().score(three.view, three.world.robots[0], [1, 2], three.rng)
        assert scores.tolist() == [-10.0, -20.0]
        assert self.choose(three, "nearest") == 1

    def test_random(self, three) -> None:
        rule = three.make(Lexicographic, next_station=("random",))
        robot = three.world.robots[0]
        assert {rule.next_station(robot, [1, 2]) for _ in range(40)} == {1, 2}

    def test_bundles(self, three) -> None:
        """Two bundles wait at station 3 (replenishment) for 20 s each; one pick at station 1."""
        three.world.robots[0].task.picks.clear()
        for _ in range(2):
            three.waiting_bundle(0, 3)
        three.assigned(1, s0=1)
        three.world.now_s = 20.0
        robot = three.world.robots[0]
        assert MostWork().score(three.view, robot, [1, 3], three.rng).tolist() == [1.0, 2.0]
        aged = MostWork(bundle_age=True).score(three.view, robot, [1, 3], three.rng)
        assert aged.tolist() == [1.0, 40.0]
