"""PSA rules in small situations, the answers worked out by hand."""

from __future__ import annotations

import pytest
from doubles import Situation, small_layout

from rmfs.control.psa.nearest import Nearest
from rmfs.control.psa.random import RandomPlace


@pytest.fixture
def situation() -> Situation:
    """Places at x = 0 to 7, pods on 0 to 3; robot 0 with pod 1 at station 1, (10, 10)."""
    made = Situation(small_layout(places=8, pods=4, pick_stations=2))
    made.carry(robot=0, pod=1, station=1)
    made.world.end_task(made.world.robots[0])
    return made


def test_nearest_by_travel_time(situation) -> None:
    """Empty are 1 and 4 to 7; x = 7 is nearest to x = 10."""
    assert situation.make(Nearest).place(situation.world.robots[0]) == 7


def test_nearest_leaves_out_places_that_robots_keep(situation) -> None:
    situation.world.start_rest(situation.world.robots[1], 7)
    assert situation.make(Nearest).place(situation.world.robots[0]) == 6


def test_nearest_of_equals_is_the_first(situation) -> None:
    """Station 0 is at x = 0; a robot there finds 1 before 4. All times equal: also 1."""
    robot = situation.world.robots[0]
    robot.waypoint = situation.world.stations[0].waypoint
    controller = situation.make(Nearest)
    assert controller.place(robot) == 1
    controller._times[robot.waypoint][:] = 3.0
    assert controller.place(robot) == 1


def test_random_takes_any_empty_place(situation) -> None:
    controller = situation.make(RandomPlace)
    places = {controller.place(situation.world.robots[0]) for _ in range(100)}
    assert places == {1, 4, 5, 6, 7}


@pytest.mark.parametrize("rule", [Nearest, RandomPlace])
def test_no_empty_place(rule) -> None:
    """Two places: pod 0 on one, a robot rests on the other."""
    situation = Situation(small_layout(places=2, pods=1))
    situation.world.start_rest(situation.world.robots[1], 1)
    assert situation.make(rule).place(situation.world.robots[0]) == -1
