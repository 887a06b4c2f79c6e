"""POA rules in small situations, the answers worked out by hand."""

from __future__ import annotations

import pytest
from assigning import assign as decide
from assigning import stocked
from doubles import Situation, small_layout

from rmfs.control.poa.order_rules import RandomOrder
from rmfs.control.poa.pod_match import PodMatch
from rmfs.control.problems import Trigger


@pytest.fixture
def situation() -> Situation:
    """Two stations, four pods; see `stocked`."""
    return stocked()


class TestPodMatch:
    def test_the_pair_with_most_units_on_inbound_pods_comes_first(self, situation) -> None:
        """Pod 1 is on its way to station 1, with 10 - 1 = 9 units of SKU 1 to spare.

        Order 1 wants 1 of them, order 2 wants 2 and one of SKU 0: the scores at station 1 are 0, 1
        and 2. Order 2 goes first; then order 1; order 0, with score 0 anywhere, goes to station 0.
        """
        situation.assigned(station=1, s1=1)
        situation.world.start_pick(situation.world.robots[0], pod=1, station=1)
        for units in ({"s0": 1}, {"s1": 1}, {"s1": 2, "s0": 1}):
            situation.order(**units)
        controller = situation.make(PodMatch, fast_lane=False)
        assert decide(situation, controller) == [(3, 1), (2, 1), (1, 0)]

    def test_a_unit_counts_for_one_order_only(self, situation) -> None:
        """Pod 1 brings 10 units to station 1; one is bound, eight are waited for: one to spare.

        Orders 2 and 3 want one each. Order 2 gets it; then order 3, for which pod 2 at its place
        has stock, scores 0 at both stations and goes to the first.
        """
        situation.stock(2, s1=10)
        situation.assigned(station=1, s1=1)
        situation.world.start_pick(situation.world.robots[0], pod=1, station=1)
        situation.assigned(station=1, s1=8)
        situation.order(s1=1)
        situation.order(s1=1)
        controller = situation.make(PodMatch, fast_lane=False)
        assert decide(situation, controller) == [(2, 1), (3, 0)]

    def test_ties_go_to_the_earliest_due_time_then_to_the_first_order(self, situation) -> None:
        """All score 0. Due times 50, 20, 20: order 1, order 2, order 0; all to station 0."""
        for due_s in (50.0, 20.0, 20.0):
            situation.order(due_s, s0=1)
        controller = situation.make(PodMatch, fast_lane=False)
        assert decide(situation, controller) == [(1, 0), (2, 0), (0, 0)]

    def test_first_come_ties(self, situation) -> None:
        for due_s in (50.0, 20.0):
            situation.order(due_s, s0=1)
        controller = situation.make(PodMatch, fast_lane=False, tie_breaker="first-come")
        assert decide(situation, controller) == [(0, 0), (1, 0)]

    def test_late_orders_come_first_if_so_wished(self, situation) -> None:
        """Order 1 matches two units of pod 0, order 2 none but it was due at 5 and it is 10 now."""
        situation.assigned(s0=1)
        situation.world.start_pick(situation.world.robots[0], pod=0, station=0)
        situation.world.now_s = 10.0
        situation.order(due_s=100.0, s0=2)
        situation.order(due_s=5.0, s1=1)
        controller = situation.make(PodMatch, fast_lane=False, late_first=True)
        assert [order for order, _ in decide(situation, controller)] == [2, 1]

    def test_one_slot_of_each_station_is_kept_for_the_fast_lane(self, situation) -> None:
        """Two stations with four slots take three orders each."""
        for _ in range(8):
            situation.order(s0=1)
        assert len(decide(situation, situation.make(PodMatch))) == 6

    def test_the_fast_lane_takes_an_order_that_has_lost_units(self, situation) -> None:
        """Pod 0 stands at station 0, and only the slots kept for the fast lane are free.

        The order also wants a unit of SKU 4, which no pod has: it fits only after it was cut.
        """
        controller = situation.make(PodMatch)
        situation.carry(robot=0, pod=0, station=0)
        order = situation.order(s0=1, s4=1)
        for station in (0, 1):
            for _ in range(3):
                situation.assigned(station=station, s1=1)
        assert decide(situation, controller) == []
        situation.world.cut_order(order, {0: 1})
        controller.hear(Trigger.ORDER_CUT, order)
        assert decide(situation, controller) == [(order.index, 0)]

    def test_a_station_with_a_single_slot_uses_it(self) -> None:
        situation = Situation(small_layout(slots=1))
        situation.stock(0, s0=1)
        situation.order(s0=1)
        assert decide(situation, situation.make(PodMatch)) == [(0, 0)]

    def test_an_order_that_stock_cannot_serve_waits(self, situation) -> None:
        """Ten units of SKU 0, eight of them wanted at station 0: two can be served, not three."""
        situation.assigned(s0=8)
        situation.order(s0=3)
        situation.order(s0=2)
        assert decide(situation, situation.make(PodMatch, fast_lane=False)) == [(2, 0)]

    def test_a_switched_off_station_gets_nothing(self, situation) -> None:
        situation.world.pick_stations[0].active = False
        situation.order(s0=1)
        assert decide(situation, situation.make(PodMatch)) == [(0, 1)]


