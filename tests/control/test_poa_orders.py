"""POA rules that take orders in some order of their own, answers worked out by hand."""

from __future__ import annotations

import pytest
from assigning import assign as decide
from assigning import stocked
from doubles import Situation, small_layout

from rmfs.control.poa.near_best_pod import NearBestPod
from rmfs.control.poa.order_rules import (
    CriticalRatio,
    DueTime,
    FirstCome,
    FrequencyAge,
    RandomOrder,
    Slack,
    TardinessCost,
)
from rmfs.control.poa.related import Related
from rmfs.control.poa.workload import Workload


@pytest.fixture
def situation() -> Situation:
    """Two stations, four pods; see `stocked`."""
    return stocked()


class TestWhichOrder:
    def test_first_come(self, situation) -> None:
        """Order 0 wants eleven units of SKU 0 and waits; then orders 1 and 2."""
        for units in ({"s0": 11}, {"s1": 1}, {"s0": 10}):
            situation.order(**units)
        made = decide(situation, situation.make(FirstCome))
        assert [order for order, _ in made] == [1, 2]

    def test_stock_wanted_by_orders_just_assigned_is_gone(self, situation) -> None:
        """Orders 0 and 1 want six of the ten units each: order 1 has to wait, order 2 does not."""
        for units in (6, 6, 4):
            situation.order(s0=units)
        made = decide(situation, situation.make(FirstCome))
        assert [order for order, _ in made] == [0, 2]

    def test_due_time_and_its_ties(self, situation) -> None:
        """Due at 30, 20, 20, 10: order 3, then 1 before 2, which came later, then 0."""
        for due_s in (30.0, 20.0, 20.0, 10.0):
            situation.order(due_s, s0=1)
        made = decide(situation, situation.make(DueTime))
        assert [order for order, _ in made] == [3, 1, 2, 0]

    def test_slack_and_critical_ratio(self, situation) -> None:
        """Work of 60 s per line and 10 s per unit, 100 s left already.

        Order 0: due in 400, work 70: slack 330, ratio 5.7. Order 1: due in 420, work 160 (two
        lines, four units): 260, 2.6. Order 2: due in 170, work 70: 100, 2.4. Order 3: due in 350,
        work 110: 240, 3.2. Order 4: overdue by 40, work 70: -110, -0.6.
        """
        situation.world.now_s = 100.0
        wanted = ({"s0": 1}, {"s0": 2, "s1": 2}, {"s0": 1}, {"s0": 5}, {"s1": 1})
        for due_s, units in zip((500.0, 520.0, 270.0, 450.0, 60.0), wanted, strict=True):
            situation.order(due_s, **units)
        made = decide(situation, situation.make(Slack))
        assert [order for order, _ in made] == [4, 2, 3, 1, 0]

    def test_critical_ratio_prefers_little_time_per_work(self, situation) -> None:
        """As above: 2.4, 2.6, 3.2, 5.7 after the one overdue; ties go to the older order."""
        situation.world.now_s = 100.0
        wanted = ({"s0": 1}, {"s0": 2, "s1": 2}, {"s0": 1}, {"s0": 5}, {"s1": 1}, {"s0": 1})
        due = (500.0, 520.0, 270.0, 450.0, 60.0, 270.0)
        for due_s, units in zip(due, wanted, strict=True):
            situation.order(due_s, **units)
        made = decide(situation, situation.make(CriticalRatio))
        assert [order for order, _ in made] == [4, 2, 5, 1, 3, 0]

    def test_what_work_is_counted_is_a_parameter(self, situation) -> None:
        """Without any work, slack is the due time; with 300 s per line, two lines come first."""
        for due_s, units in ((100.0, {"s0": 1}), (200.0, {"s0": 1, "s1": 1})):
            situation.order(due_s, **units)
        made = decide(situation, situation.make(Slack, line_s=300.0, unit_s=0.0))
        assert [order for order, _ in made] == [1, 0]
        other = stocked()
        for due_s, units in ((100.0, {"s0": 1}), (200.0, {"s0": 1, "s1": 1})):
            other.order(due_s, **units)
        made = decide(other, other.make(Slack, line_s=0.0, unit_s=0.0))
        assert [order for order, _ in made] == [0, 1]

    def test_tardiness_cost(self, situation) -> None:
        """Work of 70 s each, 70 on average, two ahead: urgency falls by e in 140 s of slack.

        Slack of orders 0 to 3: 0 (overdue), 140, 280 and 280, of weights 1, 1, 1 and 4: costs
        1, 0.368, 0.135 and 0.541.
        """
        situation.world.now_s = 100.0
        for due_s, weight in ((90.0, 1.0), (310.0, 1.0), (450.0, 1.0), (450.0, 4.0)):
            order = situation.order(due_s, s0=1)
            order.weight = weight
            situation.world.orders.remove(order)
            situation.world.orders.add(order)
        made = decide(situation, situation.make(TardinessCost))
        assert [order for order, _ in made] == [0, 3, 1, 2]

    def test_tardiness_cost_prefers_little_work(self, situation) -> None:
        """All overdue: weight over work decides, 1/160, 1/70 and 3/160."""
        situation.world.now_s = 100.0
        for weight, units in (
            (1.0, {"s0": 2, "s1": 2}),
            (1.0, {"s0": 1}),
            (3.0, {"s0": 2, "s1": 2}),
        ):
            order = situation.order(50.0, **units)
            order.weight = weight
            situation.world.orders.remove(order)
            situation.world.orders.add(order)
        made = decide(situation, situation.make(TardinessCost))
        assert [order for order, _ in made] == [2, 1, 0]

    def test_frequency_and_age(self, situation) -> None:
        """Units ordered so far: 1 + 1 of SKU 0, 6 + 2 of SKU 1.

        Ages of orders 0, 1 and 2 are 3/3, 2/3 and 1/3. Order 0 (SKU 0): 1 x 2 = 2; order 1
        (SKU 1): 2/3 x 8 = 16/3; order 2 (SKUs 0 and 1): 1/3 x 5 = 5/3.

        With order 1 gone, ages are 2/2 and 1/2: order 0: 2, order 2: 1/2 x 5 = 5/2.
        """
        situation.order(s0=1)
        situation.order(s1=6)
        situation.order(s0=1, s1=2)
        made = decide(situation, situation.make(FrequencyAge))
        assert [order for order, _ in made] == [1, 2, 0]

    def test_frequency_and_age_ties_go_to_the_older_order(self, situation) -> None:
        """Ages 2/2 and 1/2, units ordered 2 (SKU 0) and 4 (SKU 1): both products are 2."""
        situation.order(s0=2)
        situation.order(s1=4)
        made = decide(situation, situation.make(FrequencyAge))
        assert [order for order, _ in made] == [0, 1]


