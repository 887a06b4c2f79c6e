"""Repositioning rules in small situations, the answers worked out by hand."""

from __future__ import annotations

from dataclasses import replace
from math import inf
from typing import ClassVar

import pytest
from doubles import Situation, small_layout

from rmfs.control.repositioning import Move
from rmfs.control.repositioning.cache import Cache
from rmfs.control.repositioning.cache_drop_off import CacheDropOff
from rmfs.control.repositioning.none import NoMoves
from rmfs.control.repositioning.utility import Utility


def find(situation: Situation, rule: type, **parameters) -> Move | None:
    return situation.make(rule, **parameters).find(situation.world.robots[0])


def move(situation: Situation, pod: int, place: int) -> None:
    """Store a pod elsewhere."""
    situation.world.storage.lift(pod)
    situation.world.storage.set_down(pod, place)


def test_none() -> None:
    situation = Situation()
    rule, robot = situation.make(NoMoves), situation.world.robots[0]
    assert rule.move(robot) is None
    assert not rule.is_ready(robot)


class TestCache:
    """One pick station at (0, 10), replenishment at (5, 10). Ten places, 0.4 of them, 0 to 3, in
    the cache; pods 0 to 5 of 100 space units at x = 0 to 5; two places of the cache are to be free.
    """

    PARAMETERS: ClassVar = {"cache_share": 0.4, "free_places": 2}

    def situation(self, places: dict[int, int] | None = None) -> Situation:
        """Pods are stored where `places` says instead."""
        made = Situation(small_layout(places=10, pods=6))
        for pod, place in (places or {}).items():
            move(made, pod, place)
        return made

    def test_the_pod_with_most_picks_is_moved_in(self) -> None:
        """Pods 0 to 3 have gone to 6 to 9: 4 places are free, 2 would do. The station wants 3 of
        SKU 0: pod 4 has 1, pod 5 has 2. Pod 5, at x = 5, to the nearest place of the cache: 3."""
        made = self.situation({0: 6, 1: 7, 2: 8, 3: 9})
        made.stock(4, s0=1)
        made.stock(5, s0=2)
        made.assigned(s0=3)
        assert find(made, Cache, **self.PARAMETERS) == Move(5, 3)

    def test_of_equal_picks_the_most_wanted(self) -> None:
        """Nobody picks; waiting orders want SKU 1, of which pod 4 has most. Without the backlog all
        are equal again, and the fullest counts: pod 5."""
        made = self.situation({0: 6, 1: 7, 2: 8, 3: 9})
        made.stock(4, s1=2)
        made.stock(5, s1=1, s2=9)
        made.order(s1=9)
        assert find(made, Cache, **self.PARAMETERS) == Move(4, 3)
        assert find(made, Cache, **self.PARAMETERS, count_backlog=False) == Move(5, 3)

    def test_of_equal_pods_the_shortest_move(self) -> None:
        """All pods are empty; the nearest to a free place of the cache, 3, is pod 4 at x = 4."""
        made = self.situation({0: 6, 1: 7, 2: 8, 3: 9})
        assert find(made, Cache, **self.PARAMETERS) == Move(4, 3)

    def test_the_least_useful_pod_is_moved_out(self) -> None:
        """The cache is full. The station wants SKU 0, which pods 1 to 3 have; pod 0 has none. It is
        half full (0.5), and goes to the nearest empty place outside: 6."""
        made = self.situation()
        made.stock(0, s1=50)
        for pod in (1, 2, 3):
            made.stock(pod, s0=1)
        made.assigned(s0=9)
        assert find(made, Cache, **self.PARAMETERS) == Move(0, 6)

    def test_an_almost_empty_pod_goes_near_the_replenishment_station(self) -> None:
        """Pods 4 and 5 have gone to 8 and 9. Pod 0, with 0.3 of its capacity in use, goes to place
        5 below (5, 10); with 0.5 it would go to the nearest place outside the cache, 4."""
        made = self.situation({5: 9, 4: 8})
        made.stock(0, s1=30)
        for pod in (1, 2, 3):
            made.stock(pod, s0=1)
        made.assigned(s0=9)
        assert find(made, Cache, **self.PARAMETERS) == Move(0, 5)
        made.stock(0, s1=20)
        assert find(made, Cache, **self.PARAMETERS) == Move(0, 4)

    def test_least_demand_then_emptiest_then_nearest_to_a_pick_station(self) -> None:
        """No picks. Wanted: one of SKU 1, on pods 0 and 1. Of 2 and 3, 2 is emptier. If 3 is as
        empty, 2 is nearer to the pick station."""
        made = self.situation()
        for pod, units in ((0, {"s1": 1}), (1, {"s1": 1}), (2, {"s2": 50}), (3, {"s2": 60})):
            made.stock(pod, **units)
        made.order(s1=1)
        assert find(made, Cache, **self.PARAMETERS).pod == 2
        made.stock(2, s2=10)
        assert find(made, Cache, **self.PARAMETERS).pod == 2

    def test_nothing_when_as_many_are_free_as_wished(self) -> None:
        """Two pods have left the cache."""
        assert find(self.situation({0: 6, 1: 7}), Cache, **self.PARAMETERS) is None

    def test_claimed_pods_stay(self) -> None:
        """Only pod 4 could be moved in, and a robot comes for it."""
        made = self.situation({0: 6, 1: 7, 2: 8, 3: 9})
        for pod in (0, 1, 2, 3, 5):
            made.world.storage.claim(pod, 1)
        assert find(made, Cache, **self.PARAMETERS) == Move(4, 3)
        made.world.storage.claim(4, 1)
        assert find(made, Cache, **self.PARAMETERS) is None

    def test_moves_in_come_before_moves_out(self) -> None:
        """Two pick stations: cache 0 is places 0 to 2, full; cache 1 is 9 to 7, empty. One place of
        each is to be free: a pod goes into cache 1, the nearest from x = 5 is 7."""
        made = Situation(small_layout(places=10, pods=6, pick_stations=2))
        assert find(made, Cache, cache_share=0.6, free_places=1) == Move(5, 7)


