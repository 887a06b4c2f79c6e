"""Zones, prominence of places, and scores of pods, kept up to date."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from doubles import Situation, small_layout, small_skus

from rmfs.control.problems import Trigger
from rmfs.control.trackers.pod_scores import DemandOnPods, PodScores, demand
from rmfs.control.trackers.prominence import Prominence
from rmfs.control.trackers.zones import ZoneParameters, Zones


class TestProminence:
    def test_time_to_the_nearest_pick_station(self) -> None:
        """Stations at x = 0 and 10, places at 0 to 7: 10 + (0, 1, 2, 3, 4, 5, 4, 3) s."""
        tracker = Situation(small_layout(places=8, pick_stations=2)).view.trackers.get(Prominence)
        assert tracker.seconds.tolist() == [10, 11, 12, 13, 14, 15, 14, 13]
        assert tracker.rank.tolist() == [0, 1, 2, 3, 4, 5, 4, 3]
        assert tracker.in_order.tolist() == [0, 1, 2, 3, 7, 4, 6, 5]


class TestZones:
    """Two pick stations at x = 0 and 10, places at x = 0 to 7."""

    def zones(self, **parameters) -> Zones:
        view = Situation(small_layout(places=8, pick_stations=2)).view
        return view.trackers.get(Zones, ZoneParameters(**parameters))

    def test_caches_share_a_part_of_the_places_equally(self) -> None:
        """ceil(8 x 0.25 / 2) = 1 place each: 0, and 7 (3 m from x = 10)."""
        zones = self.zones()
        assert zones.cache_of.tolist() == [0, -1, -1, -1, -1, -1, -1, 1]
        assert zones.cache_size.tolist() == [1, 1]

    def test_rounded_up(self) -> None:
        """ceil(8 x 0.3 / 2) = 2."""
        assert self.zones(cache_share=0.3).cache_of.tolist() == [0, 0, -1, -1, -1, -1, 1, 1]

    def test_drop_off_zones_first(self) -> None:
        zones = self.zones(cache_share=0.5, drop_off_places=1)
        assert zones.drop_off_of.tolist() == [0, -1, -1, -1, -1, -1, -1, 1]
        assert zones.cache_of.tolist() == [-1, 0, 0, -1, -1, 1, 1, -1]

    def test_or_last(self) -> None:
        zones = self.zones(cache_share=0.5, drop_off_places=1, zone_priority="cache")
        assert zones.cache_of.tolist() == [0, 0, -1, -1, -1, -1, 1, 1]
        assert zones.drop_off_of.tolist() == [-1, -1, 0, -1, -1, 1, -1, -1]

    def test_or_together(self) -> None:
        """In turn of time: 0 drop-off, 1 cache of 0 (its drop-off is full), 2 its cache; 7
        drop-off, 6 and 5 the cache of 1. Of equal times the place decides, then drop-off before
        cache."""
        zones = self.zones(cache_share=0.5, drop_off_places=1, zone_priority="equal")
        assert zones.drop_off_of.tolist() == [0, -1, -1, -1, -1, -1, -1, 1]
        assert zones.cache_of.tolist() == [-1, 0, 0, -1, -1, 1, 1, -1]

    def test_more_than_there_is(self) -> None:
        """All places are in caches; the middle goes to the nearer station, 5 is between: 5 + 10 s
        for both, of equals the place, then the station with the lowest number."""
        zones = self.zones(cache_share=1.0)
        assert zones.cache_of.tolist() == [0, 0, 0, 0, 1, 1, 1, 1]

    def test_of_equal_times_the_farther_from_the_other_direction(self) -> None:
        """Places 0 and 1 are 5 s from the station each; back it takes 9 s to 0 and 7 s to 1."""
        situation = Situation(small_layout(places=2, pods=1))
        situation.traffic.travel_times_to = lambda *_: np.array([5.0] * 6)
        situation.traffic.travel_times_from = lambda *_: np.array([7.0, 9.0] + [0.0] * 4)
        zones = situation.view.trackers.get(Zones, ZoneParameters(cache_share=0.5))
        assert zones.cache_of.tolist() == [-1, 0]

    def test_occupied(self) -> None:
        """Pods on 0 to 3; one is carried away, and a robot rests on 7."""
        situation = Situation(small_layout(places=8, pods=4, pick_stations=2))
        zones = situation.view.trackers.get(Zones, ZoneParameters(cache_share=0.5))
        assert zones.occupied().tolist() == [2, 0]
        situation.carry(robot=0, pod=1)
        situation.world.start_rest(situation.world.robots[1], 7)
        assert zones.occupied().tolist() == [1, 1]


class Told(Situation):
    """Tells the trackers of what happens, as the simulation does."""

    def tell(self, trigger: Trigger, subject) -> None:
        for tracker in self.view.trackers:
            if trigger in tracker.hears:
                tracker.hear(trigger, subject)


class TestPodScores:
    def test_three_kinds_of_demand(self) -> None:
        """SKU 0: 2 in the backlog; 4 at the station, of which 1 is bound to pod 1."""
        situation = Situation()
        situation.stock(1, s0=1)
        situation.assigned(s0=4)
        situation.order(s0=2)
        situation.world.start_pick(situation.world.robots[0], 1, 0)
        kinds = ("assigned", "unbound", "wanted")
        assert [int(demand(situation.view, kind)[0]) for kind in kinds] == [3, 5, 6]

    def test_units_wanted_on_each_pod(self) -> None:
        """Wanted are 3 of SKU 0 and 1 of SKU 1. Pod 0: min(5, 3); pod 1: min(1, 3) + min(2, 1)."""
        situation = Situation()
        situation.stock(0, s0=5)
        situation.stock(1, s0=1, s1=2)
        situation.order(s0=3, s1=1)
        tracker = situation.view.trackers.get(DemandOnPods, "wanted")
        assert tracker.units().tolist() == [3, 2, 0, 0]

    def test_scores_are_shares_of_the_best(self) -> None:
        """Utility 3 and 1. Popularity 1 and 0.5 (SKUs 0, 1): speed 4 and 2. Weights 1 and 3:
        pod 1: (1/3 + 3 x 2/4) / 4."""
        popularity = np.array([2.0, 1.0, 1.0, 1.0, 1.0])
        situation = Situation(skus=replace(small_skus(), popularity=popularity))
        situation.stock(0, s0=4)
        situation.stock(1, s1=4)
        situation.order(s0=3, s1=1)
        tracker = situation.view.trackers.get(PodScores)
        assert tracker.scores(1.0, 3.0).tolist() == pytest.approx([1.0, (1 / 3 + 1.5) / 4, 0, 0])

    def test_without_any_demand_all_are_0(self) -> None:
        assert Situation().view.trackers.get(PodScores).scores(1.0, 1.0).tolist() == [0.0] * 4

    def test_kept_up_to_date(self) -> None:
        """Random picks, stores and orders; the sums are those of a fresh count each time."""
        situation = Told(small_layout(places=12, pods=8, robots=8, slots=50, pod_capacity=500.0))
        world, rng = situation.world, situation.rng
        for pod in range(8):
            situation.stock(pod, **{f"s{sku}": int(rng.integers(1, 9)) for sku in range(5)})
        kinds = ("assigned", "unbound", "wanted")
        trackers = [situation.view.trackers.get(DemandOnPods, kind) for kind in kinds]
        scores = situation.view.trackers.get(PodScores)
        for step in range(120):
            match int(rng.integers(4)):
                case 0:
                    situation.order(**{f"s{int(rng.integers(5))}": int(rng.integers(1, 4))})
                case 1 if len(world.orders):
                    order = next(iter(world.orders))
                    stock = world.inventory.free_stock
                    if all(stock[line.sku] >= line.units for line in order.lines):
                        world.assign_order(order, 0)
                case 2:
                    robot = world.robots[step % 8]
                    pod = robot.index
                    if robot.task is None:
                        world.start_pick(robot, pod, 0)
                    while robot.task.picks:
                        pick = world.pick_unit(robot.task)
                        situation.tell(Trigger.UNIT_PICKED, (pod, pick.line.sku))
                        if rng.random() < 0.5:
                            break
                case 3:
                    bundle = situation.bundle(sku=int(rng.integers(5)), units=2)
                    pod = int(rng.integers(8))
                    world.promise(bundle, pod)
                    world.inventory.store(pod, bundle.sku, bundle.units)
                    situation.tell(Trigger.BUNDLE_STORED, bundle)
            for kind, tracker in zip(kinds, trackers, strict=True):
                wanted = demand(situation.view, kind)
                expected = np.minimum(world.inventory.contained, wanted[:, None]).sum(axis=0)
                assert tracker.units().tolist() == expected.tolist()
            speed = world.inventory.contained.sum(axis=0)
            assert scores.scores(0.0, 1.0).tolist() == pytest.approx((speed / speed.max()).tolist())


def test_a_tracker_is_made_once_for_each_kind_and_settings() -> None:
    trackers = Situation().view.trackers
    assert trackers.get(Prominence) is trackers.get(Prominence)
    assert trackers.get(DemandOnPods, "wanted") is not trackers.get(DemandOnPods, "unbound")
    assert trackers.get(Zones, ZoneParameters()) is trackers.get(Zones, ZoneParameters())
    assert trackers.get(Zones, ZoneParameters()) is not trackers.get(
        Zones, ZoneParameters(cache_share=0.5)
    )
