"""Orders whose lines go to stations one after another, by hand."""

from __future__ import annotations

import pytest
from doubles import Situation, small_layout

from rmfs.world import verify


@pytest.fixture
def situation() -> Situation:
    """Two stations with two slots; pod 0 has all that is ordered."""
    made = Situation(small_layout(pick_stations=2, slots=2))
    made.stock(0, s1=9, s2=9, s3=9)
    return made


def pick_all(situation: Situation, robot: int = 0) -> None:
    """Pick what is bound to the pod a robot carries."""
    task = situation.world.robots[robot].task
    while task.picks:
        situation.world.pick_unit(task)


def test_a_part_takes_a_slot_and_the_rest_stays(situation: Situation) -> None:
    """Of lines 1, 2 and 3, the second goes to station 1."""
    world = situation.world
    order = situation.order(s1=1, s2=2, s3=3)
    part = world.assign_lines(order, 1, [2])
    assert [line.sku for line in part.lines] == [2]
    assert [line.sku for line in order.lines] == [1, 3]
    assert (part.open_units, order.open_units) == (2, 4)
    assert part.whole is order
    assert order in world.orders
    assert world.orders.units[0].tolist()[:2] == [1, 3]
    assert world.need[1].tolist() == [0, 0, 2, 0, 0]
    assert [station.free_slots for station in world.pick_stations] == [2, 1]
    assert sorted(line.sku for line in order.all_lines) == [1, 2, 3]
    verify(world)


def test_complete_with_the_last_part(situation: Situation) -> None:
    """Parts at both stations: the order is complete when the later one is."""
    world = situation.world
    order = situation.order(s1=1, s2=2)
    part = world.assign_lines(order, 1, [2])
    rest = world.assign_lines(order, 0, [1])
    assert rest is order
    assert order not in world.orders
    situation.carry(robot=0, pod=0, station=0)
    pick_all(situation)
    assert world.complete_order(order) is None
    assert world.orders_completed == 0
    world.end_task(world.robots[0])
    world.pick_stations[0].robot = -1
    world.start_pick(world.robots[0], 0, 1)
    pick_all(situation)
    world.now_s = 50.0
    assert world.complete_order(part) is order
    assert world.orders_completed == 1
    assert order.completed_s == 50.0
    verify(world, [order])


def test_not_complete_while_lines_wait(situation: Situation) -> None:
    """The only part is picked, one line is still in the backlog."""
    world = situation.world
    order = situation.order(s1=1, s2=2)
    part = world.assign_lines(order, 0, [1])
    situation.carry(robot=0, pod=0)
    pick_all(situation)
    assert world.complete_order(part) is None
    assert world.pick_stations[0].free_slots == 2
    assert order in world.orders
    verify(world)


def test_lines_join_the_part_that_is_there(situation: Situation) -> None:
    """Three lines one after another at one station take one slot, also if they are the last."""
    world = situation.world
    order = situation.order(s1=1, s2=2, s3=3)
    part = world.assign_lines(order, 0, [3])
    assert world.assign_lines(order, 0, [1]) is part
    assert world.assign_order(order, 0) is part
    assert world.pick_stations[0].free_slots == 1
    assert part.open_units == 6
    assert order not in world.orders
    situation.carry(robot=0, pod=0)
    pick_all(situation)
    assert world.complete_order(part) is order
    verify(world, [order, part])


def test_what_is_left_of_an_order_joins_its_part_out_of_the_pool(situation: Situation) -> None:
    """The rest was queued where the part is: it leaves the pool, and needs no slot."""
    world = situation.world
    order = situation.order(s1=1, s2=2)
    part = world.assign_lines(order, 0, [1])
    world.queue_order(order, 0)
    situation.assigned(s3=1)
    assert world.pick_stations[0].free_slots == 0
    assert world.assign_order(order, 0) is part
    assert not world.pick_stations[0].queued
    assert order not in world.orders
    verify(world)
    situation.carry(robot=0, pod=0)
    pick_all(situation)
    assert world.complete_order(part) is order
    verify(world, [order, part])


@pytest.mark.parametrize("bound", [1, 2])
def test_units_bound_to_a_pod_in_the_pool_join_the_part_as_well(
    situation: Situation, bound: int
) -> None:
    """A pod is on its way with one or both of the queued units: the part still lacks three."""
    world = situation.world
    order = situation.order(s1=1, s2=2)
    part = world.assign_lines(order, 0, [1])
    world.queue_order(order, 0)
    situation.stock(1, s2=bound)
    task = world.start_pick(world.robots[0], 1, 0)
    assert world.extend_queued(task, order, whole=False) == bound
    assert world.assign_order(order, 0) is part
    assert (part.open_units, part.unpicked_units) == (3 - bound, 3)
    assert (order.open_units, order.unpicked_units) == (0, 0)
    verify(world)


def test_times_and_lines_of_the_whole(situation: Situation) -> None:
    """Assigned with its first line."""
    world = situation.world
    order = situation.order(s1=1, s2=2)
    world.now_s = 7.0
    world.assign_lines(order, 0, [1])
    world.now_s = 9.0
    world.assign_lines(order, 1, [2])
    assert order.assigned_s == 7.0
    assert order.slots_taken == 2


def test_refused(situation: Situation) -> None:
    """No such line, no slot, no order of the backlog, a queued order."""
    world = situation.world
    order = situation.order(s1=1, s2=2)
    with pytest.raises(ValueError, match="these lines"):
        world.assign_lines(order, 0, [3])
    situation.assigned(s3=1)
    situation.assigned(s3=1)
    with pytest.raises(ValueError, match="takes no order"):
        world.assign_lines(order, 0, [1])
    world.queue_order(order, 1)
    with pytest.raises(ValueError, match="these lines"):
        world.assign_lines(order, 1, [1])
    world.unqueue_order(order)
    world.assign_order(order, 1)
    with pytest.raises(ValueError, match="these lines"):
        world.assign_lines(order, 1, [1])
    verify(world)