class TestUtility:
    """One pick station at (0, 10): places 0 to 7 have the ranks 0 to 7. Four pods are spread over
    eight places (buffer 0.5): targets 0, 2, 4, 6 from the best pod on; only utility counts."""

    PARAMETERS: ClassVar = {"place_buffer": 0.5, "speed_weight": 0.0}

    def situation(self, units: tuple[int, ...]) -> Situation:
        made = Situation(small_layout(places=8, pods=4))
        for pod, count in enumerate(units):
            made.stock(pod, **{f"s{pod}": count})
        made.order(**{f"s{pod}": count for pod, count in enumerate(units)})
        return made

    def test_the_pod_that_stands_worst(self) -> None:
        """Pods 0 to 3 rank 3, 0, 1, 2: targets 6, 0, 2, 4. They stand at 0, 1, 2, 3: pod 0 is 6
        away. Seen from 6 are 6, 5 and 7; 5 is nearest to the pod."""
        assert find(self.situation((1, 9, 5, 3)), Utility, **self.PARAMETERS) == Move(0, 5)

    def test_only_to_a_better_place(self) -> None:
        """Pods 0 to 3 rank 1, 0, 2, 3: targets 2, 0, 4, 6, they stand 2, 1, 2, 3 away. Pod 3 is
        first: 5 is nearest of 6, 5 and 7. If it is claimed, pod 0: 2, 1 and 3 hold pods, the search
        ends at 4, which is as far from 2 as 0 is. So pod 2: from 4 are seen 4 and 5."""
        made = self.situation((5, 9, 4, 1))
        assert find(made, Utility, **self.PARAMETERS) == Move(3, 5)
        made.world.storage.claim(3, 1)
        assert find(made, Utility, **self.PARAMETERS) == Move(2, 4)

    def test_an_end_when_all_stand_well(self) -> None:
        """Pods at their targets."""
        made = self.situation((9, 5, 4, 1))
        for pod, place in ((3, 6), (2, 4), (1, 2)):
            if place != pod:
                move(made, pod, place)
        assert find(made, Utility, **self.PARAMETERS) is None

    def test_repeated_moves_come_to_an_end(self) -> None:
        """Each move brings a pod nearer to its target, so 24 (4 pods, 6 ranks) are enough."""
        made = self.situation((1, 5, 3, 9))
        rule = made.make(Utility, **self.PARAMETERS)
        for _ in range(24):
            found = rule.find(made.world.robots[0])
            if found is None:
                break
            move(made, found.pod, found.place)
        assert rule.find(made.world.robots[0]) is None


