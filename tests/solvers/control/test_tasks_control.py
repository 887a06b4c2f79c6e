"""TA and RPS by models in a small warehouse by hand."""

from __future__ import annotations

from typing import Any

import pytest
from doubles import Situation, small_layout

from rmfs.control.asks import Ask, Call, told_by
from rmfs.control.decisions import (
    BringForPicks,
    Park,
    PromiseBundle,
    ReleasePod,
    Rest,
    SendBundle,
)
from rmfs.control.pps.lexicographic import Lexicographic
from rmfs.control.problems import Problem
from rmfs.control.psa.nearest import Nearest
from rmfs.solvers.control.stocking import StockingControl
from rmfs.solvers.control.tasks.dispatch import DispatchControl
from rmfs.solvers.control.tasks.jobs import Worth, jobs
from rmfs.solvers.control.tasks.routes import RoutesControl


class Advice:
    """PPS lexicographic and PSA nearest."""

    def __init__(self, situation: Situation) -> None:
        self._view = situation.view
        self._pps = situation.make(Lexicographic)
        self._psa = situation.make(Nearest)

    def serves(self, pod: int, station: int) -> bool:
        return self._pps.serves(pod, station)

    def pod_for(self, robot: Any, station: int) -> int:
        return self._pps.pick_pod(robot, self._view.pick_stations[station])

    def place_for(self, robot: Any) -> int:
        return self._psa.place(robot)


def told(
    situation: Situation, control: Any, *, answer: bool = True
) -> tuple[list[Any], list[Call]]:
    """Ask a TA controller, answer its question, do what it says, and note it."""
    found: list[Any] = []
    calls: list[Call] = []
    advice, world = Advice(situation), situation.world
    for told in control.decide(advice):
        decision, _ = told_by(told, None)
        assert isinstance(decision, Ask)
        call = Call(0, Problem.TA, control, decision, 0, "")
        calls.append(call)
        if answer:
            call.answer = decision.solve(decision.question)
        for told_now in control.answered(call):
            said, _ = told_by(told_now, call)
            found.append(said)
            if isinstance(said, BringForPicks):
                world.start_pick(*said)
            elif isinstance(said, Park):
                world.start_park(*said)
            else:
                world.start_rest(*said)
            world.asking.pop(said.robot.index, None)
    return found, calls


def two_robots() -> Situation:
    """Robots at x = 0 and 5, pods with what is wanted at x = 1 and 4, one station at x = 0."""
    layout = small_layout(robots=6)
    situation = Situation(layout)
    for index in (1, 2, 3, 4):
        situation.world.start_rest(situation.world.robots[index], 6 + index)
        situation.world.resting.pop(index)
    for index in (0, 5):
        situation.world.asking[index] = situation.world.robots[index]
    situation.stock(1, s1=5)
    return situation


@pytest.mark.parametrize("control", [DispatchControl, RoutesControl])
@pytest.mark.parametrize("answer", [True, False], ids=["optimiser", "rule"])
def test_the_nearest_robot_brings_the_pod(control: type, answer: bool) -> None:
    """Robot 0 is a metre from pod 1, robot 5 four: by the model robot 0 goes, the other rests."""
    situation = two_robots()
    situation.assigned(s1=1)
    found, _ = told(situation, situation.make(control), answer=answer)
    brings = [decision for decision in found if isinstance(decision, BringForPicks)]
    assert [(b.robot.index, b.pod, b.station) for b in brings][:1] == [(0, 1, 0)]
    if answer:
        assert [d.robot.index for d in found if isinstance(d, Rest)] == [5]


@pytest.mark.parametrize("control", [DispatchControl, RoutesControl])
def test_no_work_is_rest_and_nothing_else(control: type) -> None:
    situation = two_robots()
    found, calls = told(situation, situation.make(control))
    assert len(calls) <= 1
    assert all(isinstance(decision, Rest) for decision in found)


@pytest.mark.parametrize("control", [DispatchControl, RoutesControl])
def test_a_carried_pod_is_served_again_or_parked(control: type) -> None:
    """At the head of the queue with another unit to give: again; with none: to a place."""
    for more, expected in ((0, [Park]), (1, [BringForPicks])):
        situation = Situation(small_layout(robots=1))
        situation.stock(1, s1=5)
        situation.assigned(s1=1)
        situation.carry(0, 1)
        robot = situation.world.robots[0]
        robot.task = None
        situation.world.asking[0] = robot
        if more:
            situation.assigned(s1=more)
        found, _ = told(situation, situation.make(control))
        assert [type(decision) for decision in found] == expected


