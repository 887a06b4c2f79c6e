"""PPS criteria and rules in small situations, the answers worked out by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from doubles import Situation, small_layout

from rmfs.control.pps.candidates import pick_candidates, replenishment_candidates
from rmfs.control.pps.criteria import (
    BundleDemand,
    BundleWorkAmount,
    Completeable,
    Fill,
    Nearest,
    PickDemand,
    PickWorkAmount,
    RandomCriterion,
    WaveWork,
)
from rmfs.control.pps.lexicographic import Lexicographic
from rmfs.control.pps.random import RandomPod


@pytest.fixture
def situation() -> Situation:
    """Pick station 0 at (0, 10), replenishment station 1 at (5, 10); pods at x = 0 to 5.

    Robot 0 stands at (0, 2), robot 1 at (1, 2). Top speed 1 m/s, a quarter turn takes 1 s.
    """
    return Situation(small_layout(places=8, pods=6, robots=2))


def candidates(situation: Situation):
    view = situation.view
    return pick_candidates(view, view.robots[0], view.pick_stations[0])


class TestCandidates:
    def test_pods_at_hand_with_a_wanted_unit(self, situation) -> None:
        """SKU 0 is on pods 1, 2 and 4; pod 2 is claimed; pod 4's only unit is bound."""
        for pod in (1, 2, 4):
            situation.stock(pod, s0=1)
        situation.stock(3, s1=1)
        situation.assigned(s0=1)
        situation.world.start_pick(situation.world.robots[1], pod=4, station=0)
        situation.assigned(s0=1)
        situation.world.storage.claim(2, robot=1)
        assert candidates(situation).pods.tolist() == [1]

    def test_none_without_open_requests(self, situation) -> None:
        situation.stock(1, s0=1)
        assert len(candidates(situation)) == 0

    def test_pods_for_which_bundles_wait_at_the_station(self, situation) -> None:
        situation.waiting_bundle(pod=3, station=1)
        view = situation.view
        found = replenishment_candidates(view, view.robots[0], view.replenishment_stations[0])
        assert found.pods.tolist() == [3]


class TestWaves:
    def test_units_of_the_first_wave(self, situation) -> None:
        """Now 100. Orders want 2 of SKU 0 by 200, 1 of SKU 1 by 200, 4 of SKU 0 by 260.

        Pod 0 has 5 of SKU 0, pod 1 has 1 of SKU 1 and 1 of SKU 0, pod 2 has 9 of SKU 2.
        """
        situation.world.now_s = 100.0
        situation.stock(0, s0=5)
        situation.stock(1, s0=1, s1=1)
        situation.stock(2, s2=9)
        for due_s, units in ((200.0, {"s0": 2}), (200.0, {"s1": 1}), (260.0, {"s0": 4})):
            situation.assigned(due_s=due_s, **units)
        found, rng = candidates(situation), situation.rng
        assert found.pods.tolist() == [0, 1]
        assert WaveWork().score(found, rng).tolist() == [2, 2]
        assert WaveWork(wave_s=59.0).score(found, rng).tolist() == [2, 2]
        assert WaveWork(wave_s=60.0).score(found, rng).tolist() == [5, 2]

    def test_late_orders_are_of_the_first_wave(self, situation) -> None:
        situation.world.now_s = 100.0
        situation.stock(0, s0=5)
        situation.assigned(due_s=40.0, s0=1)
        situation.assigned(due_s=150.0, s0=2)
        situation.assigned(due_s=400.0, s0=1)
        found = candidates(situation)
        assert WaveWork().score(found, situation.rng).tolist() == [3]
        situation.world.now_s = 500.0
        assert WaveWork().score(candidates(situation), situation.rng).tolist() == [4]


