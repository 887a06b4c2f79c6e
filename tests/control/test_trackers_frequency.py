"""How often SKUs are ordered."""

from __future__ import annotations

import pytest
from doubles import Situation, rules

from rmfs import layout, scenario
from rmfs.control.problems import Trigger
from rmfs.control.trackers.frequency import Frequency, PairFrequency
from rmfs.control.view import View
from rmfs.scenario import OrderContent
from rmfs.simulation.kernel import Kernel
from rmfs.simulation.past import PAST_ORDERS

PAST = (OrderContent((0, 1), (2, 1), 0.0, 0), OrderContent((1,), (1,), 0.0, 0))


@pytest.fixture
def situation() -> Situation:
    """Five SKUs; in the past 2 units of SKU 0 and 2 of SKU 1, once together."""
    made = Situation()
    made.view = View(made.world, made.view.travel, draw_past_orders=lambda: PAST)
    return made


def test_units_ordered_in_the_past_and_since(situation) -> None:
    """A tracker made late has missed nothing; that units are picked changes nothing."""
    situation.stock(0, s2=9)
    situation.order(s0=1, s2=3)
    tracker = situation.view.trackers.get(Frequency)
    assert tracker.units.tolist() == [3, 2, 3, 0, 0]
    situation.assigned(s2=3)
    situation.carry(robot=0, pod=0)
    situation.world.pick_unit(situation.world.robots[0].task)
    assert tracker.units.tolist() == [3, 2, 6, 0, 0]
    assert tracker.share.tolist() == [0.5, 2 / 6, 1.0, 0.0, 0.0]


def test_shares_without_any_order() -> None:
    assert Situation().view.trackers.get(Frequency).share.tolist() == [0.0] * 5


def test_pairs(situation) -> None:
    """SKUs 0 and 1 together: once in the past, once in the backlog, once now; 0 and 2: once now.

    The last number stands for "no SKU".
    """
    situation.order(s0=5, s1=1)
    tracker = situation.view.trackers.get(PairFrequency)
    tracker.hear(Trigger.NEW_ORDER, situation.order(s1=1, s0=1, s2=1))
    assert tracker.orders_with(0).tolist() == [0, 3, 1, 0, 0, 0]
    assert tracker.orders_with(2).tolist() == [1, 1, 0, 0, 0, 0]
    assert tracker.orders_with(4).tolist() == [0] * 6


class TestInARun:
    def simulation(self, seed: int = 0, **tables) -> Kernel:
        plan = layout.load("default", [(["robots"], 4)])
        work = scenario.load("default", [(["duration_s"], 300.0), (["warmup_s"], 0.0)])
        return Kernel(plan, work, rules(**tables), seed=seed)

    def test_pairs_are_counted_as_orders_come(self) -> None:
        simulation = self.simulation(rps={"name": "correlative"})
        tracker = simulation.view.trackers.get(PairFrequency)
        before = sum(sum(tracker.orders_with(sku)) for sku in range(1000))
        orders = []
        told = simulation.events.order_created
        simulation.events.order_created = lambda order: (orders.append(order), told(order))
        simulation.run()
        pairs = sum(len(order.lines) * (len(order.lines) - 1) for order in orders)
        assert len(orders) >= 200
        assert sum(sum(tracker.orders_with(sku)) for sku in range(1000)) == before + pairs

    def test_past_orders_depend_on_the_seed_and_change_nothing_else(self) -> None:
        """Two runs, one of which looks at its past orders before: the same backlog at the end."""
        one, other = self.simulation(), self.simulation()
        assert len(one.view.past_orders) == PAST_ORDERS
        assert one.view.past_orders == other.view.past_orders
        assert one.view.past_orders != self.simulation(seed=1).view.past_orders
        third = self.simulation()
        for simulation in (one, third):
            simulation.run()
        contents = [
            [[(line.sku, line.units) for line in order.lines] for order in run.world.orders]
            for run in (one, third)
        ]
        assert contents[0] == contents[1]
