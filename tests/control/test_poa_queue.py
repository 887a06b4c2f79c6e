"""POA queue in small situations, the answers worked out by hand."""

from __future__ import annotations

import numpy as np
import pytest
from doubles import Situation, small_layout

from rmfs.control.decisions import QueueOrder
from rmfs.control.poa.contest import Contest
from rmfs.control.poa.criteria import (
    Completable,
    DueSoon,
    DueTime,
    FirstCome,
    FirstWave,
    InboundMatches,
    Random,
    Related,
    Size,
    Weight,
    best,
)
from rmfs.control.poa.queue import Queue


def decide(situation: Situation, controller) -> list[tuple[str, int, int]]:
    """Apply all decisions, as the simulation does; returns "queue" or "assign", order, station."""
    made = []
    for decision in controller.decide():
        order, station = decision
        if isinstance(decision, QueueOrder):
            if station < 0:
                situation.world.unqueue_order(order)
            else:
                situation.world.queue_order(order, station)
            made.append(("queue", order.index, station))
        else:
            situation.world.assign_order(order, station)
            made.append(("assign", order.index, station))
    return made


def assigned(made: list[tuple[str, int, int]]) -> list[tuple[int, int]]:
    return [(order, station) for what, order, station in made if what == "assign"]


@pytest.fixture
def situation(monkeypatch) -> Situation:
    """Two pick stations with four slots; SKU k on pod k at x = k, ten units each.

    The small warehouse has no ways: distances are along the axes, so from pod k in storage to
    station 0 it is 10 + k m.
    """
    made = Situation(small_layout(pods=4, pick_stations=2, slots=4))
    travel = made.view.travel

    def distances_to(waypoint, metric, *, loaded=True):
        return travel.manhattan_metres(waypoint, np.arange(made.layout.waypoints))

    monkeypatch.setattr(travel, "distances_to", distances_to)
    for pod in range(4):
        made.stock(pod, **{f"s{pod}": 10})
    return made


def contest(situation: Situation, *, for_pool: bool = False) -> Contest:
    """All orders of the backlog, for station 0."""
    rows = np.arange(len(situation.world.orders))
    return Contest.of(situation.view, situation.world.pick_stations[0], rows, for_pool=for_pool)


def fetch(situation: Situation, robot: int, pod: int, station: int = 0, **units: int) -> None:
    """Let a pod be fetched for a new order on the station."""
    situation.assigned(station=station, **units)
    situation.world.start_pick(situation.world.robots[robot], pod, station)


