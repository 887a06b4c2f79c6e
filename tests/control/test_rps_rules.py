"""RPS rules that look at demand, classes and places, answers worked out by hand."""

from __future__ import annotations

from math import inf

import pytest
from assigning import promise as decide
from doubles import Situation, small_layout

from rmfs.control.problems import Trigger
from rmfs.control.rps.correlative import Correlative
from rmfs.control.rps.least_demand import LeastDemand
from rmfs.control.rps.located import Nearest, Reactive
from rmfs.control.rps.turnover import Turnover, outward


def pods(situation: Situation, controller) -> list[int]:
    return [made[2] for made in decide(situation, controller) if made[0] == "promise"]


class TestLeastDemand:
    @pytest.fixture
    def situation(self) -> Situation:
        """SKUs 0 and 1 on pod 0, SKU 2 on pods 1 and 2, SKU 3 on pod 3."""
        made = Situation(small_layout(pods=4))
        made.stock(0, s0=2, s1=5)
        made.stock(1, s2=50)
        made.stock(2, s2=1)
        made.stock(3, s3=1)
        return made

    def test_the_pod_whose_skus_are_wanted_least(self, situation) -> None:
        """Wanted: 1 of SKU 0, 2 of SKU 1, 2 of SKU 2, 4 of SKU 3. Pods: 3, 2, 2, 4: pod 1.

        A pod's demand does not depend on how much it has of a SKU.
        """
        situation.order(s0=1, s2=2)
        situation.order(s1=2, s3=4)
        situation.bundle()
        assert pods(situation, situation.make(LeastDemand)) == [1]

    def test_units_at_stations_count_until_they_are_picked(self, situation) -> None:
        """Wanted: 1 of SKU 2, 2 of SKU 0, and 2 of SKU 3 bound to pod 3: pods 2, 1, 1, 2.

        When one of SKU 3 is picked: 2, 1, 1, 1. When both are: pod 3 is empty, and 0.
        """
        situation.stock(3, s3=1)
        situation.order(s0=2, s2=1)
        situation.assigned(s3=2)
        situation.carry(robot=0, pod=3)
        controller = situation.make(LeastDemand, stick_to_pod=False)
        situation.bundle()
        task = situation.world.robots[0].task
        assert controller.choose(situation.bundle()) == 1
        situation.world.pick_unit(task)
        assert controller.choose(situation.bundle()) == 1
        situation.world.pick_unit(task)
        assert controller.choose(situation.bundle()) == 3

    def test_only_pods_with_room(self, situation) -> None:
        """60 do not fit into pod 1 (50 of 100); pod 2 is as good."""
        situation.order(s0=9, s3=9)
        situation.bundle(units=60)
        assert pods(situation, situation.make(LeastDemand)) == [2]

    def test_it_sticks_to_its_pod(self, situation) -> None:
        """Nothing is wanted, so all pods are equal: pod 0 (7 of 100) takes 48 and 45, and is full.

        The bundle of 4 goes to the next pod.
        """
        for units in (48, 45, 4):
            situation.bundle(units=units)
        assert pods(situation, situation.make(LeastDemand)) == [0, 0, 1]


class TestCorrelative:
    def test_the_pod_with_skus_ordered_together_with_the_bundles(self) -> None:
        """SKU 0 came with SKU 1 in two orders, with SKUs 2 and 3 in one each.

        Pod 0 has SKU 4: 0. Pod 1 has SKU 1: 2. Pod 2 has SKUs 2 and 3: 2. Pod 3 has all: 4.
        """
        situation = Situation(small_layout(pods=4))
        situation.stock(0, s4=1)
        situation.stock(1, s1=9)
        situation.stock(2, s2=1, s3=1)
        situation.stock(3, s1=1, s2=1, s3=1)
        for units in ({"s0": 1, "s1": 1}, {"s0": 3, "s1": 1, "s2": 1}, {"s3": 1, "s0": 1}):
            situation.order(**units)
        controller = situation.make(Correlative)
        assert controller.choose(situation.bundle(sku=0)) == 3
        situation.world.inventory.promise(3, 95.0)
        assert controller.choose(situation.bundle(sku=0)) == 1

    def test_a_sku_that_never_came_with_another_goes_to_the_first_pod(self) -> None:
        situation = Situation(small_layout(pods=4))
        situation.order(s0=1)
        assert situation.make(Correlative).choose(situation.bundle(sku=0)) == 0

    def test_orders_are_counted_as_they_come(self) -> None:
        situation = Situation(small_layout(pods=2))
        situation.stock(1, s1=1)
        controller = situation.make(Correlative)
        order = situation.order(s0=1, s1=1)
        (tracker,) = situation.view.trackers
        tracker.hear(Trigger.NEW_ORDER, order)
        assert controller.choose(situation.bundle(sku=0)) == 1
        assert controller.choose(situation.bundle(sku=2)) == 0


