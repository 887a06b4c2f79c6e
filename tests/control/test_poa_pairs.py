"""POA rules that score pairs of station and order, answers worked out by hand."""

from __future__ import annotations

import pytest
from assigning import assign as decide
from assigning import stocked
from doubles import Situation

from rmfs.control.candidates import candidates_for
from rmfs.control.poa.foresight import Foresight
from rmfs.control.poa.linear import Linear
from rmfs.control.poa.lines_in_common import LinesInCommon
from rmfs.control.poa.wave import Wave
from rmfs.control.problems import Problem
from rmfs.control.questions import Question


@pytest.fixture
def situation() -> Situation:
    """Two stations, four pods; see `stocked`."""
    return stocked()


class TestLinesInCommon:
    def test_the_pair_with_most_lines_in_common(self, situation) -> None:
        """Two orders at station 1 want SKU 0, one at station 0 wants SKU 1.

        Order 3 (SKU 1): 1 at station 0. Order 4 (SKUs 0, 1): 1 and 2. Order 5 (SKU 2): 0.
        Order 4 goes to station 1; order 3 then has 1 at both: station 0; order 5 has 0: station 0.
        """
        situation.assigned(station=1, s0=5)
        situation.assigned(station=1, s0=1)
        situation.assigned(station=0, s1=1)
        for units in ({"s1": 1}, {"s0": 1, "s1": 1}, {"s2": 1}):
            situation.order(**units)
        assert decide(situation, situation.make(LinesInCommon)) == [(4, 1), (3, 0), (5, 0)]

    def test_ties_go_by_due_time_then_by_arrival_then_to_the_first_station(self, situation) -> None:
        """Nothing in common: due at 9, 5 and 5; an order just assigned counts for the next.

        Order 1 to station 0; order 2 has nothing in common (SKU 1) and goes to station 0 too; order
        0 (SKU 2) as well.
        """
        for due_s, units in ((9.0, {"s2": 1}), (5.0, {"s0": 1}), (5.0, {"s1": 1})):
            situation.order(due_s, **units)
        assert decide(situation, situation.make(LinesInCommon)) == [(1, 0), (2, 0), (0, 0)]

    def test_first_come_ties(self, situation) -> None:
        for due_s in (9.0, 5.0):
            situation.order(due_s, s0=1)
        controller = situation.make(LinesInCommon, tie_breaker="first-come")
        assert [order for order, _ in decide(situation, controller)] == [0, 1]

    def test_the_fast_lane_is_off_unless_wished(self, situation) -> None:
        """Eight slots, or six without those kept."""
        for _ in range(9):
            situation.order(s0=1)
        assert len(decide(situation, situation.make(LinesInCommon))) == 8
        for station in situation.world.pick_stations:
            station.slots += 4
        for _ in range(9):
            situation.order(s1=1)
        assert len(decide(situation, situation.make(LinesInCommon, fast_lane=True))) == 6


class TestLinear:
    def test_orders_without_a_short_sku_are_in_stock(self, situation) -> None:
        """Station 0 wants 12 units of SKU 0, of which there are 10: 2 are missing.

        Order 1 (SKU 1) and order 2 (SKUs 1 and 2) can be served all the same; order 3 cannot.
        """
        situation.assigned(station=0, s0=12)
        for units in ({"s1": 1}, {"s1": 1, "s2": 1}, {"s0": 1}):
            situation.order(**units)
        found = candidates_for(situation.view, Question(Problem.POA, "turn")).columns
        assert found["order"].tolist() == [1, 1, 2, 2, 3, 3]
        assert found["in_stock"].tolist() == [1, 1, 1, 1, 0, 0]
        made = decide(situation, situation.make(Linear, fast_lane=False))
        assert sorted(order for order, _ in made) == [1, 2]