class TestCriteria:
    @pytest.fixture
    def three_orders(self, situation) -> Situation:
        """Orders: 0 wants 2 of SKU 0; 1 wants 1 of SKU 0 and 1 of SKU 1; 2 wants 1 of SKU 1.

        Pod 0 has 3 of SKU 0: completes order 0 only, serves 3 units.
        Pod 1 has 1 of each: for order 0 it lacks a unit; completes order 1, then nothing is left
        for order 2; serves 2 units.
        Pod 2 has 3 of SKU 0 and 2 of SKU 1: completes all, serves 5 units.
        """
        situation.stock(0, s0=3)
        situation.stock(1, s0=1, s1=1)
        situation.stock(2, s0=3, s1=2)
        situation.assigned(s0=2)
        situation.assigned(s0=1, s1=1)
        situation.assigned(s1=1)
        return situation

    def test_completeable(self, three_orders) -> None:
        found = candidates(three_orders)
        assert Completeable().score(found, three_orders.rng).tolist() == [1, 1, 3]
        done = found.completed()
        assert done.flags.tolist() == [
            [True, False, True],
            [False, True, True],
            [False, False, True],
        ]
        assert done.weighed([2.0, 2.0, 1.0], queued=False).tolist() == [2.0, 2.0, 5.0]

    def test_servable_units(self, three_orders) -> None:
        assert candidates(three_orders).servable_units().tolist() == [3, 2, 5]

    def test_work_amount_counts_units_of_completed_orders_twice(self, three_orders) -> None:
        """3 + 2, 2 + 2, 5 + 5."""
        criterion = PickWorkAmount(time_cost=0.0)
        scores = criterion.score(candidates(three_orders), three_orders.rng)
        assert scores.tolist() == [5.0, 4.0, 10.0]

    def test_work_amount_charges_for_the_way(self, three_orders) -> None:
        """Robot (0, 2) to pod x: 1 s turn + x + 2; pod to station (0, 10): x + 10. Sum 13 + 2 x.

        At half a unit per second and without boost: 3 - 6.5, 2 - 7.5, 5 - 8.5.
        """
        criterion = PickWorkAmount(time_cost=0.5, completable_boost=0.0)
        scores = criterion.score(candidates(three_orders), three_orders.rng)
        assert scores.tolist() == [-3.5, -5.5, -3.5]

    def test_nearest_by_time_and_by_distance(self, three_orders) -> None:
        """By time as above; by distance sqrt(x^2 + 4) + sqrt(x^2 + 100)."""
        found = candidates(three_orders)
        assert Nearest().score(found, three_orders.rng).tolist() == [-13.0, -15.0, -17.0]
        x = np.arange(3)
        expected = -(np.sqrt(x**2 + 4) + np.sqrt(x**2 + 100))
        scores = Nearest(metric="euclidean").score(found, three_orders.rng)
        assert np.allclose(scores, expected)

    def test_nearest_along_the_axes_and_without_estimate(self, three_orders) -> None:
        """Robot (0, 2) to pod x: x + 2; on to (0, 10): x + 10. Traffic knows no turns: as long."""
        found = candidates(three_orders)
        for criterion in (Nearest(metric="manhattan"), Nearest(estimate=False)):
            assert criterion.score(found, three_orders.rng).tolist() == [-12.0, -14.0, -16.0]

    def test_nearest_along_the_waypoints(self, three_orders) -> None:
        """No edge leads to a pod, but all are equally far then."""
        scores = Nearest(metric="path").score(candidates(three_orders), three_orders.rng)
        assert scores.tolist() == [-np.inf] * 3

    def test_random_is_uniform(self, three_orders) -> None:
        """Of 300 draws each pod is best in about 100."""
        found = candidates(three_orders)
        best = [RandomCriterion().score(found, three_orders.rng).argmax() for _ in range(300)]
        assert all(70 < count < 130 for count in np.bincount(best, minlength=3))

    def test_narrowing_keeps_what_was_counted(self, three_orders) -> None:
        found = candidates(three_orders)
        found.completed()
        kept = found.narrowed(np.array([0, 2]))
        assert kept.pods.tolist() == [0, 2]
        assert kept.completed().flags.sum(axis=0).tolist() == [1, 3]
        assert kept.servable_units().tolist() == [3, 5]

    def test_bundles(self, situation) -> None:
        for pod in (3, 3, 2):
            situation.waiting_bundle(pod, station=1)
        view = situation.view
        found = replenishment_candidates(view, view.robots[0], view.replenishment_stations[0])
        assert BundleWorkAmount().score(found, situation.rng).tolist() == [1.0, 2.0]


