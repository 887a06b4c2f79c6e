"""Who is sent where, and who has to make room."""

from __future__ import annotations

from hand_made import HandMade

from rmfs.control.decisions import BringForPicks
from rmfs.control.problems import Problem
from rmfs.control.ta.balanced import Balanced
from rmfs.traffic import Step


class ToRobot0(Balanced):
    """Gives all pick work to one robot, whoever rests beneath the pod."""

    chosen = 0

    def looks_elsewhere(self):
        return True

    def _fetch(self, robot, consult):
        if robot.index != self.chosen or not self.view.has_open_work(0):
            return None
        pod = consult.pod_for(robot, 0)
        return BringForPicks(robot, pod, 0) if pod >= 0 else None


class ToRobot1(ToRobot0):
    chosen = 1


def test_a_robot_at_rest_makes_room_for_the_one_that_comes_for_the_pod() -> None:
    """Places 0 to 2, pods 0 and 1. Robot 0 rests beneath pod 1, robot 1 beneath pod 0.

    At 100 s robot 0 is to fetch pod 0: robot 1 is sent to the empty place 2 first, in the same
    instant, and only then robot 0 to place 0.
    """
    made = HandMade(
        {"robots": 2, "places": 3, "pods": 2}, ta={"name": f"{__name__}:ToRobot0", "period_s": 0.0}
    )
    made.stock(0, s0=1)
    made.order(at_s=100.0, s0=1)
    diary = made.run()
    robots = made.world.robots
    at_100 = [command for command in made.traffic.commands if command[0] == 100_000_000]
    assert at_100 == [
        (100_000_000, 1, [(Step.DRIVE, 2)]),
        (100_000_000, 0, [(Step.DRIVE, 0), (Step.LIFT, 0), (Step.STATION, 0)]),
    ]
    assert diary.of("complete")
    assert robots[1].places == [2]


def test_nobody_is_sent_to_a_place_that_another_robot_keeps() -> None:
    """The only place is that of pod 0. Robot 0 rests there and robot 1, in the aisle, gets the job.

    Robot 0 has nowhere to go, so robot 1 is not sent. (`check` refuses a layout so small.)
    """
    made = HandMade(
        {"robots": 2, "places": 1, "pods": 1}, ta={"name": f"{__name__}:ToRobot1", "period_s": 0.0}
    )
    made.stock(0, s0=1)
    made.order(at_s=100.0, s0=1)
    diary = made.run()
    assert diary.of("pick") == [(100.0, "pick", 1, 0)]
    assert not [steps for _, robot, steps in made.traffic.commands if robot == 1]


def test_a_robot_on_its_way_to_rest_can_be_given_a_task() -> None:
    """Robot 0 sets out to rest at 0 s and is 2 m away when the order comes, half a second later."""
    made = HandMade({"robots": 1})
    made.stock(0, s0=1)
    made.order(at_s=0.5, s0=1)
    made.run()
    first, second = made.traffic.commands[:2]
    assert first[2] == [(Step.DRIVE, 3)]
    assert second[0] == 500_000
    assert second[2][0] == (Step.DRIVE, 0)
    assert made.simulation.controller_set[Problem.TA] is not None
    assert made.world.orders_completed == 1


def test_a_pod_serves_another_station_before_it_is_stored() -> None:
    """Pick stations at (0, 10) and (10, 10); the pod goes on from the first to the second."""
    made = HandMade(
        {"robots": 2, "pick_stations": 2, "replenishment_stations": 1, "slots": 1},
        ta={"other_stations": True, "search_radius_m": 20.0, "period_s": 0.0},
    )
    made.stock(0, s0=2)
    made.order(s0=1)
    made.order(at_s=12.0, s0=1)
    diary = made.run()
    assert [(station, pod) for _, _, station, pod in diary.of("arrive")] == [(0, 0), (1, 0)]
    assert len(diary.of("set down")) == 1
