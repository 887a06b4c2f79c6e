"""Orders still to come: drawn from those that have come, and only ever a reason to prefer a pod."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from doubles import Situation, small_layout
from test_planning_control import pods, said

import rmfs
from rmfs.control.decisions import AssignOrder
from rmfs.control.problems import Trigger
from rmfs.random import Stream, generator
from rmfs.solvers.control.planning import PlanningControl
from rmfs.solvers.control.planning.expected import ExpectedOrders
from rmfs.world.orders import Order


def past(situation: Situation, number: int, **units: int) -> Order:
    """An order that came and has long been picked."""
    skus = tuple(int(sku[1:]) for sku in units)
    return Order.of(number, situation.world.now_s, 0.0, skus, tuple(units.values()))


def test_as_many_are_drawn_as_came_and_of_those_that_came() -> None:
    situation = Situation()
    situation.stock(0, s1=5, s2=5)
    expected = ExpectedOrders(situation.view, generator(0, Stream.CONTROLLERS))
    situation.world.now_s = 10.0
    assert expected.draw(100.0, 3) == [[], [], []]  # none has come: no rate is known
    for number in range(20):
        expected.hear(past(situation, number, **({"s1": 2} if number % 4 else {"s2": 1})))
    situation.world.now_s = 100.0
    scenarios = expected.draw(100.0, 400)
    counts = [len(orders) for orders in scenarios]
    assert np.mean(counts) == pytest.approx(20, abs=4 * np.sqrt(20 / 400))
    lines = [(o.lines[0].sku, o.lines[0].open_units) for orders in scenarios for o in orders]
    assert set(lines) == {(1, 2), (2, 1)}
    assert lines.count((2, 1)) / len(lines) == pytest.approx(0.25, abs=0.02)


def test_what_the_stock_cannot_serve_is_not_expected() -> None:
    situation = Situation()
    situation.stock(0, s1=5)
    expected = ExpectedOrders(situation.view, generator(0, Stream.CONTROLLERS))
    for number in range(20):
        expected.hear(past(situation, number, s2=1))
    situation.world.now_s = 100.0
    assert expected.draw(100.0, 2) == [[], []]


def control_with_history(situation: Situation, expected_s: float) -> Any:
    """A controller in whose past SKU 2 was ordered often."""
    control = situation.make(PlanningControl, expected_s=expected_s, horizon_s=500.0)
    for number in range(30):
        control.hear(Trigger.NEW_ORDER, past(situation, 1000 + number, s2=1))
    situation.world.now_s = 100.0
    return control


@pytest.mark.parametrize(("expected_s", "sent"), [(0.0, 0), (300.0, 1)])
def test_of_two_pods_the_one_with_what_is_often_ordered_is_sent(expected_s, sent) -> None:
    """Both pods serve the order, the first is nearer; the second also holds SKU 2."""
    situation = Situation(small_layout(robots=1))
    way_s = situation.view.travel.to(situation.world.pick_stations[0].waypoint, loaded=True)
    near, far = np.argsort(way_s[situation.world.storage.pod_waypoint], kind="stable")[:2].tolist()
    situation.stock(near, s1=5)
    situation.stock(far, s1=5, s2=5)
    situation.order(s1=1)
    found = said(situation, control_with_history(situation, expected_s))
    assert pods(found) == [(near, far)[sent]]
    assert sum(isinstance(decision, AssignOrder) for decision in found) == 1


def test_no_pod_is_sent_for_orders_that_have_not_come() -> None:
    situation = Situation()
    situation.stock(0, s1=5)
    situation.stock(1, s2=5)
    situation.order(s1=1)
    assert pods(said(situation, control_with_history(situation, 300.0))) == [0]


def test_a_run_with_expected_orders_repeats_and_goes_on_from_a_copy() -> None:
    given = {"layout.robots": 4, "scenario.duration_s": 900, "controllers.ta.expected_s": 300}

    def simulation(**more: Any) -> rmfs.Simulation:
        return rmfs.Simulation("small", "small-arrivals", "planning", set={**given, **more}, seed=2)

    once, again = simulation(), simulation()
    once.run_until(500.0)
    fork = once.fork()
    for one in (once, again, fork):
        one.run()
    runs = [one.result().footprint for one in (once, again, fork)]
    plain = simulation(**{"controllers.ta.expected_s": 0})
    plain.run()
    without = plain.result().footprint
    columns = ["units_picked", "distance_m", "orders_completed", "pick_visits"]
    assert runs[0][columns].equals(runs[1][columns])
    assert runs[0][columns].equals(runs[2][columns])
    assert not runs[0][columns].equals(without[columns])