class TestLexicographic:
    def choose(self, situation, **parameters) -> int:
        controller = situation.make(Lexicographic, **parameters)
        return controller.pick_pod(situation.world.robots[0], situation.world.pick_stations[0])

    def test_the_second_criterion_decides_among_equals_of_the_first(self, situation) -> None:
        """Pods 0 and 2 complete one order each, pod 1 none; pod 2 serves a unit more.

        Order 0 wants 1 of SKU 0, order 1 wants 2 of SKU 1. Pod 2 has one of each: 1 completed, 2
        units. Way: 13 s to pod 0, 17 s to pod 2. Work amount: 1 + 1 - 13/3 = -2.33 against 2 + 1 -
        17/3 = -2.67: pod 0. With travel for nothing: 2 against 3, pod 2.
        """
        situation.stock(0, s0=1)
        situation.stock(1, s1=1)
        situation.stock(2, s0=1, s1=1)
        situation.assigned(s0=1)
        situation.assigned(s1=2)
        assert self.choose(situation) == 0
        free = {"criterion": "work-amount", "time_cost": 0.0}
        assert self.choose(situation, pick_pod=("completeable", free)) == 2

    def test_the_first_criterion_outweighs_all_others(self, situation) -> None:
        """Pod 5 completes one order of one unit, pod 0 gives five units of another: pod 5."""
        situation.stock(0, s1=5)
        situation.stock(5, s0=1)
        situation.assigned(s0=1)
        situation.assigned(s1=6)
        assert self.choose(situation) == 5

    def test_full_ties_go_to_the_first_pod(self, situation) -> None:
        for pod in (1, 3):
            situation.stock(pod, s0=1)
        situation.assigned(s0=1)
        assert self.choose(situation, pick_pod=("completeable",)) == 1

    def test_nothing_to_choose_from(self, situation) -> None:
        situation.assigned(s0=1)
        assert self.choose(situation) == -1

    def test_replenishment_takes_most_bundles_then_the_nearest(self, situation) -> None:
        """Two bundles each for pods 1 and 4, one for pod 0.

        Robot (0, 2) - pod - station (5, 10): for pod 1 sqrt(5) + sqrt(116) = 13.01, for pod 4
        sqrt(20) + sqrt(101) = 14.52.
        """
        for pod in (0, 1, 1, 4, 4):
            situation.waiting_bundle(pod, station=1)
        controller = situation.make(Lexicographic)
        robot, station = situation.world.robots[0], situation.world.replenishment_stations[0]
        assert controller.replenishment_pod(robot, station) == 1

    def test_the_next_station_is_the_one_with_most_work_then_the_nearest(self) -> None:
        """Stations at x = 0, 10, 20. Pod 0 finds 1, 2 and 2 units; station 1 is nearer than 2."""
        situation = Situation(small_layout(pick_stations=3))
        situation.stock(0, s0=9)
        situation.assigned(station=0, s1=1)
        situation.stock(0, s1=1)
        situation.carry(robot=0, pod=0)
        for station, units in ((0, 1), (1, 2), (2, 2)):
            situation.assigned(station, s0=units)
        controller = situation.make(Lexicographic)
        assert controller.next_station(situation.world.robots[0], [0, 1, 2]) == 1