class TestNearest:
    @pytest.fixture
    def situation(self) -> Situation:
        """Replenishment stations 1 and 2 at x = 5 and x = 15; pod k at x = k."""
        return Situation(small_layout(places=20, pods=12, robots=2, replenishment_stations=2))

    def sent(self, situation: Situation, station: int, units: int = 4) -> None:
        situation.world.choose_station(situation.bundle(units=units), station)

    def test_it_waits_for_the_station(self, situation) -> None:
        situation.bundle()
        self.sent(situation, 2)
        assert decide(situation, situation.make(Nearest)) == [("promise", 1, 11)]

    def test_nearest_with_room_ties_by_number(self, situation) -> None:
        """Pod 5 is straight across; it is full: pods 4 and 6 are equally near."""
        situation.stock(5, s0=98)
        self.sent(situation, 1)
        assert pods(situation, situation.make(Nearest)) == [4]

    def test_carried_pods_come_last(self, situation) -> None:
        """Pod 5 was straight across, and is on a robot now."""
        situation.stock(5, s0=1)
        situation.assigned(s0=1)
        situation.carry(robot=0, pod=5)
        self.sent(situation, 1)
        assert pods(situation, situation.make(Nearest)) == [4]

    def test_among_carried_pods_by_where_they_are(self, situation) -> None:
        """All other pods are full. Pods 0 and 11 were lifted; their robots are at x = 0 and x = 1.

        Pod 11 is nearer to x = 5 than pod 0 now.
        """
        for pod in range(1, 11):
            situation.stock(pod, s1=98)
        for robot, pod in ((0, 0), (1, 11)):
            situation.stock(pod, s0=1)
            situation.assigned(s0=1)
            situation.carry(robot=robot, pod=pod)
        self.sent(situation, 1)
        assert pods(situation, situation.make(Nearest)) == [11]

    def test_no_room_anywhere(self, situation) -> None:
        self.sent(situation, 1, units=101)
        assert decide(situation, situation.make(Nearest)) == []

    def test_it_does_not_stick(self, situation) -> None:
        for station in (1, 2, 1):
            self.sent(situation, station)
        assert pods(situation, situation.make(Nearest)) == [5, 11, 5]


class TestReactive:
    @pytest.fixture
    def situation(self) -> Situation:
        """Four pods: 50, 20, 20 and 10 space units used; pod 3 is carried."""
        made = Situation(small_layout(pods=4))
        for pod, units in enumerate((50, 20, 20, 9)):
            made.stock(pod, s0=units)
        made.stock(3, s1=1)
        made.assigned(s1=1)
        made.carry(robot=0, pod=3)
        return made

    def sent(self, situation: Situation, units: int = 4):
        bundle = situation.bundle(units=units)
        situation.world.choose_station(bundle, 1)
        return bundle

    def test_it_waits_for_the_station(self, situation) -> None:
        situation.bundle()
        assert decide(situation, situation.make(Reactive)) == []

    def test_the_emptiest_stored_pod(self, situation) -> None:
        """Pod 3 is emptier than pods 1 and 2, but it is carried."""
        self.sent(situation)
        assert pods(situation, situation.make(Reactive, among_equals="emptiest")) == [1]

    def test_a_carried_pod_if_no_other_has_room(self, situation) -> None:
        self.sent(situation, units=85)
        assert pods(situation, situation.make(Reactive, among_equals="emptiest")) == [3]

    def test_any_stored_pod_with_room(self, situation) -> None:
        """60 do not fit into pod 0."""
        controller = situation.make(Reactive)
        bundle = self.sent(situation, units=60)
        assert {controller.choose(bundle) for _ in range(50)} == {1, 2}


