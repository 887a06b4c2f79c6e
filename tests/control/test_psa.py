"""PSA rules in small situations, the answers worked out by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from doubles import Situation, small_layout, small_skus

from rmfs.control.psa.cache import Cache
from rmfs.control.psa.fixed import Fixed
from rmfs.control.psa.nearest import Nearest
from rmfs.control.psa.random import RandomPlace
from rmfs.control.psa.station_based import StationBased
from rmfs.control.psa.turnover import Turnover
from rmfs.control.psa.utility import Utility

RULES = [Nearest, RandomPlace, Fixed, StationBased, Turnover, Cache, Utility]


@pytest.fixture
def situation() -> Situation:
    """Places at x = 0 to 7, pods on 0 to 3; robot 0 with pod 1 at station 1, (10, 10)."""
    made = Situation(small_layout(places=8, pods=4, pick_stations=2))
    made.carry(robot=0, pod=1, station=1)
    made.world.end_task(made.world.robots[0])
    return made


def place(situation: Situation, rule: type, **parameters) -> int:
    return situation.make(rule, **parameters).place(situation.world.robots[0])


@pytest.mark.parametrize("rule", RULES)
def test_no_empty_place(rule) -> None:
    """Two places: pod 0 on one, a robot rests on the other."""
    situation = Situation(small_layout(places=2, pods=1))
    situation.world.start_rest(situation.world.robots[1], 1)
    situation.world.robots[0].pod = 0
    assert situation.make(rule).place(situation.world.robots[0]) == -1


class TestNearest:
    def test_by_travel_time(self, situation) -> None:
        """Empty are 1 and 4 to 7; x = 7 is nearest to x = 10."""
        assert place(situation, Nearest) == 7

    def test_places_that_robots_keep_are_left_out(self, situation) -> None:
        situation.world.start_rest(situation.world.robots[1], 7)
        assert place(situation, Nearest) == 6

    def test_of_equals_the_first(self) -> None:
        """The robot is at (1, 2): it is as near to 0 as to 2, which are empty; 1 holds the pod."""
        situation = Situation(small_layout(places=3, pods=2))
        world = situation.world
        world.storage.lift(0)
        robot = world.robots[1]
        robot.pod = 0
        for metric in ("euclidean", "manhattan", "time"):
            assert situation.make(Nearest, metric=metric).place(robot) == 0

    @pytest.mark.parametrize(
        ("metric", "expected"), [("euclidean", 1), ("manhattan", 0), ("path", 2), ("time", 3)]
    )
    def test_four_metrics(self, metric, expected) -> None:
        """The robot is at (0, 0), places at (0, 4), (3, 2), (0, 6), (0, 7).

        Euclidean: 4, 3.61, 6, 7. Manhattan: 4, 5, 6, 7. Along the waypoints there is an edge to the
        third place only. Traffic says 3 s to the fourth and 9 s to the others.
        """
        plan = small_layout(places=4, pods=1, robots=1)
        x, y = plan.x_m.copy(), plan.y_m.copy()
        x[:5], y[:5] = [0, 3, 0, 0, 0], [4, 2, 6, 7, 0]
        start = np.zeros(len(x) + 1, np.int32)
        start[5:] = 1  # the one edge leaves waypoint 4, where the robot is
        plan = replace(plan, x_m=x, y_m=y, edge_start=start, edge_target=np.array([2], np.int32))
        situation = Situation(plan)
        situation.world.storage.lift(0)
        situation.traffic.travel_times_from = lambda *_: np.array([9.0, 9.0, 9.0, 3.0, 0, 0, 0])
        robot = situation.world.robots[0]
        robot.pod = 0
        assert situation.make(Nearest, metric=metric).place(robot) == expected


def test_random_takes_any_empty_place(situation) -> None:
    controller = situation.make(RandomPlace)
    places = {controller.place(situation.world.robots[0]) for _ in range(100)}
    assert places == {1, 4, 5, 6, 7}


class TestFixed:
    def test_the_place_of_the_start(self, situation) -> None:
        """Pod 1 stood at 1, which is the farthest of all empty places."""
        assert place(situation, Fixed) == 1

    def test_the_nearest_if_something_else_is_there(self, situation) -> None:
        """Another rule stored pod 3 at 1: the nearest empty place is 7."""
        world = situation.world
        world.storage.lift(3)
        world.storage.set_down(3, 1)
        assert place(situation, Fixed) == 7


class TestStationBased:
    def test_the_place_nearest_to_any_pick_station(self, situation) -> None:
        """Stations at x = 0 and 10. Empty: 1 (11 m away along the axes), 4, 5, 6, 7 (13 m): 1."""
        assert place(situation, StationBased) == 1

    def test_or_to_a_replenishment_station(self, situation) -> None:
        """At (5, 10): place 5."""
        assert place(situation, StationBased, stations="replenishment") == 5

    def test_of_equals_the_first(self, situation) -> None:
        """1 is taken. 4 (4 m from x = 0) is as near as 6 (4 m from x = 10), and 7 nearer (3 m)."""
        world = situation.world
        world.start_rest(world.robots[1], 7)
        world.storage.lift(3)
        world.storage.set_down(3, 1)
        assert place(situation, StationBased, metric="manhattan") == 3
        world.storage.lift(2)
        world.storage.set_down(2, 3)
        assert place(situation, StationBased, metric="manhattan") == 2


class TestTurnover:
    """Eight places in classes of 2, 2 and 4 (borders 0.25, 0.5, 1), one pick station at (0, 10).

    So places 0, 1 are class 0; 2, 3 class 1; 4 to 7 class 2. Of four pods, 1, 1 and 2. The robot is
    at the station with the pod in question.
    """

    BORDERS = (0.25, 0.5, 1.0)

    def situation(self, pod: int) -> Situation:
        """Pods 0 to 3 with SKUs 0 to 3, ordered 5, 9, 1 and 3 times: ranks 1, 0, 3, 2."""
        made = Situation(small_layout(places=8, pods=4))
        for sku in range(4):
            made.stock(sku, **{f"s{sku}": 50})
        for sku, units in enumerate((5, 9, 1, 3)):
            made.order(**{f"s{sku}": units})
        made.carry(robot=0, pod=pod)
        made.world.end_task(made.world.robots[0])
        return made

    def place(self, pod: int, **parameters) -> int:
        made = self.situation(pod)
        return place(made, Turnover, class_borders=self.BORDERS, **parameters)

    def test_a_pod_of_the_fastest_class(self) -> None:
        """Pod 1 is class 0; of its places, 0 holds pod 0 and 1 is empty."""
        assert self.place(1) == 1

    def test_a_pod_of_the_slowest_class(self) -> None:
        """Pod 2 is class 2: places 4 to 7, the nearest is 4."""
        assert self.place(2) == 4

    def test_the_next_slower_class_if_there_is_no_place(self) -> None:
        """Pod 0 is class 1: place 2 holds pod 2, and 3 holds pod 3. Slower, class 2, comes before
        class 0, where place 0 would be empty: 4."""
        assert self.place(0) == 4

    def test_of_equals_the_first(self) -> None:
        """The robot is at (5, 2), and another one rests at 5: places 4 and 6 are equally near."""
        made = self.situation(2)
        robot = made.world.robots[0]
        robot.waypoint = 5
        made.world.start_rest(made.world.robots[1], 5)
        assert made.make(Turnover, class_borders=self.BORDERS).place(robot) == 4

    def test_any_place_of_the_class(self) -> None:
        made = self.situation(2)
        rule = made.make(Turnover, class_borders=self.BORDERS, within_class="random")
        found = {rule.place(made.world.robots[0]) for _ in range(80)}
        assert found == {4, 5, 6, 7}

    def test_the_place_of_the_class_nearest_to_a_station(self) -> None:
        """The robot has gone to (7, 2), where 7 is nearest to it, and 4 to the station."""
        made = self.situation(2)
        robot = made.world.robots[0]
        robot.waypoint = 7
        nearest = made.make(Turnover, class_borders=self.BORDERS)
        to_station = made.make(
            Turnover, class_borders=self.BORDERS, within_class="nearest-to-station"
        )
        assert nearest.place(robot) == 7
        assert to_station.place(robot) == 4


class TestUtility:
    """One pick station at (0, 10): prominence falls with x, ranks 0 to 7 of places 0 to 7.

    Buffer 0.5 of 8 places: 4 pods are spread over 8 places: scores' ranks 0 to 3 have the targets
    0, 2, 4, 6. Only utility counts: units that orders want.
    """

    def situation(self, units: tuple[int, ...], carried: int) -> Situation:
        """Pod p holds so many units of SKU p; an order wants them all."""
        made = Situation(small_layout(places=8, pods=4))
        for pod, count in enumerate(units):
            made.stock(pod, **{f"s{pod}": count})
        made.order(**{f"s{pod}": count for pod, count in enumerate(units)})
        made.carry(robot=0, pod=carried)
        made.world.end_task(made.world.robots[0])
        return made

    def place(self, units, carried, **parameters) -> int:
        made = self.situation(units, carried)
        return place(made, Utility, place_buffer=0.5, speed_weight=0.0, **parameters)

    def test_the_best_pod_goes_to_the_most_prominent_place(self) -> None:
        """Pod 0 is carried and best, target 0, which is empty as it stood there."""
        assert self.place((9, 5, 4, 1), 0) == 0

    def test_the_search_goes_outward_from_the_target(self) -> None:
        """Pod 0 is third: target 4, seen are 4, 3 and 5; 3 holds pod 3; 4 is nearer than 5."""
        assert self.place((3, 9, 5, 1), 0) == 4

    def test_a_narrow_corridor_ends_with_the_first_place(self) -> None:
        """Pod 0 is second: target 2; 2, 1 and 3 hold pods, then 0 (two better) is empty."""
        assert self.place((5, 9, 4, 1), 0, corridor=1) == 0

    def test_of_those_seen_the_nearest(self) -> None:
        """Pod 0 is last: target 6; seen are 6, 5 and 7, of which 5 is nearest to the station."""
        assert self.place((1, 9, 5, 3), 0) == 5
        assert self.place((1, 9, 5, 3), 0, corridor=1) == 6

    def test_equal_pods_are_ranked_by_number(self) -> None:
        """All equal: pod 0 has the target 0, and pod 3 the target 6."""
        assert self.place((2, 2, 2, 2), 0) == 0
        assert self.place((2, 2, 2, 2), 3, corridor=1) == 6

    def test_speed_counts_popularity(self) -> None:
        """No orders. SKU 1 is twice as popular: two units of it make pod 1 as fast as pod 0 with
        four of SKU 0; of equals the first comes first, so the targets are 0 and 2."""
        popularity = np.array([1.0, 2.0, 1.0, 1.0, 1.0])
        made = Situation(
            small_layout(places=8, pods=4), replace(small_skus(), popularity=popularity)
        )
        made.stock(0, s0=4)
        made.stock(1, s1=2)
        made.carry(robot=0, pod=1)
        made.world.end_task(made.world.robots[0])
        rule = made.make(Utility, place_buffer=0.5, utility_weight=0.0)
        assert rule._ranking.scores().tolist() == [1.0, 1.0, 0.0, 0.0]
        assert rule._ranking.target(1) == 2

    def test_not_both_weights_may_be_0(self) -> None:
        with pytest.raises(ValueError, match="must not both be 0"):
            Utility.parameters_model(utility_weight=0, speed_weight=0)


class TestCache:
    """Two pick stations at x = 0 and 10, eight places, half of them in caches: two each.

    Least time from place to station, and farthest from the other station: cache 0 is places 0, 1;
    cache 1 is 7, 6; 2 to 5 are outside. Pods 0 to 3 stand on places 0 to 3. A pod is worth a place
    if ((1 - fill of the cache) + share of its pods with a lower score) / 2 > threshold.
    """

    def situation(self, units: tuple[int, ...], carried: int, station: int = 0) -> Situation:
        made = Situation(small_layout(places=8, pods=4, pick_stations=2))
        for pod, count in enumerate(units):
            made.stock(pod, **{f"s{pod}": count})
        made.order(**{f"s{pod}": count for pod, count in enumerate(units) if count})
        made.carry(robot=0, pod=carried, station=station)
        made.world.end_task(made.world.robots[0])
        return made

    def test_the_zones(self) -> None:
        made = self.situation((1, 1, 1, 1), 3)
        zones = made.make(Cache, cache_share=0.5)._caching.zones
        assert zones.cache_of.tolist() == [0, 0, -1, -1, -1, -1, 1, 1]
        assert zones.occupied().tolist() == [2, 0]

    def test_a_useful_pod_goes_into_the_cache(self) -> None:
        """Pod 0 left cache 0 half full: free 0.5; the one pod there, 1, has a lower score: 1.

        (0.5 + 1) / 2 = 0.75 > 0.5: place 0.
        """
        made = self.situation((5, 1, 1, 1), 0)
        assert place(made, Cache, cache_share=0.5) == 0

    def test_a_useless_pod_stays_outside(self) -> None:
        """Pod 1 has a higher score than pod 0: (0.5 + 0) / 2 = 0.25. Nearest outside: 4."""
        made = self.situation((1, 5, 1, 1), 0)
        assert place(made, Cache, cache_share=0.5) == 4

    def test_strictly_lower_scores_count(self) -> None:
        """Equal scores: (0.5 + 0) / 2 = 0.25, not worth it; with a threshold of 0.2 it is."""
        made = self.situation((3, 3, 1, 1), 0)
        assert place(made, Cache, cache_share=0.5) == 4
        assert place(made, Cache, cache_share=0.5, threshold=0.2) == 0

    def test_an_empty_cache_takes_any_pod(self) -> None:
        """At station 1 the cache 6, 7 is empty: (1 + 1) / 2; nearest to the station is 7."""
        made = self.situation((0, 5, 5, 5), 0, station=1)
        assert place(made, Cache, cache_share=0.5) == 7

    def test_a_useful_pod_without_room_goes_outside(self) -> None:
        """Pod 3 is the best by far, but cache 0 is full: (0 + 1) / 2 = 0.5 is not above 0.5, and
        with a threshold of 0.4 it is worth it; outside, 3 is empty and nearest."""
        made = self.situation((1, 1, 1, 9), 3)
        assert place(made, Cache, cache_share=0.5, threshold=0.4) == 3

    def test_another_cache_comes_last(self) -> None:
        """Outside all places are kept by robots: pod 3 has only the places of cache 1 left, 6 is
        nearer to station 0."""
        plan = small_layout(places=8, pods=4, pick_stations=2, robots=4)
        made = Situation(plan)
        for pod in range(4):
            made.stock(pod, **{f"s{pod}": 1})
        made.carry(robot=0, pod=3)
        made.world.end_task(made.world.robots[0])
        for robot, kept in zip(made.world.robots[1:], (3, 4, 5), strict=True):
            made.world.start_rest(robot, kept)
        assert place(made, Cache, cache_share=0.5) == 6