class TestFastLane:
    @pytest.fixture
    def served(self, situation) -> Situation:
        """Pod 0 stands at station 0 with ten units of SKU 0, one of them bound; a slot is free."""
        situation.stock(0, s1=1)
        situation.assigned(s0=1)
        for _ in range(2):
            situation.assigned(s3=1)
        situation.carry(robot=0, pod=0)
        return situation

    def test_the_pod_at_the_station_takes_an_order_it_completes(self, served) -> None:
        """Order 3 needs pod 2 as well; 4 and 5 fit, 5 is due first and gets the last slot."""
        served.world.pick_stations[1].active = False
        served.order(due_s=1.0, s0=1, s2=1)
        served.order(due_s=90.0, s0=1, s1=1)
        served.order(due_s=50.0, s0=9)
        assert decide(served, served.make(PodMatch)) == [(5, 0)]

    def test_units_promised_a_moment_ago_are_not_promised_again(self, served) -> None:
        """Nine units to spare: order 3 takes five; order 4 wants five and is not completed."""
        served.world.pick_stations[0].slots = 9
        controller = served.make(PodMatch)
        served.order(s0=5)
        served.order(s0=5)
        assert next(controller.decide()) == (served.world.orders.orders[3], 0)
        served.world.assign_order(served.world.orders.orders[3], 0)
        assert list(controller._lane.decide()) == []

    def test_orders_that_come_during_the_visit_are_looked_at(self, served) -> None:
        served.world.pick_stations[1].active = False
        controller = served.make(PodMatch)
        served.order(s0=1, s2=1)
        assert decide(served, controller) == []
        served.order(s1=1)
        assert decide(served, controller) == [(4, 0)]

    def test_without_a_pod_at_the_station_the_lane_is_closed(self, situation) -> None:
        for _ in range(3):
            situation.assigned(s3=1)
        situation.world.pick_stations[1].active = False
        situation.order(s0=1)
        assert decide(situation, situation.make(PodMatch)) == []


class TestRandom:
    def test_it_fills_all_slots(self, situation) -> None:
        for _ in range(9):
            situation.order(s0=1)
        made = decide(situation, situation.make(RandomOrder))
        assert len(made) == 8
        assert len({order for order, _ in made}) == 8
        assert sorted(station for _, station in made) == [0] * 4 + [1] * 4

    def test_only_orders_that_stock_can_serve(self, situation) -> None:
        """Of 40 orders only one can be served."""
        for _ in range(39):
            situation.order(s0=11)
        situation.order(s0=10)
        assert [order for order, _ in decide(situation, situation.make(RandomOrder))] == [39]

    def test_every_station_and_order_can_be_chosen(self, situation) -> None:
        orders, stations = set(), set()
        for _ in range(2):
            situation.order(s0=1)
        controller = situation.make(RandomOrder)
        for _ in range(50):
            order, station = next(controller.decide())
            orders.add(order.index)
            stations.add(station)
        assert (orders, stations) == ({0, 1}, {0, 1})