class TestCriteria:
    def score(self, situation: Situation, criterion, **contest_for: bool) -> list[float]:
        return criterion.score(contest(situation, **contest_for), situation.rng).tolist()

    def test_simple_ones(self, situation) -> None:
        """At 100 s: orders due at 650, 800 and 50; the first 600 s from now end at 700 s."""
        situation.world.now_s = 100.0
        situation.order(650.0, s0=2)
        situation.order(800.0, s0=1, s1=4)
        situation.order(50.0, s0=3)
        assert self.score(situation, FirstCome()) == [0, -1, -2]
        assert self.score(situation, DueTime()) == [-650, -800, -50]
        assert self.score(situation, DueSoon()) == [1, 0, 1]
        assert self.score(situation, DueSoon(within_s=0.0)) == [0, 0, 1]
        assert self.score(situation, FirstWave()) == [1, 0, 1]  # the first truck, and who is late
        assert self.score(situation, FirstWave(wave_s=150.0)) == [1, 1, 1]
        situation.world.orders.weight[1] = 3.0
        assert self.score(situation, Weight()) == [1, 3, 1]
        assert self.score(situation, Size()) == [2, 5, 3]
        assert self.score(situation, Size(count="lines")) == [1, 2, 1]
        assert len(set(self.score(situation, Random()))) == 3

    def test_completable_by_the_nearest_pod(self, situation) -> None:
        """Pods 0 (10 m) and 1 (11 m) come, each with nine units; one more of SKU 0 is claimed.

        Pod 0 completes eight of SKU 0, not nine, nor anything with SKU 1.
        """
        fetch(situation, 0, 0, s0=1)
        fetch(situation, 1, 1, s1=1)
        situation.assigned(s0=1)
        for units in ({"s0": 8}, {"s0": 9}, {"s0": 1, "s1": 1}):
            situation.order(**units)
        assert self.score(situation, Completable()) == [True, False, False]

    def test_completable_by_all_pods(self, situation) -> None:
        """As above: together they complete the third as well, but not one with SKU 2."""
        fetch(situation, 0, 0, s0=1)
        fetch(situation, 1, 1, s1=1)
        situation.assigned(s0=1)
        for units in ({"s0": 8}, {"s0": 9}, {"s0": 1, "s1": 1}, {"s2": 1}):
            situation.order(**units)
        scores = self.score(situation, Completable(by="all-pods"))
        assert scores == [True, False, True, False]

    def test_nothing_is_completable_without_pods(self, situation) -> None:
        situation.order(s0=1)
        assert self.score(situation, Completable()) == [False]
        assert self.score(situation, Completable(by="all-pods")) == [False]

    def test_an_order_to_which_another_pod_is_bound_is_not_completed_by_the_nearest(
        self, situation
    ) -> None:
        """Order 1 is queued; pod 1 is bound to its line of SKU 1, pod 0 could do the rest."""
        order = situation.order(s0=1, s1=1)
        situation.world.queue_order(order, 0)
        fetch(situation, 1, 1, s3=1)
        task = situation.world.pick_stations[0].tasks[1]
        assert situation.world.extend_queued(task, order, whole=False) == 1
        fetch(situation, 0, 0, s0=1)
        assert self.score(situation, Completable()) == [False]
        assert self.score(situation, Completable(by="all-pods")) == [True]

    def test_an_order_bound_to_the_nearest_pod_is_completed_by_it(self, situation) -> None:
        order = situation.order(s0=9)
        situation.world.queue_order(order, 0)
        fetch(situation, 0, 0, s0=1)
        task = situation.world.pick_stations[0].tasks[0]
        assert situation.world.extend_queued(task, order, whole=True) == 9
        assert self.score(situation, Completable()) == [True]

    def test_inbound_matches(self, situation) -> None:
        """Pods 0 (10 m) and 1 (11 m) come with nine units of SKU 0 and of SKU 1; pod 1 also has two
        of SKU 0. Near is up to 10 unit metres; there are two pods.

        Order 2: one unit of SKU 0 from pod 0, 10 unit metres: 2 points.
        Order 3: two units from pod 0, 20 unit metres: 1.
        Order 4: ten of SKU 0, nine from pod 0 and one from pod 1 (11): 1 + 1.
        Order 5: one each of SKUs 0 and 1: 2 + 1.
        Order 6: SKU 2, which no pod has: 0. (RAWSim-O gives 2 + 1.)
        """
        situation.stock(1, s0=2)
        fetch(situation, 0, 0, s0=1)
        fetch(situation, 1, 1, s1=1)
        for units in ({"s0": 1}, {"s0": 2}, {"s0": 10}, {"s0": 1, "s1": 1}, {"s2": 1}):
            situation.order(**units)
        assert self.score(situation, InboundMatches(), for_pool=True) == [2, 1, 2, 3, 0]

    def test_units_claimed_by_others_do_not_match(self, situation) -> None:
        """Nine units of SKU 0 come: eight are for an order on a slot, and one for one in the pool.

        For the pool nothing is left of them; for a slot, one unit is.
        """
        fetch(situation, 0, 0, s0=1)
        situation.assigned(s0=8)
        situation.world.queue_order(situation.order(s0=1), 0)
        situation.order(s0=1)
        assert self.score(situation, InboundMatches(), for_pool=True)[1] == 0
        assert self.score(situation, InboundMatches(), for_pool=False)[1] == 1

    def test_related(self, situation) -> None:
        """In the pool SKU 0 is wanted, on slots SKU 1.

        Order 2 (SKUs 0, 2): half of its lines are in the pool, none on a slot. Order 3 (SKU 1):
        none and all. Order 1 is in the pool itself.
        """
        situation.assigned(s1=1)
        situation.world.queue_order(situation.order(s0=1), 0)
        situation.order(s0=1, s2=1)
        situation.order(s1=1)
        assert self.score(situation, Related(), for_pool=True)[1:] == [0.5, 0.0]
        assert self.score(situation, Related(), for_pool=False) == [0.0, 0.0, 1.0]

    def test_one_criterion_after_the_other(self, situation) -> None:
        """Sizes 2, 3, 3, 3: order 0 is out; due at 9, 5 and 5: order 1 is out; then by arrival."""
        for due_s, units in ((1.0, 2), (9.0, 3), (5.0, 3), (5.0, 3)):
            situation.order(due_s, s0=units)
        found = best([contest(situation)], (Size(), DueTime()), situation.rng)
        assert found is not None
        assert found[1] == 2

    def test_equal_pairs_go_to_the_first_station(self, situation) -> None:
        situation.order(s0=1)
        both = [
            Contest.of(situation.view, station, np.array([0]), for_pool=True)
            for station in situation.world.pick_stations
        ]
        found = best(both, (Size(),), situation.rng)
        assert found is not None
        assert found[0].station.index == 0


