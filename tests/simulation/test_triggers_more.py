"""When SA, MM and repositioning are asked, and when robots at rest are given work.

Table 1 of the paper is in `test_triggers`.

Distances as in `test_service`.
"""

from __future__ import annotations

import pytest
from hand_made import HandMade
from test_triggers import Logged, times

from rmfs.control.base import NoParameters
from rmfs.control.decisions import Exchange, SwitchStation
from rmfs.control.mm import MethodManagement
from rmfs.control.problems import Problem, Trigger
from rmfs.control.repositioning import Move, Pauses, Pausing
from rmfs.control.sa import StationActivation
from rmfs.control.settings import settings
from rmfs.control.ta.balanced import Balanced

HERE = __name__


class Switches(Logged, StationActivation[NoParameters]):
    """All stations are on but from 100 to 200 s."""

    def decide(self):
        self.note()
        on = not 100 <= self.view.now_s < 200
        for station in self.view.stations:
            if station.active != on:
                yield SwitchStation(station.index, on)

    def next_event_s(self):
        return next((at_s for at_s in (100.0, 200.0) if at_s > self.view.now_s), float("inf"))


class EagerSwitches(Switches):
    subscriptions = frozenset({Trigger.ORDER_COMPLETED})


class Once(Logged, MethodManagement[NoParameters]):
    """Installs PSA random at 50 s."""

    def decide(self):
        self.note()
        if self.view.now_s == 50.0:
            table = {"format": "rmfs-controllers/1", "name": "x", "psa": {"name": "random"}}
            yield Exchange(settings(table).choices[Problem.PSA])

    def next_event_s(self):
        return 50.0 if self.view.now_s < 50.0 else float("inf")


class Twice(Logged, Pausing[Pauses]):
    """Moves pod 1 to place 5, and later back; between moves and searches it pauses."""

    parameters_model = Pauses

    def find(self, robot):
        self.note()
        moves = {1: 5, 5: 1}
        moved = self.asked.setdefault("moved", [])
        if len(moved) == 2 or not self.view.storage.is_at_hand[1]:
            return None
        moved.append(self.view.now_s)
        return Move(1, moves[self.view.storage.place_of[1]])


class Ta(Logged, Balanced):
    pass


@pytest.fixture(autouse=True)
def asked() -> dict[str, list[float]]:
    Logged.asked = {}
    return Logged.asked


def one_pick(**problems) -> HandMade:
    """An order for a unit of pod 0 at 10 s; two robots."""
    made = HandMade(
        {"robots": 2, "places": 6, "pods": 2},
        {"duration_s": 300.0},
        ta={"name": "balanced", "period_s": 0.0},
        **problems,
    )
    made.stock(0, s0=2)
    made.order(at_s=10.0, s0=1)
    return made


def test_sa_at_the_start_and_when_it_wishes(asked) -> None:
    made = one_pick(sa={"name": f"{HERE}:Switches"})
    states = []
    for at_s in (0.5, 99.0, 150.0, 250.0):
        made.at(at_s, lambda: states.append(made.world.stations[0].active))
    made.run()
    assert asked["sa"] == [0.0, 100.0, 200.0]
    assert states == [True, True, False, True]


def test_sa_after_what_it_subscribed_to(asked) -> None:
    diary = one_pick(sa={"name": f"{HERE}:EagerSwitches"}).run()
    assert asked["sa"] == sorted([0.0, 100.0, 200.0, *times(diary, "complete")])


def test_a_station_that_is_off_finishes_what_it_has_and_gets_nothing_new() -> None:
    """The order of 10 s is on the station at 12 s, when it is switched off; that of 20 s waits
    until it is on again, at 200 s."""
    made = one_pick(sa={"name": f"{HERE}:Switches"})
    made.at(12.0, lambda: switch(made, False))
    made.order(at_s=20.0, s0=1)
    diary = made.run()
    first, second = (entry[0] for entry in diary.of("complete"))
    assert first < 100
    assert made.ledger.orders[1].assigned_s == 200.0
    assert second > 200


def switch(made: HandMade, active: bool) -> None:
    for station in made.world.stations:
        station.active = active