class TestCacheDropOff:
    """One pick station at (0, 10). Ten places: the drop-off zone takes the nearest two, 0 and 1,
    the cache (0.4) the next four, 2 to 5. Pods 0 to 5 at x = 0 to 5. Target fill 0.5: two pods."""

    PARAMETERS: ClassVar = {"cache_share": 0.4, "drop_off_places": 2, "target_fill": 0.5}

    def situation(self, units: tuple[int, ...], places: dict[int, int]) -> Situation:
        made = Situation(small_layout(places=10, pods=6))
        for pod, place in places.items():
            move(made, pod, place)
        for pod, count in enumerate(units):
            if count:
                made.stock(pod, s0=count)
        if any(units):
            made.order(s0=99)
        return made

    def test_the_zones(self) -> None:
        zones = Situation(small_layout(places=10)).make(CacheDropOff, **self.PARAMETERS)._zones
        assert zones.drop_off_of.tolist() == [0, 0] + [-1] * 8
        assert zones.cache_of.tolist() == [-1, -1, 0, 0, 0, 0, -1, -1, -1, -1]

    def test_a_useful_pod_goes_from_drop_off_into_the_cache(self) -> None:
        """Pods 0 and 1 are in the drop-off zone, 2 and 3 in the cache, 4 and 5 outside (8, 9).

        Pod 1 has the higher score: free (0.5) and better than both (1): 0.75 > 0.5. Nearest: 4."""
        made = self.situation((2, 9, 1, 1, 1, 1), {4: 8, 5: 9})
        assert find(made, CacheDropOff, **self.PARAMETERS) == Move(1, 4)

    def test_a_useless_one_goes_outside(self) -> None:
        """Nothing is wanted: (0.5 + 0) / 2. Pod 0 first; the nearest outside is 6."""
        made = self.situation((0,) * 6, {4: 8, 5: 9})
        assert find(made, CacheDropOff, **self.PARAMETERS) == Move(0, 6)

    def test_then_caches_are_filled_up(self) -> None:
        """Pods 0, 1 are at 8, 9 and 4, 5 at 6, 7; pods 2 and 3 are in the cache, at 5 and 3: as
        many as wished. With a target of 0.75 one more: pod 5 has the highest score, and is worth
        it: half is free, and it is better than both. From 7 the nearest empty place is 4."""
        made = self.situation((1, 1, 1, 1, 3, 9), {4: 6, 5: 7, 0: 8, 1: 9, 2: 5})
        assert find(made, CacheDropOff, **self.PARAMETERS) is None
        given = self.PARAMETERS | {"target_fill": 0.75}
        assert find(made, CacheDropOff, **given) == Move(5, 4)

    def test_but_only_with_pods_that_are_worth_it(self) -> None:
        """All are equal: (0.5 + 0) / 2 is not above 0.5 (RAWSim-O would move one, for ever)."""
        made = self.situation((1,) * 6, {4: 6, 5: 7, 0: 8, 1: 9, 2: 5})
        assert find(made, CacheDropOff, **self.PARAMETERS | {"target_fill": 0.75}) is None

    def test_or_thinned_out(self) -> None:
        """Pods 2 to 5 fill the cache, two would do. Pod 4 has the lowest score; 6 is nearest."""
        made = self.situation((1, 1, 5, 6, 2, 7), {0: 8, 1: 9})
        assert find(made, CacheDropOff, **self.PARAMETERS) == Move(4, 6)


class TestPauses:
    """Cache of `TestCache`: two moves are to be found, one for each robot."""

    @pytest.fixture
    def made(self) -> Situation:
        made = Situation(small_layout(places=10, pods=6))
        for pod, place in {0: 6, 1: 7, 2: 8, 3: 9}.items():
            move(made, pod, place)
        return made

    def test_a_robot_pauses_after_a_move(self, made) -> None:
        rule = made.make(Cache, cache_share=0.4, free_places=2, robot_pause_s=15.0)
        first, second = made.world.robots
        assert rule.is_ready(first)
        assert rule.move(first) is not None
        assert not rule.is_ready(first)
        assert rule.is_ready(second)
        assert rule.next_event_s() == 15.0
        made.world.now_s = 15.0
        assert rule.is_ready(first)
        assert rule.next_event_s() == inf

    def test_all_pause_after_a_search_without_result(self, made) -> None:
        """RAWSim-O keeps this time, but does not look at it."""
        rule = made.make(Cache, cache_share=0.4, free_places=4, search_pause_s=20.0)
        made.world.now_s = 100.0
        assert rule.move(made.world.robots[0]) is None
        assert not rule.is_ready(made.world.robots[1])
        assert rule.next_event_s() == 120.0
        made.world.now_s = 120.0
        assert rule.is_ready(made.world.robots[1])


def test_own_tier_first() -> None:
    """Places 2 and 3 and the pods there are above. The only place of the cache, 0, is free, and all
    pods are equal: a robot on the ground moves pod 1 there (1 m), one above pod 2 or 3."""
    plan = small_layout(places=8, pods=4)
    tier = plan.tier.copy()
    tier[2:4] = 1
    plan = replace(plan, tier=tier, tiers=(*plan.tiers, *plan.tiers))
    made = Situation(plan)
    robot = made.world.robots[0]
    given = {"cache_share": 0.125, "free_places": 0}
    move(made, 0, 7)
    rule = made.make(Cache, **given)
    assert rule.find(robot) == Move(1, 0)
    robot.tier = 1
    assert rule.find(robot) == Move(2, 0)
