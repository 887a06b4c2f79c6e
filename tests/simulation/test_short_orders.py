"""Orders that stock cannot serve: they wait, lose what is not there, or are given up."""

from __future__ import annotations

import numpy as np
import pytest
from doubles import Situation
from hand_made import HandMade

import rmfs
from rmfs.errors import InputError
from rmfs.measure.dictionary import reproducible
from rmfs.observer import Observer
from rmfs.world.verify import verify

GIVEN = {
    "layout.robots": 6,
    "scenario.warmup_s": 300.0,
    "scenario.duration_s": 2400.0,
    "scenario.stock.initial_share": 0.3,
    "scenario.replenishment": {"mode": "poisson", "bundles_per_h": 10.0, "initial_bundles": 5},
}


class Watch(Observer):
    """Checks the books of the world whenever an order is cut or given up, and keeps them."""

    def run_started(self, run):
        self.run, self.cut, self.gone = run, [], []

    def order_cut(self, order):
        verify(self.run.world)
        assert order in self.run.world.orders
        self.cut.append((order, self.run.world.now_s))

    def order_cancelled(self, order):
        verify(self.run.world)
        assert order not in self.run.world.orders
        self.gone.append((order, self.run.world.now_s))


def ran(policy, controllers="default", **changes):
    watch = Watch()
    given = GIVEN | changes
    if policy is not None:
        given |= {"scenario.orders.shortage": {"policy": policy, "after_s": 600.0}}
    run = rmfs.simulate(
        "small", "small-arrivals", controllers, seed=3, set=given, observers=[watch]
    )
    return run, watch


def test_waiting_is_what_happens_without_the_table():
    columns = reproducible("footprint")
    without, waiting = (ran(policy)[0].footprint[columns] for policy in (None, "wait"))
    assert without.equals(waiting)


@pytest.mark.parametrize(
    "controllers", ["default", "planning", "planning-split", "pile-on", "pile-on-split"]
)
@pytest.mark.parametrize("policy", ["cancel", "partial"])
def test_books_are_right_whoever_decides(policy, controllers):
    run, watch = ran(policy, controllers)
    verify(run.world)
    orders = run.table("orders").set_index("order")
    footprint = run.footprint
    gone = orders["cancelled_s"].notna()
    assert footprint["orders_cancelled"] == gone.sum() > 0
    assert {order.index for order, at_s in watch.gone if at_s >= 300.0} == set(orders.index[gone])
    assert orders.loc[gone, ["assigned_s", "completed_s"]].isna().all(axis=None)
    # looked at 600 s after they came, or after twice as long, and so on
    waited = (orders["cancelled_s"] - orders["created_s"])[gone]
    assert (waited / 600.0).to_numpy() == pytest.approx(np.round(waited / 600.0), abs=1e-6)
    partly = orders["completed_s"].notna() & (orders["units_cut"] > 0)
    assert footprint["orders_partial"] == partly.sum()
    assert (partly.sum() > 0) == (policy == "partial")
    lost = orders["units_cut"][gone | orders["completed_s"].notna()].sum()
    assert footprint["units_not_delivered"] == lost >= gone.sum()


def test_those_given_up_are_not_on_time_and_wait_no_longer():
    run, _ = ran("cancel")
    orders = run.table("orders")
    gone, done = orders["cancelled_s"].notna(), orders["completed_s"].notna()
    overdue = ~gone & ~done & (orders["due_s"] < 2700.0)
    in_time = done & (orders["completed_s"] <= orders["due_s"])
    footprint = run.footprint
    assert footprint["on_time_share"] == pytest.approx(
        in_time.sum() / (gone | done | overdue).sum()
    )
    assert footprint["orders_overdue_end"] == overdue.sum()
    waiting = ~gone & orders["assigned_s"].isna()
    assert footprint["backlog_orders_end"] == waiting.sum() == len(run.world.orders)


def test_who_is_stuck_is_told_where_orders_wait():
    run, watch = ran("wait")
    assert not watch.gone and not watch.cut
    footprint, world = run.footprint, run.world
    free = world.inventory.free_stock
    stuck = [o for o in world.orders if any(free[line.sku] < line.units for line in o.lines)]
    assert footprint["orders_stuck_end"] == len(stuck) > 0
    assert footprint["oldest_stuck_end_s"] == 2700.0 - min(order.created_s for order in stuck)


class TestCut:
    def test_part_of_an_order_is_left(self):
        situation = Situation()
        situation.stock(0, s1=2)
        older, order, newer = (situation.order(s1=3, s2=1) for _ in range(3))
        situation.world.cut_order(order, {1: 2})
        verify(situation.world)
        assert [(line.sku, line.units) for line in order.lines] == [(1, 2)]
        assert order.units_cut == 2
        assert order.cancelled_s != order.cancelled_s
        assert list(situation.world.orders) == [older, order, newer]

    def test_nothing_left_is_given_up(self):
        situation = Situation()
        order = situation.order(s1=3)
        situation.world.cut_order(order, {1: 0})
        verify(situation.world)
        assert order.cancelled_s == situation.world.now_s
        assert order not in situation.world.orders

    def test_an_order_at_a_station_keeps_what_it_has(self):
        situation = Situation()
        situation.stock(0, s1=5)
        with pytest.raises(ValueError, match="cannot lose units"):
            situation.world.cut_order(situation.assigned(s1=1), {})


def test_another_policy_is_refused_in_a_line():
    with pytest.raises(InputError, match="shortage"):
        ran("never")


@pytest.mark.parametrize("policy", ["cancel", "partial"])
def test_a_fork_gives_up_the_same_orders(policy):
    """Orders of a fork are its own: it goes on as the original does."""
    run = rmfs.Simulation(
        "small",
        "small-arrivals",
        "default",
        seed=3,
        set=GIVEN | {"scenario.orders.shortage": {"policy": policy, "after_s": 300.0}},
    )
    run.run_until(700.0)
    fork = run.fork()
    run.run()
    fork.run()
    columns = reproducible("footprint")
    original, forked = run.result().footprint[columns], fork.result().footprint[columns]
    assert forked.equals(original)
    assert original["units_not_delivered"] > 0


JOINT = {"poa": {"name": "dummy"}, "pps": {"name": "dummy"}}


@pytest.mark.parametrize(
    "rules",
    [
        {},
        {"poa": {"name": "queue"}},
        {"poa": {"name": "pile-on"}, "pps": {"name": "dummy"}},
        {**JOINT, "ta": {"name": "pile-on"}},
        {**JOINT, "ta": {"name": "planning"}},
    ],
    ids=["default", "queue", "poa pile-on", "ta pile-on", "planning"],
)
def test_an_order_that_can_now_be_served_is_assigned_at_once(rules):
    """It lacks SKU 1 and is cut at 51 s; nothing else ever happens in this warehouse."""
    made = HandMade(
        {"robots": 1}, {"orders": {"shortage": {"policy": "partial", "after_s": 50.0}}}, **rules
    )
    made.stock(0, s0=1)
    made.order(1.0, s0=1, s1=1)
    made.run()
    (order,) = made.ledger.orders.values()
    assert (order.assigned_s, order.units_cut) == (51.0, 1)
    assert order.completed_s < 100.0