class TestForesight:
    def inbound(self, situation: Situation, robot: int, pod: int, station: int) -> None:
        """Let a pod be fetched for one unit of the SKU of its number."""
        situation.assigned(station=station, **{f"s{pod}": 1})
        situation.world.start_pick(situation.world.robots[robot], pod, station)

    def test_matches_first_then_due_time(self, situation) -> None:
        """Pod 0 comes to station 0 with nine units to spare, pod 1 to station 1 with nine.

        Order 2 wants 3 of SKU 0 (3 at station 0), order 3 two of SKU 1 (2 at station 1), order 4
        two of SKU 0, due earlier than order 3: 3, then of the two with 2 the one due first.
        """
        self.inbound(situation, 0, 0, 0)
        self.inbound(situation, 1, 1, 1)
        situation.order(due_s=99.0, s0=3)
        situation.order(due_s=50.0, s1=2)
        situation.order(due_s=20.0, s0=2)
        assert decide(situation, situation.make(Foresight)) == [(2, 0), (4, 0), (3, 1)]

    def test_ties_go_to_the_station_with_most_free_slots(self, situation) -> None:
        """No matches, the same due time: station 1 has four free slots, station 0 three.

        Then both have three: station 0; then station 1 has more again. Orders in order of arrival.
        """
        situation.assigned(station=0, s3=1)
        for _ in range(3):
            situation.order(s0=1)
        assert decide(situation, situation.make(Foresight)) == [(1, 1), (2, 0), (3, 1)]

    def test_the_bonus_for_depletion(self, situation) -> None:
        """Pod 0 has nine units left. Order 1 wants eight: 8. Order 2 wants nine: 9 + 1.

        Order 3 wants three of SKU 1, of which nothing comes: 0.
        """
        self.inbound(situation, 0, 0, 0)
        situation.order(s0=8)
        situation.order(s0=9)
        situation.order(s1=3)
        controller = situation.make(Foresight, score="depletion")
        scores = controller._scores("depletion", situation.world.pick_stations)
        assert scores.tolist() == [[8, 10, 0], [0, 0, 0]]

    def test_the_bonus_for_surplus(self, situation) -> None:
        """Pod 0 comes with nine units of SKU 0, pod 1 with nine of SKU 1 and four of SKU 2.

        Order 2 wants nine of SKU 0: 9, and 1 because pod 0 alone has them. Order 3 wants six of
        SKU 2 as well: 4 more, without bonus. When an order for two of SKU 0 is assigned, only
        seven are left to spare: 7 + 1 and 7 + 1 + 4.
        """
        situation.stock(1, s2=4)
        self.inbound(situation, 0, 0, 0)
        self.inbound(situation, 1, 1, 0)
        situation.order(s0=9)
        situation.order(s0=9, s2=6)
        controller = situation.make(Foresight)
        stations = situation.world.pick_stations[:1]
        assert controller._scores("surplus", stations).tolist() == [[10, 14]]
        situation.assigned(station=0, s0=2)
        assert controller._scores("surplus", stations)[0, :2].tolist() == [8, 12]

    def test_an_order_that_stock_cannot_serve_waits(self, situation) -> None:
        situation.order(s0=11)
        situation.order(s0=1)
        assert decide(situation, situation.make(Foresight)) == [(1, 0)]

    def test_due_time_may_come_first(self, situation) -> None:
        """Order 1 matches pod 0, order 2 is due earlier."""
        self.inbound(situation, 0, 0, 0)
        situation.order(due_s=50.0, s0=1)
        situation.order(due_s=20.0, s1=1)
        controller = situation.make(Foresight, score="due-time", tie_breaker="matches")
        assert decide(situation, controller) == [(2, 1), (1, 0)]


class TestWave:
    def coming(self, situation: Situation) -> Situation:
        """Pod 0 is on its way to station 0 for an order that wants one unit of its ten."""
        situation.assigned(station=0, s0=1)
        situation.world.start_pick(situation.world.robots[0], 0, 0)
        situation.world.now_s = 100.0
        return situation

    def test_wave_by_wave_and_within_it_by_pod_match(self, situation) -> None:
        """Due at 900: orders 1 (SKU 1) and 2 (SKU 0, on the pod that comes); at 500: order 3."""
        self.coming(situation)
        for due_s, units in ((900.0, {"s1": 1}), (900.0, {"s0": 1}), (500.0, {"s2": 1})):
            situation.order(due_s, **units)
        made = decide(situation, situation.make(Wave, fast_lane=False))
        assert [order for order, _ in made] == [3, 2, 1]

    def test_orders_due_about_then_are_of_the_same_wave(self, situation) -> None:
        """Order 2, due 60 s after order 1, has a pod that comes: it is of the wave or not."""
        self.coming(situation)
        for due_s, units in ((500.0, {"s1": 1}), (560.0, {"s0": 1})):
            situation.order(due_s, **units)
        for wave_s, first in ((59.0, 1), (60.0, 2)):
            controller = situation.make(Wave, fast_lane=False, wave_s=wave_s)
            assert next(iter(controller.decide())).order.index == first

    def test_who_missed_the_truck_comes_first_or_last(self, situation) -> None:
        """Order 1 is late, order 2 is not, order 3 later still."""
        self.coming(situation)
        for due_s in (50.0, 500.0, 900.0):
            situation.order(due_s, s1=1)
        assert next(iter(situation.make(Wave).decide())).order.index == 1
        controller = situation.make(Wave, fast_lane=False, missed_last=True)
        assert [order for order, _ in decide(situation, controller)] == [2, 3, 1]

    def test_a_wave_that_stock_cannot_serve_does_not_hold_up_the_next(self, situation) -> None:
        situation.order(300.0, s0=11)
        situation.order(900.0, s1=1)
        assert [order for order, _ in decide(situation, situation.make(Wave))] == [1]
