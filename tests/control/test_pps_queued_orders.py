"""PPS: pods for orders that are queued at a station, worked out by hand."""

from __future__ import annotations

import pytest
from doubles import Situation, small_layout

from rmfs.control.pps.candidates import pick_candidates
from rmfs.control.pps.criteria import (
    Completeable,
    PickWorkAmount,
)
from rmfs.control.pps.random import RandomPod
from rmfs.world import verify


@pytest.fixture
def situation() -> Situation:
    """Pick station 0 at (0, 10), replenishment station 1 at (5, 10); pods at x = 0 to 5.

    Robot 0 stands at (0, 2), robot 1 at (1, 2). Top speed 1 m/s, a quarter turn takes 1 s.
    """
    return Situation(small_layout(places=8, pods=6, robots=2))


def candidates(situation: Situation):
    view = situation.view
    return pick_candidates(view, view.robots[0], view.pick_stations[0])


class TestQueuedOrders:
    """Order 0 (assigned) wants 1 of SKU 0. Queued: order 1 wants 2 of SKU 1, order 2 wants 1 of SKU
    1 and 1 of SKU 2.

    Pod 0: one of SKU 0. Pod 1: two of SKU 1, completes order 1. Pod 2: one of SKU 1, completes
    none. Pod 3: two of SKU 1 and one of SKU 2: completes order 1, after which one of SKU 1 is
    missing for order 2.
    """

    @pytest.fixture
    def pooled(self, situation) -> Situation:
        situation.stock(0, s0=1)
        situation.stock(1, s1=2)
        situation.stock(2, s1=1)
        situation.stock(3, s1=2, s2=1)
        situation.assigned(s0=1)
        for units in ({"s1": 2}, {"s1": 1, "s2": 1}):
            situation.world.queue_order(situation.order(**units), 0)
        return situation

    def found(self, pooled, requests):
        view = pooled.view
        return pick_candidates(view, view.robots[0], view.pick_stations[0], requests)

    @pytest.mark.parametrize(
        ("requests", "pods"),
        [
            ("assigned", [0]),
            ("assigned-and-completable", [0, 1, 3]),
            ("assigned-and-queued", [0, 1, 2, 3]),
        ],
    )
    def test_which_pods_are_considered(self, pooled, requests, pods) -> None:
        assert self.found(pooled, requests).pods.tolist() == pods

    def test_queued_orders_count_only_while_a_slot_is_free(self, pooled) -> None:
        for _ in range(3):
            pooled.assigned(s3=1)
        assert pooled.world.pick_stations[0].free_slots == 0
        assert self.found(pooled, "assigned-and-queued").pods.tolist() == [0]

    def test_completeable_counts_them_if_so_wished(self, pooled) -> None:
        found = self.found(pooled, "assigned-and-completable")
        assert Completeable().score(found, pooled.rng).tolist() == [1, 1, 1]
        assert Completeable(queued=False).score(found, pooled.rng).tolist() == [1, 0, 0]

    def test_work_amount_weighs_what_would_be_bound(self, pooled) -> None:
        """Weight 0.2. Pod 0: 1, boost 1. Pods 1 and 3: two units of order 1, boost: 0.2 x 4."""
        found = self.found(pooled, "assigned-and-completable")
        scores = PickWorkAmount(time_cost=0.0).score(found, pooled.rng)
        assert scores.tolist() == pytest.approx([2.0, 0.8, 0.8])
        scores = PickWorkAmount(time_cost=0.0, boost_queued=False).score(found, pooled.rng)
        assert scores.tolist() == pytest.approx([2.0, 0.4, 0.4])

    def test_or_all_of_them(self, pooled) -> None:
        """Without boost: pod 1 has 2 units for the pool, pod 2 has 1, pod 3 has 3."""
        found = self.found(pooled, "assigned-and-queued")
        criterion = PickWorkAmount(time_cost=0.0, completable_boost=0.0)
        scores = criterion.score(found, pooled.rng)
        assert scores.tolist() == pytest.approx([1.0, 0.4, 0.2, 0.6])

    def test_age_since_they_were_queued(self, pooled) -> None:
        """At 100 s all are 100 s old; per request 100, 50 and 50. Pod 1: 0.2 x 100; pod 2: 0.2 x
        50; pod 3: 0.2 x 150."""
        pooled.world.now_s = 100.0
        criterion = PickWorkAmount(metric="age", time_cost=0.0, completable_boost=0.0)
        scores = criterion.score(self.found(pooled, "assigned-and-queued"), pooled.rng)
        assert scores.tolist() == pytest.approx([100.0, 20.0, 10.0, 30.0])

    def test_age_of_a_part_whose_order_is_queued(self, situation) -> None:
        """At 100 s: the part has waited 90 s for one unit, its order in the pool 20 s for two."""
        situation.stock(0, s0=1)
        situation.stock(1, s1=2)
        order, world = situation.order(s0=1, s1=2), situation.world
        world.now_s = 10.0
        world.assign_lines(order, 0, [0])
        world.now_s = 80.0
        world.queue_order(order, 0)
        world.now_s = 100.0
        criterion = PickWorkAmount(metric="age", time_cost=0.0, completable_boost=0.0)
        scores = criterion.score(self.found(situation, "assigned-and-queued"), situation.rng)
        assert scores.tolist() == pytest.approx([90.0, 0.2 * 20.0])

    def test_what_a_carried_pod_serves(self, pooled) -> None:
        """Robot 0 stands with its pod at another station, say; then at station 0 itself, where a
        pod is not used for queued orders."""
        world = pooled.world
        for mode, expected in (
            ("assigned", [True, False, False, False]),
            ("assigned-and-completable", [True, True, False, True]),
            ("assigned-and-queued", [True, True, True, True]),
        ):
            rule = pooled.make(RandomPod, consider=mode, reserve="assigned-and-queued")
            assert [rule.serves(pod, 0) for pod in range(4)] == expected
        rule = pooled.make(RandomPod)
        world.storage.claim(1, 0)
        world.robots[0].station = 0
        assert not rule.serves(1, 0)

    def test_what_is_brought_must_be_bound(self) -> None:
        with pytest.raises(ValueError, match="reserve must include the requests of consider"):
            RandomPod.parameters_model(reserve="assigned")

    def test_a_station_is_searched_again_if_an_order_is_bound_in_part(self, pooled) -> None:
        """Pod 2 takes one of the two units of order 1: then pods with one unit complete it, too.

        Pod 3 takes all of order 2, after which no more pods than before are useful.
        """
        world, view = pooled.world, pooled.view
        first, second = world.pick_stations[0].queued.values()
        before = view.work_version(0)
        task = world.start_pick(world.robots[0], 3, 0)
        assert world.extend_queued(task, second, whole=True) == 2
        assert view.work_version(0) == before
        task = world.start_pick(world.robots[1], 2, 0)
        assert world.extend_queued(task, first, whole=False) == 1
        assert view.work_version(0) != before

    def test_binding_leaves_the_counts_in_order(self, pooled) -> None:
        """Pod 3 takes order 1 whole; order 2 lacks a unit of SKU 1, and gets one of SKU 2 if it
        need not be whole."""
        world = pooled.world
        task = world.start_pick(world.robots[0], 3, 0)
        first, second = world.pick_stations[0].queued.values()
        assert world.extend_queued(task, first, whole=True) == 2
        assert world.extend_queued(task, second, whole=True) == 0
        assert world.extend_queued(task, second, whole=False) == 1
        assert (first.open_units, second.open_units) == (0, 1)
        verify(world)
        assert world.give_back(task) == 3
        assert (first.open_units, second.open_units) == (2, 2)
        verify(world)
