"""Controllers are asked at exactly the events of the paper's table 1, those they subscribed to, and
the times they named themselves. Distances as in `test_service`.
"""

from __future__ import annotations

from typing import Any, ClassVar

import pytest
from hand_made import HandMade

from rmfs.control.poa.order_rules import RandomOrder
from rmfs.control.pps.random import RandomPod as AnyPod
from rmfs.control.problems import Problem, Trigger
from rmfs.control.psa.random import RandomPlace
from rmfs.control.roa.random import RandomStation
from rmfs.control.rps.random import RandomPod
from rmfs.control.settings import settings
from rmfs.control.ta.balanced import Balanced

HERE = __name__


class Logged:
    """Remembers when it was asked."""

    asked: ClassVar[dict[str, list[float]]] = {}

    def note(self) -> None:
        times = Logged.asked.setdefault(str(self.problem), [])
        times.append(self.view.now_s)

    def decide(self, *consult: Any):
        self.note()
        yield from super().decide(*consult)


class Poa(Logged, RandomOrder):
    pass


class EagerPoa(Poa):
    subscriptions = frozenset({Trigger.POD_AT_STATION})


class PunctualPoa(Poa):
    def next_event_s(self) -> float:
        return 100.0 if self.view.now_s < 100.0 else float("inf")


class Roa(Logged, RandomStation):
    pass


class Rps(Logged, RandomPod):
    pass


class Ta(Logged, Balanced):
    pass


class Pps(Logged, AnyPod):
    def pick_pod(self, robot, station):
        self.note()
        return super().pick_pod(robot, station)

    def replenishment_pod(self, robot, station):
        self.note()
        return super().replenishment_pod(robot, station)


class Psa(Logged, RandomPlace):
    def place(self, robot):
        self.note()
        return super().place(robot)


@pytest.fixture(autouse=True)
def asked() -> dict[str, list[float]]:
    Logged.asked = {}
    return Logged.asked


def scripted(**problems: Any) -> HandMade:
    """One pick and one replenishment, 600 s.

    At 10 s an order of two units; robot 0 fetches pod 0 (it rests beneath it or comes there). At
    200 s a bundle, released at 500 s by its time-out.
    """
    tables: dict[str, Any] = {
        "poa": {"name": f"{HERE}:Poa"},
        "roa": {"name": f"{HERE}:Roa"},
        "rps": {"name": f"{HERE}:Rps", "buffer_timeout_s": 300.0, "buffer_threshold": 1.0},
        "pps": {"name": f"{HERE}:Pps"},
        "psa": {"name": f"{HERE}:Psa"},
        "ta": {"name": f"{HERE}:Ta", "period_s": 0.0, "pick_weight": 1.0},
    }
    made = HandMade({"robots": 2, "places": 3, "pods": 1}, **(tables | problems))
    made.stock(0, s0=2)
    made.order(at_s=10.0, s0=2)
    made.bundle(at_s=200.0)
    return made


def times(diary, *kinds: str) -> list[float]:
    return [entry[0] for entry in diary.of(*kinds)]


def test_table_1(asked) -> None:
    """START is at 0; the order is completed, the bundle stored, and so on, as the diary says.

    A robot needs a task when its pod has been served (then it parks it) and when it has set it
    down. TA balanced subscribed to new work at a station (10 s, 500 s) and to pods that come to
    hand (set down).
    """
    made = scripted()
    diary = made.run()
    picked, completed, stored = (
        times(diary, "unit"),
        times(diary, "complete"),
        times(diary, "store"),
    )
    assert len(picked) == 2
    assert len(stored) == 1
    assert asked["poa"] == sorted([0.0, 10.0, *completed, *stored])
    assert asked["roa"] == [0.0, 200.0, *stored]
    assert asked["rps"] == [0.0, *picked, 200.0, 500.0]
    served, free = times(diary, "park"), times(diary, "set down")
    assert set(asked["ta"]) == {0.0, 10.0, 500.0, *served, *free}


def test_pps_and_psa_are_asked_by_ta(asked) -> None:
    """PPS once per empty robot that is to be given work, PSA once per pod to be parked."""
    made = scripted(ta={"name": "balanced", "period_s": 0.0, "pick_weight": 1.0})
    diary = made.run()
    assert asked["psa"] == times(diary, "park")
    assert set(times(diary, "pick", "replenish")) <= set(asked["pps"])


def test_subscriptions(asked) -> None:
    made = scripted(poa={"name": f"{HERE}:EagerPoa"})
    diary = made.run()
    assert set(times(diary, "arrive")) <= set(asked["poa"])


def test_a_time_it_named(asked) -> None:
    scripted(poa={"name": f"{HERE}:PunctualPoa"}).run()
    assert 100.0 in asked["poa"]


def chosen(problem: Problem, name: str):
    table = {"format": "rmfs-controllers/1", "name": "x", problem: {"name": name}}
    return settings(table).choices[problem]


def test_a_controller_that_others_consult_can_be_exchanged(asked) -> None:
    """PSA is asked twice: first the old rule, then the new one, which TA reaches all the same."""
    made = scripted(ta={"name": "balanced", "period_s": 0.0, "pick_weight": 1.0})
    nearest = chosen(Problem.PSA, "nearest")
    made.at(300.0, lambda: made.simulation.phase.exchange(nearest))
    diary = made.run()
    assert len(times(diary, "park")) == 2
    assert len(asked["psa"]) == 1


def test_a_controller_with_triggers_can_be_exchanged(asked) -> None:
    """The new rule is asked when it is installed, then after its own triggers; the old one never.

    The bundle that the old RPS rule promised to a pod at 200 s is released by the new one, whose
    time-out ends at 400 s.
    """
    made = scripted(roa={"name": "random"}, rps={"name": "random", "buffer_timeout_s": 900.0})
    new = {"name": f"{HERE}:Rps", "buffer_timeout_s": 200.0, "buffer_threshold": 1.0}
    table = {"format": "rmfs-controllers/1", "name": "x", "rps": new}
    choice = settings(table).choices[Problem.RPS]
    made.at(300.0, lambda: made.simulation.phase.exchange(choice))
    diary = made.run()
    assert asked["rps"] == [300.0, 400.0]
    assert diary.of("replenish")[0][0] == 400.0
    assert made.simulation.deciding.statistics[Problem.RPS].name == new["name"]
