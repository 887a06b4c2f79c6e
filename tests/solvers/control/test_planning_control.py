"""TA planning in a small warehouse by hand: what it commits itself to of its plans."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from doubles import Situation, small_layout

from rmfs.control.asks import Ask, Call, told_by
from rmfs.control.decisions import (
    AssignLines,
    AssignOrder,
    BringForBundles,
    BringForPicks,
    Rest,
)
from rmfs.control.problems import Problem, Trigger
from rmfs.solvers.control.planning import PlanningControl


class NoConsult:
    """Nothing to go on with, nowhere to park."""

    def serves(self, pod: int, station: int) -> bool:
        return False

    def place_for(self, robot: Any) -> int:
        return -1


def said(situation: Situation, control: PlanningControl, *, answer: bool = True) -> list[Any]:
    """Ask for decisions; what is said is applied and returned, questions are answered at once."""
    found: list[Any] = []
    for robot in situation.world.robots:
        if robot.task is None:
            situation.world.asking[robot.index] = robot
    _apply(control.decide(NoConsult()), situation, control, answer, found)  # type: ignore[arg-type]
    return found


def _apply(
    given: Any, situation: Situation, control: PlanningControl, answer: bool, found: list[Any]
) -> None:
    world = situation.world
    for told in given:
        decision, _ = told_by(told, None)
        if isinstance(decision, Ask):
            call = Call(0, Problem.TA, control, decision, 0, "")
            call.answer = decision.solve(decision.question) if answer else None
            _apply(control.answered(call), situation, control, answer, found)
            continue
        found.append(decision)
        if isinstance(decision, AssignOrder):
            world.assign_order(decision.order, decision.station)
        elif isinstance(decision, AssignLines):
            world.assign_lines(decision.order, decision.station, decision.skus)
        elif isinstance(decision, BringForPicks):
            world.start_pick(decision.robot, decision.pod, decision.station)
        elif isinstance(decision, BringForBundles):
            world.start_replenish(decision.robot, decision.pod, decision.station)
        elif isinstance(decision, Rest):
            world.start_rest(decision.robot, decision.place)


def pods(found: list[Any]) -> list[int]:
    """The pods that robots are sent for, for picks."""
    return [decision.pod for decision in found if isinstance(decision, BringForPicks)]


def orders(found: list[Any]) -> list[Any]:
    """The orders that get slots."""
    return [decision.order for decision in found if isinstance(decision, AssignOrder)]


@pytest.mark.parametrize("answer", [True, False], ids=["optimiser", "start rule"])
def test_an_order_waits_at_its_station_for_a_second_pod(answer: bool) -> None:
    """No pod has both lines: two come one after the other, and the order has its slot at once."""
    situation = Situation()
    situation.stock(0, s1=5)
    situation.stock(1, s2=5)
    order = situation.order(s1=1, s2=1)
    control = situation.make(PlanningControl)
    found = said(situation, control, answer=answer)
    assert orders(found) == [order]
    assert sorted(pods(found)) == [0, 1]
    sent = [d.robot.index for d in found if isinstance(d, BringForPicks)]
    assert sorted(sent) == [0, 1]


def test_lines_of_a_split_order_share_a_slot() -> None:
    """Two pods of a line each come to the one station: the second line joins the first's slot."""
    situation = Situation(small_layout(slots=2))
    situation.stock(0, s1=5)
    situation.stock(1, s2=5)
    order = situation.order(s1=1, s2=1)
    found = said(situation, situation.make(PlanningControl, split=True))
    lines = [decision for decision in found if isinstance(decision, AssignLines)]
    assert sorted(decision.skus for decision in lines) == [(1,), (2,)]
    assert all(decision.order is order for decision in lines)
    assert situation.world.pick_stations[0].free_slots == 1


def test_no_further_pod_while_there_is_work_enough() -> None:
    """One unit is ten seconds of work: with a horizon of five the second pod is not sent for."""
    for horizon_s, sent in ((5.0, 1), (15.0, 2)):
        situation = Situation()
        situation.stock(0, s1=5)
        situation.stock(1, s2=5)
        situation.order(s1=1), situation.order(s2=1)
        control = situation.make(PlanningControl, horizon_s=horizon_s)
        assert len(pods(said(situation, control))) == sent


def test_one_slot_is_left_for_the_pod_at_the_head() -> None:
    """Three orders for one pod, two slots: one while it comes, the next when it is there."""
    situation = Situation(small_layout(slots=2))
    situation.stock(0, s1=5)
    waiting = [situation.order(s1=1) for _ in range(3)]
    control = situation.make(PlanningControl)
    assert len(orders(said(situation, control))) == 1
    robot = next(r for r in situation.world.robots if r.task is not None and r.task.pod == 0)
    station = situation.world.pick_stations[0]
    situation.world.lift(robot, 0)
    robot.station, station.robot = 0, robot.index
    assert len(orders(said(situation, control))) == 1
    assert sum(order in situation.world.orders for order in waiting) == 1


def test_a_share_of_the_robots_works_for_bundles_while_stock_is_low() -> None:
    """Below the floor so many robots as the share says, and one at least."""
    for share, sent in ((0.0, 1), (0.5, 2)):
        situation = Situation(small_layout(robots=4))
        for pod in (0, 1, 2):
            situation.waiting_bundle(pod=pod, station=1)
            situation.stock(pod, s1=5)
        for _ in range(8):
            situation.order(s1=2)
        given = {"stock_floor": 1.0, "bundle_share": share, "horizon_s": 500.0}
        found = said(situation, situation.make(PlanningControl, **given))
        first = [type(d) for d in found if isinstance(d, BringForPicks | BringForBundles)]
        assert first[:sent] == [BringForBundles] * sent
        assert first[sent] is BringForPicks


