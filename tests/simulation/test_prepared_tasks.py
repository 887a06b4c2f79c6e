"""Tasks that TA prepares ahead: begun one after the other, or passed over."""

from __future__ import annotations

from hand_made import HandMade

from rmfs.control.base import NoParameters
from rmfs.control.decisions import BringForPicks, Park, Prepare, Reposition, Rest
from rmfs.control.problems import Problem
from rmfs.control.settings import settings
from rmfs.control.ta import TaskAllocation

HERE = __name__


class Ahead(TaskAllocation[NoParameters]):
    """Gives robot 0 everything at once, as soon as two orders are on the station."""

    asked = 0

    def tasks(self, robot):
        return (
            BringForPicks(robot, 0, 0),
            Park(robot, -1),
            BringForPicks(robot, 1, 0),
            Park(robot, 5),
            Reposition(robot, 2, 4),
            Rest(robot, 3),
        )

    def decide(self, consult):
        robot = self.view.robots[0]
        if not self.done and len(self.view.pick_stations[0].orders) == 2:
            self.done = True
            yield Prepare(robot, self.tasks(robot))
        Ahead.asked += robot.task is None

    done = False

    def rest_place(self, robot):
        return -1


class WithoutPod1(Ahead):
    """Robot 1 brings pod 1 to the station, and stays there with it."""

    def decide(self, consult):
        yield from super().decide(consult)
        if self.done and self.view.storage.is_at_hand[1]:
            yield BringForPicks(self.view.robots[1], 1, 0)


def made_with(ta: str) -> HandMade:
    """Pods 0 to 2 at places 0 to 2 of 6; order 0 wants SKU 0 of pod 0, order 1 SKU 1 of pod 1."""
    made = HandMade(
        {"robots": 2, "places": 6, "pods": 3},
        poa={"name": "random"},
        psa={"name": "nearest"},
        pps={"name": "random", "late_picks": False},
        ta={"name": f"{HERE}:{ta}"},
    )
    made.stock(0, s0=1)
    made.stock(1, s1=1)
    made.order(s0=1)
    made.order(s1=1)
    return made


def test_one_after_the_other_without_asking_again() -> None:
    """PSA is asked for the first parking place: 0 is nearest to the station at (0, 10).

    The rest place 3 keeps no other pod. After it nothing is left, and TA is not asked for robot 0.
    """
    Ahead.asked = 0
    made = made_with("Ahead")
    diary = made.run()
    kinds = [
        (entry[1], entry[3])
        for entry in diary.of("pick", "park", "reposition", "rest")
        if entry[2] == 0
    ]
    assert kinds == [
        ("pick", 0),
        ("park", -1),
        ("pick", 0),
        ("park", -1),
        ("reposition", -1),
        ("rest", -1),
    ]
    assert made.world.storage.place_of == [0, 5, 4]
    assert made.world.robots[0].waypoint == 3
    assert made.world.orders_completed == 2
    assert made.world.tasks_dropped == 0
    assert Ahead.asked == 1  # at the start, before there were orders


def test_what_is_impossible_is_passed_over() -> None:
    """Pod 1 is on robot 1 when its turn comes, so it is not fetched, and there is none to park.

    Robot 0 goes on to pod 2.
    """
    made = made_with("WithoutPod1")
    diary = made.run()
    kinds = [entry[1] for entry in diary.of("pick", "park", "reposition", "rest") if entry[2] == 0]
    assert kinds == ["pick", "park", "reposition", "rest"]
    assert made.world.tasks_dropped == 2
    assert made.world.robots[1].pod == 1
    assert made.world.storage.place_of[2] == 4


def test_work_that_was_done_otherwise_is_passed_over() -> None:
    """Pod 0 has a unit for order 1 as well, so that pod 1 has nothing to do at the station."""
    made = made_with("Ahead")
    made.stock(0, s1=1)
    diary = made.run()
    kinds = [entry[1] for entry in diary.of("pick", "park", "reposition", "rest") if entry[2] == 0]
    assert kinds == ["pick", "park", "reposition", "rest"]
    assert made.world.tasks_dropped == 2
    assert made.world.orders_completed == 2


class Changed(Ahead):
    """Says at once what robot 0 is to do instead."""

    def decide(self, consult):
        done = self.done
        yield from super().decide(consult)
        if self.done and not done:
            yield Prepare(self.view.robots[0], (Park(self.view.robots[0], 3),))


def test_the_last_word_counts() -> None:
    """Robot 0 has begun to fetch pod 0; all that was prepared after that is replaced."""
    made = made_with("Changed")
    diary = made.run()
    kinds = [entry[1] for entry in diary.of("pick", "park", "reposition", "rest") if entry[2] == 0]
    assert kinds == ["pick", "park"]
    assert made.world.storage.place_of[0] == 3


def test_a_new_ta_rule_starts_without_them() -> None:
    """At 5 s TA balanced takes over: what was prepared is forgotten, pod 0 is served and parked."""
    made = made_with("Ahead")
    table = {"format": "rmfs-controllers/1", "name": "x", "ta": {"name": "balanced"}}
    choice = settings(table).choices[Problem.TA]
    made.at(5.0, lambda: made.simulation.phase.exchange(choice))
    diary = made.run()
    assert not diary.of("reposition")
    assert made.world.orders_completed == 2
    assert made.world.tasks_dropped == 0