def test_a_replenishment_station_that_is_off_finishes_what_it_has() -> None:
    """A bundle is assigned at 0 s; its station is switched off at 1 s, and the bundle is stored."""
    made = HandMade(
        {"robots": 1, "places": 6, "pods": 2},
        {"duration_s": 300.0},
        rps={"name": "random", "buffer_threshold": 0.0},
        roa={"name": "random"},
    )
    made.bundle()
    made.at(1.0, lambda: switch(made, False))
    made.bundle(at_s=2.0)
    made.run()
    assert made.world.bundles_stored == 1
    assert len(made.world.bundles.without_station) == 1


def test_mm_at_the_start_and_when_it_wishes(asked) -> None:
    made = one_pick(mm={"name": f"{HERE}:Once"})
    names = []
    for at_s in (49.0, 51.0):
        made.at(at_s, lambda: names.append(made.simulation.deciding.statistics[Problem.PSA].name))
    made.run()
    assert asked["mm"] == [0.0, 50.0]
    assert names == ["nearest", "random"]


def test_repositioning_is_asked_for_robots_that_would_rest(asked) -> None:
    """At 0 s both robots have nothing to do. Robot 0 moves pod 1 to place 5; for robot 1 there is
    nothing, and nobody asks again before 20 s, when the pause after that ends.

    Robot 0 goes 3 m, lifts (2 s), carries it 4 m, sets it down (2 s): 11 s, still in the pause; at
    20 s it is asked about and moves the pod back; at 40 s there is nothing more to move, and so
    every 20 s.
    """
    made = HandMade(
        {"robots": 2, "places": 6, "pods": 2},
        {"duration_s": 100.0},
        ta={"name": "balanced", "period_s": 0.0},
        repositioning={"name": f"{HERE}:Twice", "robot_pause_s": 15.0, "search_pause_s": 20.0},
    )
    diary = made.run()
    assert times(diary, "reposition") == asked["moved"] == [0.0, 20.0]
    assert diary.of("set down") == [(11.0, "set down", 1, 5), (entry_s(diary, 1), "set down", 1, 1)]
    assert asked["repositioning"][:2] == [0.0, 0.0]
    assert set(asked["repositioning"][2:]) <= {20.0, 40.0, 60.0, 80.0, 100.0}


def entry_s(diary, number: int) -> float:
    return diary.of("set down")[number][0]


def test_a_robot_at_rest_is_asked_about_when_there_is_work(asked) -> None:
    """TA balanced at the start, at 10 s (an order on the station), when the pod was served and when
    it was set down (a robot needs a task, and the pod is at hand again)."""
    made = HandMade(
        {"robots": 1, "places": 6, "pods": 2},
        {"duration_s": 300.0},
        ta={"name": f"{HERE}:Ta", "period_s": 0.0},
    )
    made.stock(0, s0=2)
    made.order(at_s=10.0, s0=1)
    diary = made.run()
    assert sorted(set(asked["ta"])) == [0.0, 10.0, *times(diary, "park"), *times(diary, "set down")]
    assert times(diary, "pick") == [10.0]


@pytest.mark.parametrize(
    "tables",
    [
        {"ta": {"name": "balanced"}},
        {"ta": {"name": "constant-ratio", "pick_share": 1.0}},
        {"ta": {"name": "random"}, "pps": {"name": "dummy"}},
        {"ta": {"name": "brute-force"}, "pps": {"name": "dummy"}, "psa": {"name": "dummy"}},
        {"ta": {"name": "swarm", "rest_share": 1.0}},
    ],
    ids=lambda tables: tables["ta"]["name"],
)
def test_every_ta_rule_wakes_robots_for_new_work(tables) -> None:
    """Robots rest when an order comes at 100 s: a robot is given the task at that instant."""
    made = HandMade({"robots": 2, "places": 6, "pods": 2}, {"duration_s": 300.0}, **tables)
    made.stock(0, s0=2)
    made.order(at_s=100.0, s0=1)
    diary = made.run()
    assert times(diary, "pick") == [100.0]
    assert made.world.orders_completed == 1