class TestPools:
    def test_orders_join_the_pool_for_which_most_comes(self, situation) -> None:
        """Pod 1 comes to station 1 with nine units of SKU 1.

        Orders 2 and 3 (both SKU 1) match for pool 1, and order 2 is due first: it takes all nine.
        Then no order matches: order 3 is related to pool 1; order 1 (SKU 0) to none: pool 0.
        """
        fetch(situation, 1, 1, station=1, s1=1)
        for due_s, units in ((9.0, {"s0": 1}), (5.0, {"s1": 9}), (9.0, {"s1": 1})):
            situation.order(due_s, **units)
        for station in situation.world.pick_stations:
            station.slots = 0
        made = decide(situation, situation.make(Queue))
        assert made == [("queue", 2, 1), ("queue", 3, 1), ("queue", 1, 0)]

    def test_pools_have_a_length(self, situation) -> None:
        """Two pools of one order: the two that are due first."""
        for station in situation.world.pick_stations:
            station.slots = 0
        for due_s in (9.0, 5.0, 7.0):
            situation.order(due_s, s0=1)
        made = decide(situation, situation.make(Queue, queue_length=1))
        assert made == [("queue", 1, 0), ("queue", 2, 1)]

    def test_an_order_that_stock_cannot_serve_joins_no_pool(self, situation) -> None:
        situation.order(s0=11)
        assert decide(situation, situation.make(Queue)) == []

    def test_a_station_switched_off_has_no_pool(self, situation) -> None:
        """Its orders leave it, and join the other."""
        situation.world.queue_order(situation.order(s0=1), 0)
        situation.world.pick_stations[0].active = False
        made = decide(situation, situation.make(Queue))
        assert made == [("queue", 0, -1), ("queue", 0, 1), ("assign", 0, 1)]

    def test_pools_are_filled_up_when_orders_have_left_them(self, situation) -> None:
        """Six orders, pools of one: each order gets a slot, three at a station, via its pool."""
        for _ in range(7):
            situation.order(s0=1)
        made = decide(situation, situation.make(Queue, queue_length=1))
        assert len(assigned(made)) == 6
        assert [what for what, *_ in made].count("queue") == 7


class TestSlots:
    def test_stations_take_turns(self, situation) -> None:
        """Pool 0 has orders 0, 1 and 2, pool 1 has order 3; all slots but one are free."""
        for station in (0, 0, 0, 1):
            situation.world.queue_order(situation.order(s0=1), station)
        made = decide(situation, situation.make(Queue))
        assert assigned(made) == [(0, 0), (3, 1), (1, 0), (2, 0)]

    def test_orders_due_soon_come_first(self, situation) -> None:
        """Due at 900, 550 and 500 s: the last two are due within 600 s, the earlier arrival wins.

        Nothing is completable, so criteria two and three are equal for all.
        """
        for due_s in (900.0, 550.0, 500.0):
            situation.world.queue_order(situation.order(due_s, s0=1), 0)
        made = decide(situation, situation.make(Queue))
        assert [order for order, _ in assigned(made)] == [1, 2, 0]

    def test_then_orders_that_the_nearest_pod_completes(self, situation) -> None:
        """Pod 0 comes with nine of SKU 0: order 2 before order 1; all are due late."""
        fetch(situation, 0, 0, s0=1)
        for sku in ("s1", "s0"):
            situation.world.queue_order(situation.order(9e5, **{sku: 1}), 0)
        made = decide(situation, situation.make(Queue))
        assert [order for order, _ in assigned(made)] == [2, 1]

    def test_one_slot_is_kept_for_the_fast_lane(self, situation) -> None:
        for number in range(8):
            situation.world.queue_order(situation.order(s0=1), number % 2)
        assert len(assigned(decide(situation, situation.make(Queue)))) == 6
        assert len(assigned(decide(situation, situation.make(Queue, fast_lane=False)))) == 2

    @pytest.fixture
    def served(self, situation) -> Situation:
        """Pod 0 stands at station 0, nine units of SKU 0 to spare; one slot of four is free."""
        for _ in range(2):
            situation.assigned(s3=1)
        situation.assigned(s0=1)
        situation.carry(robot=0, pod=0)
        situation.world.pick_stations[1].active = False
        return situation

    def test_the_fast_lane_takes_the_largest_order_of_the_pool(self, served) -> None:
        """In the pool: orders 3 (2 units), 4 (3) and 5 (10, but one of them of SKU 1)."""
        for units in ({"s0": 2}, {"s0": 3}, {"s0": 9, "s1": 1}):
            served.world.queue_order(served.order(**units), 0)
        assert assigned(decide(served, served.make(Queue))) == [(4, 0)]

    def test_an_order_bound_to_the_pod_is_completed_by_it(self, served) -> None:
        """All nine units are bound to order 3 of the pool: it takes the slot, not order 4."""
        robot = served.world.robots[0]
        robot.station = -1
        order = served.order(s0=9)
        served.world.queue_order(order, 0)
        served.world.extend_queued(robot.task, order, whole=True)
        robot.station = 0
        served.world.queue_order(served.order(s0=1), 0)
        assert assigned(decide(served, served.make(Queue))) == [(3, 0)]
        assert [pick.line.order.index for pick in robot.task.picks].count(3) == 9

    def test_if_the_pool_has_none_any_other_order(self, served) -> None:
        """The pool holds one order, for SKU 1; order 4 is in no pool, and the pod completes it."""
        served.world.queue_order(served.order(s1=1), 0)
        served.order(s0=1)
        made = decide(served, served.make(Queue, queue_length=1))
        assert made == [("assign", 4, 0)]

    def test_an_order_of_another_pool_is_left_there(self, served) -> None:
        served.world.pick_stations[1].active = True
        served.world.pick_stations[1].slots = 0
        served.world.queue_order(served.order(s0=1), 1)
        assert decide(served, served.make(Queue)) == []