class TestFill:
    """Pods of 100 space units with 80, 70 and 10 units of one space unit each."""

    @pytest.fixture
    def filled(self, situation) -> Situation:
        for pod, units in enumerate((80, 70, 10)):
            situation.stock(pod, s0=units)
        situation.assigned(s0=1)
        return situation

    @pytest.mark.parametrize(
        ("parameters", "expected"),
        [
            ({}, [1, 0, 0]),  # above 0.7: 0.7 itself is not
            ({"prefer_fullest": False}, [0, 0, 1]),  # below 0.7
            ({"binary": False}, [0.8, 0.7, 0.1]),
            ({"binary": False, "prefer_fullest": False}, [-0.8, -0.7, -0.1]),
            ({"threshold": 0.05}, [1, 1, 1]),
        ],
    )
    def test_share_of_capacity_in_use(self, filled, parameters, expected) -> None:
        scores = Fill(**parameters).score(candidates(filled), filled.rng)
        assert scores.tolist() == expected

    def test_promised_space_is_not_in_use(self, filled) -> None:
        filled.world.promise(filled.bundle(units=30), 2)
        scores = Fill(binary=False).score(candidates(filled), filled.rng)
        assert scores.tolist() == [0.8, 0.7, 0.1]


class TestDemand:
    def test_units_that_any_order_wants(self, situation) -> None:
        """Wanted: 2 + 3 of SKU 0 (station, backlog) and 4 of SKU 1 (backlog).

        Pod 0 has 9 of SKU 0: 5. Pod 1 has 1 of SKU 0 and 6 of SKU 1: 1 + 4.  Pod 2 has 2 of SKU 0:
        2.
        """
        situation.stock(0, s0=9)
        situation.stock(1, s0=1, s1=6)
        situation.stock(2, s0=2)
        criterion = PickDemand()
        criterion.prepare(situation.view)
        situation.assigned(s0=2)
        situation.order(s0=3, s1=4)
        assert criterion.score(candidates(situation), situation.rng).tolist() == [5, 5, 2]

    def test_bound_requests_are_wanted_no_more(self, situation) -> None:
        """Two units of the first order are bound to pod 3; three of the other remain wanted."""
        for pod in (0, 3):
            situation.stock(pod, s0=4)
        criterion = PickDemand()
        criterion.prepare(situation.view)
        situation.assigned(s0=2)
        situation.world.start_pick(situation.world.robots[1], pod=3, station=0)
        situation.assigned(s0=3)
        assert criterion.score(candidates(situation), situation.rng).tolist() == [3]

    def test_of_bundles_only_what_is_wanted_counts(self, situation) -> None:
        """Three of SKU 0 are wanted. Pod 2: a bundle of 4 of SKU 0: 3. Pod 3: two of SKU 1: 0."""
        situation.order(s0=3)
        situation.waiting_bundle(2, station=1)
        for _ in range(2):
            situation.waiting_bundle(3, station=1, sku=1)
        view = situation.view
        found = replenishment_candidates(view, view.robots[0], view.replenishment_stations[0])
        assert BundleDemand().score(found, situation.rng).tolist() == [3, 0]