def test_what_was_done_meanwhile_is_stale() -> None:
    """The robots have got other work before the answer comes."""
    situation = two_robots()
    situation.assigned(s1=1)
    control = situation.make(DispatchControl)
    (question,) = [d for d in control.decide(Advice(situation)) if isinstance(d, Ask)]
    call = Call(0, Problem.TA, control, question, 0, "")
    call.answer = question.solve(question.question)
    situation.world.start_pick(situation.world.robots[0], 1, 0)
    situation.world.start_rest(situation.world.robots[5], 5)
    list(control.carry_out(call, Advice(situation)))
    assert call.stale == 1


@pytest.mark.parametrize("control", [DispatchControl, RoutesControl])
def test_a_robot_without_a_place_for_its_pod_is_not_asked_about_for_ever(control: type) -> None:
    """Every place is taken: nothing is said, and nothing asked again at the same instant."""
    situation = Situation(small_layout(places=4, robots=1))
    situation.stock(3, s1=5)
    situation.assigned(s1=1)
    situation.carry(0, 3)
    robot = situation.world.robots[0]
    robot.task = None
    situation.world.asking[0] = robot
    situation.world.storage.keep(Situation(small_layout(robots=2)).world.robots[1], 3)
    assert told(situation, situation.make(control))[0] == []


def test_jobs_cover_requests_with_few_pods() -> None:
    """Pod 2 completes an order alone and comes first; pod 0 comes for what is left, pod 1 not."""
    situation = Situation()
    situation.stock(0, s3=1)
    situation.stock(1, s2=5)
    situation.stock(2, s1=2, s2=5)
    situation.assigned(s1=2, s2=1)
    situation.assigned(s3=1)
    found = jobs(situation.view, Worth(100.0, 50.0, 100.0), 9, 3)
    assert [(job.pod, job.service_s, job.worth_s) for job in found] == [
        (2, 30.0, 350.0),
        (0, 10.0, 150.0),
    ]
    assert [job.due_s for job in found] == [0.0, 30.0]
    assert [job.pod for job in jobs(situation.view, Worth(100.0, 50.0, 100.0), 9, 1)] == [2]


def test_bundles_go_together_and_the_greedy_rule_stands_in() -> None:
    """Two bundles of a SKU that orders want go into one pod, released once, to one station."""
    situation = Situation(small_layout(pods=2))
    situation.stock(0, s1=1)
    situation.stock(1, s2=1)
    for _ in range(10):
        situation.order(s1=1)
    one, other = situation.bundle(1), situation.bundle(1)
    for answer in (True, False):
        control = situation.make(StockingControl, leave_s=500.0)
        (question,) = list(control.decide())
        call = Call(0, Problem.RPS, control, question, 0, "")
        call.answer = question.solve(question.question) if answer else None
        found = [told_by(said, call)[0] for said in control.answered(call)]
        kinds = [type(decision) for decision in found]
        assert kinds == [PromiseBundle, PromiseBundle, ReleasePod, SendBundle, SendBundle]
        assert {d.bundle for d in found if isinstance(d, PromiseBundle)} == {one, other}
        assert len({d.pod for d in found if isinstance(d, PromiseBundle)}) == 1
        assert {d.station for d in found if isinstance(d, SendBundle)} == {1}


def test_a_bundle_goes_to_a_station_with_room_even_if_others_are_nearer() -> None:
    """Two of three replenishment stations are considered for each pod; the nearest two are full."""
    situation = Situation(small_layout(pods=2, replenishment_stations=3, station_capacity=4.0))
    for pod, station in ((0, 1), (0, 2)):
        situation.waiting_bundle(pod, station)
    bundle = situation.bundle(1)
    control = situation.make(StockingControl, leave_s=500.0)
    (question,) = list(control.decide())
    call = Call(0, Problem.RPS, control, question, 0, "")
    call.answer = question.solve(question.question)
    found = [told_by(said, call)[0] for said in control.answered(call)]
    assert found == [PromiseBundle(bundle, 1), ReleasePod(1), SendBundle(bundle, 3)]


def test_a_bundle_with_a_pod_by_then_is_stale() -> None:
    situation = Situation(small_layout(pods=2))
    bundle = situation.bundle(1)
    control = situation.make(StockingControl, leave_s=500.0)
    (question,) = list(control.decide())
    call = Call(0, Problem.RPS, control, question, 0, "")
    call.answer = question.solve(question.question)
    situation.world.promise(bundle, 1)
    assert list(control.answered(call)) == []
    assert call.stale == 1