def test_bundles_come_first_while_stock_is_low() -> None:
    """Below the floor a robot works for bundles, and that is no decision of the model."""
    for floor, first in ((0.0, BringForPicks), (1.0, BringForBundles)):
        situation = Situation(small_layout(robots=1))
        situation.stock(0, s1=5)
        situation.order(s1=1)
        situation.waiting_bundle(pod=1, station=1)
        control = situation.make(PlanningControl, stock_floor=floor)
        (sent,) = [d for d in said(situation, control) if isinstance(d, first)]
        assert control.is_modelled(sent) == (first is BringForPicks)


def test_nobody_sets_out_for_bundles_above_the_ceiling() -> None:
    """A robot that no pick station needs works for bundles below it, and rests above."""
    for ceiling, sent in ((1.0, BringForBundles), (0.0, Rest)):
        situation = Situation(small_layout(robots=1))
        situation.stock(0, s1=5)
        situation.waiting_bundle(pod=1, station=1)
        given = {"stock_floor": 0.0, "stock_ceiling": ceiling}
        (decision,) = said(situation, situation.make(PlanningControl, **given))
        assert isinstance(decision, sent)


def test_a_plan_for_some_stations_leaves_the_others_theirs() -> None:
    """What is planned for the first station is no matter of the second, orders and pods."""
    situation = Situation(small_layout(pick_stations=2))
    situation.stock(0, s1=2)
    situation.stock(1, s1=2, s2=1)
    situation.stock(2, s3=3)
    situation.order(s1=2)
    control = situation.make(PlanningControl, stations=1, buffer_s=0.0, horizon_s=0.0)
    (first,) = _asked(situation, control)
    assert (first.data.stations, first.data.orders) == (1, 1)
    situation.assigned(s3=1)
    situation.world.start_pick(situation.world.robots[0], 2, 0)  # now the other has less work
    situation.order(s2=1)
    control.hear(Trigger.POD_AT_STATION, 0)
    (second,) = _asked(situation, control)
    assert (second.data.stations, second.data.orders) == (1, 1)
    may_come = np.isfinite(second.data.cost[:, 0])
    assert may_come.sum() == np.isfinite(first.data.cost[:, 0]).sum() - 2


def _asked(situation: Situation, control: PlanningControl) -> list[Any]:
    """The questions that are asked now; they are answered at once."""
    asked = []
    for decision in control.decide(NoConsult()):  # type: ignore[arg-type]
        if isinstance(decision, Ask):
            asked.append(decision.question)
            call = Call(0, Problem.TA, control, decision, 0, "")
            call.answer = decision.solve(decision.question)
            assert pods([told_by(said, call)[0] for said in control.answered(call)]) == []
    return asked


def test_what_does_not_hold_any_more_is_dropped_and_counted() -> None:
    """The pod of a planned visit is taken by somebody else: it is passed over as stale."""
    situation = Situation(small_layout(robots=1))
    situation.stock(0, s1=5)
    situation.order(s1=1)
    control = situation.make(PlanningControl, horizon_s=0.0)
    (ask,) = [d for d in control.decide(NoConsult()) if isinstance(d, Ask)]
    call = Call(0, Problem.TA, control, ask, 0, "")
    call.answer = ask.solve(ask.question)
    situation.world.storage.claim(0, 0)
    assert pods([told_by(said, call)[0] for said in control.answered(call)]) == []
    assert call.stale == 1


def test_what_is_due_goes_before_what_is_nearer_and_worth_more() -> None:
    """One robot, two pods: tardiness in the objective sends it for the order that is due."""
    for late_s, first in ((0.0, "large"), (500.0, "due")):
        situation = Situation(small_layout(robots=1))
        situation.stock(0, s1=5)
        situation.stock(1, s2=5)
        large, due = situation.order(3600.0, s1=3), situation.order(10.0, s2=1)
        control = situation.make(PlanningControl, late_s=late_s)
        found = said(situation, control)
        assert orders(found) == [{"large": large, "due": due}[first]]
        assert pods(found) == [{"large": 0, "due": 1}[first]]


def test_of_orders_that_a_visit_serves_alike_the_first_due_takes_it() -> None:
    """The pod has units for one of two equal orders: the later one, which is due before."""
    for late_s, first in ((0.0, 0), (50.0, 1)):
        situation = Situation()
        situation.stock(0, s1=1)
        waiting = [situation.order(900.0, s1=1), situation.order(100.0, s1=1)]
        found = said(situation, situation.make(PlanningControl, late_s=late_s))
        assert orders(found) == [waiting[first]]


@pytest.mark.parametrize(("given", "each"), [({}, 75 * 3), ({"steps": 20}, 20)])
def test_steps_grow_with_the_pick_stations_of_the_site(given: dict[str, int], each: int) -> None:
    """The default is 75 per pick station of the site, for each station that is planned."""
    for planned in (2, 64):
        situation = Situation(small_layout(pick_stations=3))
        situation.stock(0, s1=5)
        situation.order(s1=1)
        control = situation.make(PlanningControl, stations=planned, **given)
        for robot in situation.world.robots:
            situation.world.asking[robot.index] = robot
        asks = [told for told in control.decide(NoConsult()) if isinstance(told, Ask)]
        assert [one.question.limits.iterations for one in asks] == [each * min(planned, 3)]