class TestAgeAndLateness:
    """At 100 s. Order 0 was assigned at 0 s, wants 2 of SKU 0, due at 60; order 1 at 80 s, wants 1
    of SKU 0 and 1 of SKU 1, due at 130.

    Per request, age: 100 / 2 = 50, 20 / 2 = 10; lateness: 40 / 2 = 20, -30 / 2 = -15. Pod 0 has one
    of SKU 0: it serves order 0, the more valuable one. Pod 1 has three of SKU 0. Pod 2 has one of
    SKU 1.
    """

    @pytest.fixture
    def aged(self, situation) -> Situation:
        situation.stock(0, s0=1)
        situation.stock(1, s0=3)
        situation.stock(2, s1=1)
        situation.assigned(due_s=60.0, s0=2)
        situation.world.now_s = 80.0
        situation.assigned(due_s=130.0, s0=1, s1=1)
        situation.world.now_s = 100.0
        return situation

    def scores(self, aged, **parameters) -> list[float]:
        criterion = PickWorkAmount(time_cost=0.0, **parameters)
        return criterion.score(candidates(aged), aged.rng).tolist()

    def test_age(self, aged) -> None:
        """50; 50 + 50 + 10; 10. With boost pod 1, which completes order 0: 100 more."""
        assert self.scores(aged, metric="age", completable_boost=0.0) == [50.0, 110.0, 10.0]
        assert self.scores(aged, metric="age") == [50.0, 210.0, 10.0]

    def test_lateness(self, aged) -> None:
        """20; 20 + 20 - 15; -15. Only positive: 20, 40, 0."""
        given = {"metric": "lateness", "completable_boost": 0.0}
        assert self.scores(aged, **given) == [20.0, 25.0, -15.0]
        assert self.scores(aged, **given, only_positive_lateness=True) == [20.0, 40.0, 0.0]

    def test_plain_names(self) -> None:
        parameters = Lexicographic.parameters_model(
            pick_pod=("pile-on", "age", {"criterion": "lateness", "time_cost": 0.0})
        )
        assert [criterion.metric for criterion in parameters.pick_pod] == [
            "picks",
            "age",
            "lateness",
        ]
        assert [criterion.time_cost for criterion in parameters.pick_pod] == [1 / 3, 1 / 3, 0.0]

    def test_age_of_bundles(self, situation) -> None:
        """Pod 2: a bundle assigned at 0 s; pod 3: two assigned at 60 s. At 100 s: 100 and 80."""
        situation.waiting_bundle(2, station=1)
        situation.world.now_s = 60.0
        for _ in range(2):
            situation.waiting_bundle(3, station=1)
        situation.world.now_s = 100.0
        view = situation.view
        found = replenishment_candidates(view, view.robots[0], view.replenishment_stations[0])
        scores = BundleWorkAmount(age=True).score(found, situation.rng)
        assert scores.tolist() == [100.0, 80.0]


class TestTravelTime:
    def test_both_ways_estimated_or_exact(self, situation) -> None:
        """One unit on pod 0, at 1 unit per second. Robot (0, 2) - (0, 0) - (0, 10): 2 + 10 s
        exactly, a turn of 1 s more for each way that is estimated."""
        situation.stock(0, s0=1)
        situation.assigned(s0=1)
        found = candidates(situation)

        def score(**parameters) -> float:
            criterion = PickWorkAmount(time_cost=1.0, completable_boost=0.0, **parameters)
            return criterion.score(found, situation.rng).item()

        assert score() == 1 - 13
        assert score(estimate_to_pod=False) == 1 - 12
        assert score(estimate_to_station=True) == 1 - 14


class TestTiers:
    def test_pods_on_other_tiers_come_last(self) -> None:
        """Pods 0 and 1 are on the ground, 2 and 3 above; the station is on the ground, the robot
        above: pod 2 has nothing of the station's tier but the robot's, as pod 0 the other way."""
        plan = small_layout(places=8, pods=4, robots=2)
        tier = plan.tier.copy()
        tier[[2, 3, 8]] = 1
        plan = replace(plan, tier=tier, tiers=(*plan.tiers, *plan.tiers))
        situation = Situation(plan)
        for pod in range(4):
            situation.stock(pod, s0=1)
        situation.assigned(s0=1)
        found = candidates(situation)
        assert found.other_tiers().tolist() == [1, 1, 1, 1]
        situation.world.robots[0].tier = 0
        assert found.other_tiers().tolist() == [0, 0, 2, 2]
        criterion = PickWorkAmount(time_cost=0.0, completable_boost=0.0)
        assert criterion.score(found, situation.rng).tolist() == [1, 1, -1999, -1999]
        assert (RandomCriterion().score(found, situation.rng) < 1).tolist() == [True] * 4
        assert (RandomCriterion().score(found, situation.rng)[2:] < -1).all()


def test_random_takes_any_pod_with_work(situation) -> None:
    for pod in (1, 3, 4):
        situation.stock(pod, s0=1)
    situation.stock(2, s1=1)
    situation.assigned(s0=1)
    controller = situation.make(RandomPod)
    robot, station = situation.world.robots[0], situation.world.pick_stations[0]
    assert {controller.pick_pod(robot, station) for _ in range(60)} == {1, 3, 4}
