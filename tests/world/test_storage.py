"""Places, claims and keepers."""

from __future__ import annotations

import pytest
from doubles import Situation, small_layout


@pytest.fixture
def situation() -> Situation:
    """Six places, pods on 0 to 3, robots 0 and 1 in the aisle."""
    return Situation(small_layout(places=6, pods=4, robots=2))


def test_at_the_start_all_pods_are_at_hand_and_the_other_places_empty(situation) -> None:
    storage = situation.world.storage
    assert storage.is_at_hand.tolist() == [True] * 4
    assert storage.is_empty.tolist() == [False] * 4 + [True] * 2
    assert storage.is_restful.tolist() == [True] * 4 + [False] * 2


def test_a_claimed_pod_is_not_at_hand_and_cannot_be_claimed_twice(situation) -> None:
    storage = situation.world.storage
    storage.claim(2, robot=0)
    assert storage.is_at_hand.tolist() == [True, True, False, True]
    assert not storage.is_restful[2]
    with pytest.raises(ValueError, match="claimed by robot 0"):
        storage.claim(2, robot=1)
    version = storage.version
    storage.release(2)
    assert storage.is_at_hand[2]
    assert storage.version == version + 1


def test_a_place_frees_only_when_its_robot_has_departed(situation) -> None:
    """After the lift the place holds no pod, but the robot is still on it."""
    world, storage = situation.world, situation.world.storage
    robot = world.robots[0]
    world.start_pick(robot, pod=1, station=0)
    storage.keep(robot, 1)
    robot.waypoint = 1
    world.lift(robot, 1)
    assert not storage.is_empty[1]
    robot.waypoint = 8
    assert not storage.departed(robot, rest=1)  # no plan that leaves yet
    assert not storage.is_empty[1]
    assert storage.departed(robot, rest=8)
    assert storage.is_empty[1]


def test_an_idle_robot_beneath_a_pod_leaves_it_at_hand_a_busy_one_does_not(situation) -> None:
    world, storage = situation.world, situation.world.storage
    robot = world.robots[0]
    world.start_rest(robot, 3)
    assert storage.is_at_hand[3]
    assert not storage.is_restful[3]
    world.start_pick(robot, pod=0, station=0)
    assert not storage.is_at_hand[3]
    robot.waypoint = 0
    storage.departed(robot, rest=0)
    assert storage.is_at_hand[3]


def test_an_idle_robot_on_a_place_without_pod_keeps_others_from_parking_there(situation) -> None:
    world, storage = situation.world, situation.world.storage
    world.start_rest(world.robots[0], 5)
    assert storage.is_empty.tolist() == [False] * 4 + [True, False]
    with pytest.raises(ValueError, match="kept by robot 0"):
        storage.keep(world.robots[1], 5)


def test_a_pod_is_set_down_only_where_none_stands(situation) -> None:
    world = situation.world
    robot = world.robots[0]
    world.start_pick(robot, pod=1, station=0)
    world.lift(robot, 1)
    with pytest.raises(ValueError, match="pod 0 is already stored"):
        world.set_down(robot, 0)
    with pytest.raises(ValueError, match="holds pod 0"):
        world.start_park(robot, 0)


def test_nothing_can_be_written_into_the_arrays_handed_out(situation) -> None:
    world = situation.world
    for array in (world.inventory.contained, world.storage.is_empty, world.need):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1
