"""Extract requests: open, bound, fulfilled."""

from __future__ import annotations

import pytest
from doubles import Situation

from rmfs.world import verify


@pytest.fixture
def situation() -> Situation:
    made = Situation()
    made.stock(0, s0=5, s1=2)
    made.stock(1, s0=1)
    return made


def test_requests_are_bound_first_come_first_served(situation) -> None:
    """Pod 1 has one unit of SKU 0: the order that was assigned first gets it."""
    first = situation.assigned(s0=2)
    second = situation.assigned(s0=1)
    task = situation.world.start_pick(situation.world.robots[0], pod=1, station=0)
    assert [pick.line.order for pick in task.picks] == [first]
    assert (first.open_units, second.open_units) == (1, 1)
    assert situation.world.need[0, 0] == 2
    verify(situation.world)


def test_a_task_binds_all_it_can_serve(situation) -> None:
    """Pod 0 serves both lines of the first order and what the second wants of SKU 0."""
    situation.assigned(s0=2, s1=1)
    situation.assigned(s0=1, s2=1)
    task = situation.world.start_pick(situation.world.robots[0], pod=0, station=0)
    assert sorted(pick.line.sku for pick in task.picks) == [0, 0, 0, 1]
    assert situation.world.inventory.available[:, 0].tolist() == [2, 1, 0, 0, 0]
    assert situation.world.inventory.inbound[0].tolist() == [2, 1, 0, 0, 0]
    verify(situation.world)


def test_late_units_are_marked(situation) -> None:
    situation.assigned(s0=1)
    task = situation.world.start_pick(situation.world.robots[0], pod=0, station=0)
    situation.assigned(s0=2)
    assert situation.world.extend_pick(task, 0) == 2
    assert [pick.late_bound for pick in task.picks] == [False, True, True]


def test_uncommitted_stock_counts_each_unit_once(situation) -> None:
    """6 units of SKU 0, 2 wanted in the backlog, 1 open, 1 bound: 2 left, also after the pick."""
    world = situation.world
    situation.order(s0=2)
    situation.assigned(s0=1)
    task = world.start_pick(world.robots[0], pod=1, station=0)
    situation.assigned(s0=1)
    assert world.inventory.uncommitted[0] == 2
    assert world.inventory.free_stock[0] == 4
    world.lift(world.robots[0], 1)
    world.pick_unit(task)
    assert world.inventory.uncommitted[0] == 2
    verify(world)


def test_a_full_station_takes_no_order(situation) -> None:
    for _ in range(4):
        situation.assigned(s0=1)
    order = situation.order(s0=1)
    with pytest.raises(ValueError, match="takes no order"):
        situation.world.assign_order(order, 0)


def test_an_order_with_units_missing_is_not_complete(situation) -> None:
    order = situation.assigned(s0=1)
    with pytest.raises(ValueError, match="lacks 1 units"):
        situation.world.complete_order(order)


def test_a_pod_takes_no_promise_beyond_its_capacity(situation) -> None:
    """Pod 0 holds 7 of 100 space units."""
    bundle = situation.bundle(units=94)
    with pytest.raises(ValueError, match="no room"):
        situation.world.promise(bundle, 0)
    situation.world.promise(situation.bundle(units=93), 0)
    verify(situation.world)


def test_a_bundle_is_assigned_when_pod_and_station_are_decided_in_either_order(situation) -> None:
    world = situation.world
    one, other = situation.bundle(), situation.bundle()
    world.promise(one, 2)
    assert not world.release_bundles(2)
    assert world.choose_station(one, 1)
    assert not world.choose_station(other, 1)
    world.promise(other, 3)
    assert world.release_bundles(3) == [other]
    assert len(world.bundles) == 0
    assert world.bundles_waiting[0].tolist() == [0, 0, 1, 1]
    verify(world)