class TestWhichStation:
    def test_least_busy(self, situation) -> None:
        """Open orders 2 and 0: 1, 1 (then 2 and 2 are equal: the first), and so on."""
        for _ in range(2):
            situation.assigned(station=0, s3=1)
        for _ in range(4):
            situation.order(s0=1)
        made = decide(situation, situation.make(FirstCome, station="least-busy"))
        assert [station for _, station in made] == [1, 1, 0, 1]

    def test_most_busy(self, situation) -> None:
        """Station 1 has the only open order: it is filled up first."""
        situation.assigned(station=1, s3=1)
        for _ in range(5):
            situation.order(s0=1)
        made = decide(situation, situation.make(FirstCome, station="most-busy"))
        assert [station for _, station in made] == [1, 1, 1, 0, 0]

    def test_random_reaches_all_stations(self, situation) -> None:
        situation.order(s0=1)
        controller = situation.make(FirstCome)
        assert {next(controller.decide()).station for _ in range(50)} == {0, 1}

    def test_the_last_station_again_while_it_has_a_slot(self, situation) -> None:
        for _ in range(8):
            situation.order(s0=1)
        made = decide(situation, situation.make(RandomOrder, stick_to_station=True))
        stations = [station for _, station in made]
        assert stations in ([0] * 4 + [1] * 4, [1] * 4 + [0] * 4)

    def test_the_last_station_keeps_its_slot_for_the_fast_lane(self, situation) -> None:
        """Three of four slots, at either station."""
        for _ in range(8):
            situation.order(s0=1)
        controller = situation.make(FirstCome, stick_to_station=True, fast_lane=True)
        stations = [station for _, station in decide(situation, controller)]
        assert stations in ([0] * 3 + [1] * 3, [1] * 3 + [0] * 3)

    def test_the_fast_lane_comes_first(self, situation) -> None:
        """Pod 0 at station 0 completes order 3 (due 5) before order 2; the older order 1 does not
        fit there and goes to a normal slot."""
        situation.assigned(s0=1)
        situation.carry(robot=0, pod=0)
        situation.order(due_s=1.0, s1=1)
        situation.order(due_s=9.0, s0=1)
        situation.order(due_s=5.0, s0=1)
        controller = situation.make(FirstCome, fast_lane=True)
        assert next(controller.decide()) == (situation.world.orders.orders[3], 0)