class TestTurnover:
    @pytest.fixture
    def situation(self, monkeypatch) -> Situation:
        """Ten places and ten pods; SKU k on pod k (k < 5). Station 0 is at x = 0.

        SKU 0 was ordered 50 times, SKU 1 40, SKU 2 5, SKUs 3 and 4 none. Classes of pods: pod 0;
        pods 1 and 2; the others. SKUs have equal space, 1/5 each; their shares are (50/95 + 1/5)/2
        = 0.363 for SKU 0, 0.311 for SKU 1, 0.126, 0.1 and 0.1. Sums before SKUs 0 to 4: 0, 0.363,
        0.674 ...: SKU 0 is of class 0; the others of class 2, since 0.363 is over the border 0.3.
        """
        made = Situation(small_layout(places=10, pods=10))
        for pod in range(5):
            made.stock(pod, **{f"s{pod}": 1})
        made.order(s0=50, s1=40, s2=5)
        return made

    def rule(self, situation: Situation, **parameters):
        return situation.make(Turnover, place_metric="euclidean", **parameters)

    def test_outward(self) -> None:
        """The class itself, the next slower, the next faster, and so on."""
        assert outward(0, 3) == [0, 1, 2]
        assert outward(1, 3) == [1, 2, 0]
        assert outward(2, 3) == [2, 1, 0]
        assert outward(1, 4) == [1, 2, 0, 3]

    def test_the_pod_of_the_skus_class(self, situation) -> None:
        """Class 0 is pod 0. Of class 2 pod 5 is the first that is empty."""
        controller = self.rule(situation)
        assert controller.choose(situation.bundle(sku=0)) == 0
        assert controller.choose(situation.bundle(sku=1)) == 5

    def test_if_the_class_is_full_the_next_slower(self, situation) -> None:
        """Pod 0 is full; of class 1 pods 1 and 2 have one unit each: pod 1."""
        situation.world.inventory.promise(0, 97.0)
        assert self.rule(situation).choose(situation.bundle(sku=0)) == 1

    def test_each_class_sticks_to_its_last_pod(self, situation) -> None:
        """Pod 5 until it is served; it has 8 then, the others of its class are emptier."""
        for sku in (1, 0, 1):
            situation.bundle(sku=sku)
        controller = self.rule(situation)
        assert pods(situation, controller) == [5, 0, 5]
        stored = situation.bundle(sku=1)
        stored.pod = 5
        controller.hear(Trigger.BUNDLE_STORED, stored)
        assert controller.choose(situation.bundle(sku=2)) == 6

    def test_any_pod_of_the_class(self, situation) -> None:
        chosen = {
            self.rule(situation, emptiest=False).choose(situation.bundle(sku=4)) for _ in range(99)
        }
        assert chosen == {3, 4, 5, 6, 7, 8, 9}

    def test_threshold_of_the_class(self, situation) -> None:
        """A bundle of 20 is enough for pod 0 (10 %), not for pod 5 (90 %)."""
        controller = self.rule(situation, buffer_thresholds=(0.1, 0.5, 0.9))
        for sku in (0, 1):
            situation.bundle(sku=sku, units=20)
        made = decide(situation, controller)
        assert made == [("promise", 0, 0), ("release", 0), ("promise", 1, 5)]

    def test_time_out_of_the_class(self, situation) -> None:
        """Promised at 0 s to pod 0 and pod 5: the bundle of pod 5 is released first, at 50 s."""
        controller = self.rule(situation, buffer_timeouts_s=(200.0, 100.0, 50.0))
        for sku in (0, 1):
            situation.bundle(sku=sku)
        decide(situation, controller)
        assert controller.next_event_s() == 50.0
        situation.world.now_s = 50.0
        assert decide(situation, controller) == [("release", 5)]
        assert controller.next_event_s() == 200.0
        situation.world.now_s = 200.0
        assert decide(situation, controller) == [("release", 0)]
        assert controller.next_event_s() == inf

    def test_no_room_anywhere(self, situation) -> None:
        assert self.rule(situation).choose(situation.bundle(units=101)) == -1