class TestWorkload:
    def test_fewest_open_orders(self, situation) -> None:
        """Open orders 2 and 0: station 1 gets the first two, then both get one, in any order."""
        for _ in range(2):
            situation.assigned(station=0, s3=1)
        for _ in range(4):
            situation.order(s0=1)
        made = decide(situation, situation.make(Workload))
        assert [order for order, _ in made] == [2, 3, 4, 5]
        assert [station for _, station in made[:2]] == [1, 1]
        assert sorted(station for _, station in made[2:]) == [0, 1]

    def test_most_open_orders(self, situation) -> None:
        situation.assigned(station=1, s3=1)
        for _ in range(4):
            situation.order(s0=1)
        made = decide(situation, situation.make(Workload, station="most-busy"))
        assert [station for _, station in made] == [1, 1, 1, 0]

    def test_ties_are_drawn(self, situation) -> None:
        situation.order(s0=1)
        controller = situation.make(Workload)
        assert {next(controller.decide()).station for _ in range(50)} == {0, 1}


class TestRelated:
    def test_skus_in_common(self, situation) -> None:
        """At station 0 one order wants SKU 0; at station 1 two do, and one of them SKU 1 as well.

        Order 3 (SKUs 0, 1) shares 1 at station 0 and 3 at station 1. Order 4 (SKU 2) shares none:
        station 0 has fewer open orders, 1 to 3. Order 5 (SKU 2) goes after it.
        """
        situation.assigned(station=0, s0=1)
        situation.assigned(station=1, s0=1)
        situation.assigned(station=1, s0=1, s1=1)
        for units in ({"s0": 1, "s1": 1}, {"s2": 1}, {"s2": 1}):
            situation.order(**units)
        assert decide(situation, situation.make(Related)) == [(3, 1), (4, 0), (5, 0)]

    def test_a_sku_that_is_picked_already_still_counts(self, situation) -> None:
        situation.assigned(station=1, s0=1, s1=1)
        situation.carry(robot=0, pod=0, station=1)
        situation.world.pick_unit(situation.world.robots[0].task)
        situation.order(s0=1)
        assert decide(situation, situation.make(Related)) == [(1, 1)]

    def test_ties(self, situation) -> None:
        """Nothing in common; open orders 0 and 1."""
        situation.assigned(station=1, s3=1)
        situation.order(s0=1)
        chosen = {
            tie: {
                next(situation.make(Related, tie_breaker=tie).decide()).station for _ in range(40)
            }
            for tie in ("least-busy", "most-busy", "random")
        }
        assert chosen == {"least-busy": {0}, "most-busy": {1}, "random": {0, 1}}


class TestNearBestPod:
    @pytest.fixture
    def wide(self) -> Situation:
        """Pods at x = 0 ... 9, stations at x = 0 and x = 10."""
        return Situation(small_layout(places=12, pods=10, pick_stations=2))

    def rule(self, situation: Situation):
        return situation.make(NearBestPod, metric="euclidean")

    def test_the_pod_with_most_units_of_the_order(self, wide) -> None:
        """Pod 1 has two of the three units, pod 8 all of them and is nearer to station 1."""
        wide.stock(1, s0=2)
        wide.stock(8, s0=2, s1=5)
        wide.order(s0=2, s1=1)
        assert decide(wide, self.rule(wide)) == [(0, 1)]

    def test_more_than_the_order_wants_counts_for_nothing(self, wide) -> None:
        """Pods 2 and 8 both have the one unit: pod 2 is at 2 from x = 0, pod 8 at 2 from x = 10.

        The distances are equal, so the station with the lowest number gets the order.
        """
        wide.stock(2, s0=1)
        wide.stock(8, s0=9)
        wide.order(s0=1)
        assert decide(wide, self.rule(wide)) == [(0, 0)]

    def test_any_of_the_best_pods(self, wide) -> None:
        """Pods 4 and 9 are equally good; pod 9 is nearest to a station: 1 from x = 10."""
        wide.stock(4, s0=1)
        wide.stock(9, s0=1)
        wide.order(s0=1)
        assert decide(wide, self.rule(wide)) == [(0, 1)]

    def test_pods_on_robots_do_not_count(self, wide) -> None:
        """Pod 9 is at station 1 with two units, pod 0 in storage with one."""
        wide.stock(9, s0=3)
        wide.stock(0, s0=1)
        wide.assigned(station=1, s0=1)
        wide.carry(robot=0, pod=9, station=1)
        wide.order(s0=2)
        assert decide(wide, self.rule(wide)) == [(1, 0)]

    def test_without_such_a_pod_the_least_busy_station(self, wide) -> None:
        """All stock is on pod 9, which is carried; station 0 has two open orders, station 1 one."""
        wide.stock(9, s0=5)
        for station in (0, 0, 1):
            wide.assigned(station=station, s0=1)
        wide.carry(robot=0, pod=9, station=1)
        wide.order(s0=1)
        assert decide(wide, self.rule(wide)) == [(3, 1)]
