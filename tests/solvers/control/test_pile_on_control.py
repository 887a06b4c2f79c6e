"""POA pile-on: what it plans in a small warehouse by hand, and what it is worth in runs."""

from __future__ import annotations

from typing import Any

import pytest
from doubles import Situation, small_layout

from rmfs import simulate
from rmfs.control.asks import Ask, Call, told_by
from rmfs.control.choices import choose
from rmfs.control.decisions import AssignLines, AssignOrder, BringForBundles, BringForPicks, Rest
from rmfs.control.problems import Problem, Trigger
from rmfs.errors import InputError
from rmfs.solvers.control.pile_on import PileOnControl, PileOnTasks


def decisions(situation: Situation, control: PileOnControl, *, answer: bool = True) -> list[Any]:
    """Ask until it has nothing to say, apply what it says, and answer its questions."""
    found: list[Any] = []
    given = [control.decide()]
    while given:
        for told in given.pop():
            decision, _ = told_by(told, None)
            if isinstance(decision, Ask):
                call = Call(0, Problem.POA, control, decision, 0, "")
                call.answer = decision.solve(decision.question) if answer else None
                given.append(control.answered(call))
                continue
            found.append(decision)
            if isinstance(decision, AssignOrder):
                situation.world.assign_order(decision.order, decision.station)
            else:
                situation.world.assign_lines(*decision)
    return found


@pytest.mark.parametrize("answer", [True, False], ids=["optimiser", "heuristic"])
def test_one_pod_for_both_orders(answer: bool) -> None:
    """Pod 2 has what both orders want; pods 0 and 1 would be needed together."""
    situation = Situation()
    situation.stock(0, s1=5)
    situation.stock(1, s2=5)
    situation.stock(2, s1=5, s2=5)
    one, other = situation.order(s1=1), situation.order(s2=1)
    control = situation.make(PileOnControl, when_needed=False, kept_slots=0)
    found = decisions(situation, control, answer=answer)
    assert {decision.order for decision in found} == {one, other}
    station = situation.world.pick_stations[0]
    robot = situation.world.robots[0]
    assert told_by(control.pick_pod(robot, station), None)[0] == 2
    situation.world.start_pick(robot, 2, 0)
    assert control.pick_pod(situation.world.robots[1], station) == -1


def test_a_decision_has_a_bound() -> None:
    """Nothing better than one pod for both orders can be decided, and the answer proves as much."""
    situation = Situation()
    situation.stock(2, s1=5, s2=5)
    situation.order(s1=1), situation.order(s2=1)
    control = situation.make(PileOnControl, when_needed=False, kept_slots=0, bound_steps=200)
    (asked,) = [ask for ask in control.decide() if isinstance(ask, Ask)]
    told = asked.solve(asked.question)
    assert told.objective - 1.0 < told.bound <= told.objective


def test_only_what_is_named_triggers_a_question() -> None:
    """A slot is free and an order waits; no pod has come."""
    for triggers, asks in (((), 0), (("pod-at-station",), 1), (("free-slot",), 1)):
        situation = Situation()
        situation.stock(0, s1=5)
        situation.order(s1=1)
        control = situation.make(PileOnControl, triggers=triggers)
        assert sum(isinstance(said, Ask) for said in control.decide()) == asks


def test_splits_an_order_whose_lines_no_pod_has_together() -> None:
    """With one line on the way, that line alone goes to the station."""
    situation = Situation()
    situation.stock(0, s1=5)
    order = situation.order(s1=1)
    rest = situation.order(s1=1, s2=1)
    situation.stock(1, s2=5)
    control = situation.make(PileOnControl, split=True, horizon_s=5.0, kept_slots=0)
    found = decisions(situation, control)
    assert all(isinstance(decision, AssignLines) for decision in found)
    assert {decision.order for decision in found} <= {order, rest}
    pod = control.pick_pod(situation.world.robots[0], situation.world.pick_stations[0])
    assert told_by(pod, None)[0] in (0, 1)


def test_stale_items_and_pods_are_dropped() -> None:
    """The pod is taken by somebody else before a robot comes: the call counts it."""
    situation = Situation(small_layout(slots=2))
    situation.stock(0, s1=5)
    situation.order(s1=1)
    control = situation.make(PileOnControl, when_needed=False, kept_slots=0)
    decisions(situation, control)
    other = situation.world.robots[1]
    situation.world.start_reposition(other, 0, 5)
    assert control.pick_pod(situation.world.robots[0], situation.world.pick_stations[0]) == -1


def tasks(situation: Situation, control: PileOnTasks, *, answer: bool = True) -> list[Any]:
    """Ask for tasks; what is said is applied and returned, questions are answered at once."""
    found: list[Any] = []
    apply(control.decide(NoConsult()), situation, control, answer, found)  # type: ignore[arg-type]
    return found


def apply(
    decisions: Any, situation: Situation, control: PileOnTasks, answer: bool, found: list[Any]
) -> None:
    """Apply decisions one by one."""
    world = situation.world
    for told in decisions:
        decision, _ = told_by(told, None)
        if isinstance(decision, Ask):
            call = Call(0, Problem.TA, control, decision, 0, "")
            call.answer = decision.solve(decision.question) if answer else None
            apply(control.answered(call), situation, control, answer, found)
            continue
        found.append(decision)
        if isinstance(decision, AssignOrder):
            world.assign_order(decision.order, decision.station)
        elif isinstance(decision, BringForPicks):
            world.start_pick(decision.robot, decision.pod, decision.station)
        elif isinstance(decision, BringForBundles):
            world.start_replenish(decision.robot, decision.pod, decision.station)


class NoConsult:
    """Nothing to go on with, nowhere to park."""

    def serves(self, pod: int, station: int) -> bool:
        return False

    def place_for(self, robot: Any) -> int:
        return -1


@pytest.mark.parametrize("answer", [True, False], ids=["optimiser", "heuristic"])
def test_orders_pods_and_robots_together(answer: bool) -> None:
    """Both orders go where one pod serves them; the robot nearer to that pod fetches it."""
    situation = Situation()
    situation.stock(0, s1=5)
    situation.stock(1, s2=5)
    situation.stock(2, s1=5, s2=5)
    one, other = situation.order(s1=1), situation.order(s2=1)
    control = situation.make(PileOnTasks)
    robots = situation.world.robots
    at = situation.world.storage.pod_waypoint[[2]]
    travel = control.view.travel
    near = min(robots, key=lambda robot: (travel.estimate_s(robot.waypoint, at)[0], robot.index))
    found = tasks(situation, control, answer=answer)
    assert {d.order for d in found if isinstance(d, AssignOrder)} == {one, other}
    (fetch,) = [d for d in found if isinstance(d, BringForPicks)]
    assert (fetch.robot, fetch.pod) == (near, 2)
    others = {d.robot.index for d in found if isinstance(d, Rest)}
    assert others == {robot.index for robot in robots if robot is not near}


@pytest.mark.parametrize("answer", [True, False], ids=["optimiser", "heuristic"])
def test_the_planned_robot_fetches_the_pod(answer: bool) -> None:
    """Robot 0 is busy, so that the model numbers robots 1 and 2 from 0; 2 is nearer to the pod."""
    situation = Situation(small_layout(robots=3, places=8, pods=6))
    situation.stock(5, s1=5)
    situation.order(s1=1)
    world = situation.world
    world.start_reposition(world.robots[0], 0, 7)
    found = tasks(situation, situation.make(PileOnTasks), answer=answer)
    (fetch,) = [decision for decision in found if isinstance(decision, BringForPicks)]
    assert (fetch.robot.index, fetch.pod) == (2, 5)


def test_an_order_may_wait_at_its_station_for_a_line() -> None:
    """Its lines are in two pods and there is one robot: M1G as printed leaves the slot empty."""
    for later in (False, True):
        situation = Situation(small_layout(robots=1))
        situation.stock(0, s1=5)
        situation.stock(1, s2=5)
        order = situation.order(s1=1, s2=1)
        found = tasks(situation, situation.make(PileOnTasks, later=later))
        assert [d.order for d in found if isinstance(d, AssignOrder)] == [order] * later
        assert len([d for d in found if isinstance(d, BringForPicks)]) == later


def test_pods_are_called_by_work_on_its_way() -> None:
    """A station that has a pod under way lacks another one, but does not run out of work."""
    for by_work in (False, True):
        situation = Situation()
        situation.stock(0, s1=5)
        situation.stock(1, s2=5)
        situation.order(s1=2)
        control = situation.make(
            PileOnTasks, later=True, by_work=by_work, horizon_s=1.0, buffer_s=0.0
        )
        assert [d.pod for d in tasks(situation, control) if isinstance(d, BringForPicks)] == [0]
        situation.order(s2=1)
        control.hear(Trigger.ROBOT_FREE, 0)
        called = [d.pod for d in tasks(situation, control) if isinstance(d, BringForPicks)]
        assert called == ([] if by_work else [1])


@pytest.mark.parametrize(
    ("allowed", "radius_m", "goes_to"), [(True, 10.0, 1), (False, 10.0, None), (True, 9.9, None)]
)
def test_a_served_pod_may_go_on_to_another_station(
    allowed: bool, radius_m: float, goes_to: int | None
) -> None:
    """The pod at station 0 has what an order at station 1 waits for; nothing else is left."""
    situation = Situation(small_layout(pick_stations=2))
    situation.stock(0, s1=5)
    situation.assigned(1, s1=1)
    situation.carry(0, 0, 0)
    situation.world.end_task(situation.world.robots[0])
    control = situation.make(PileOnTasks, other_stations=allowed, search_radius_m=radius_m)

    class Serves(NoConsult):
        def serves(self, pod: int, station: int) -> bool:
            return control.serves(pod, station)

        def next_station(self, robot: Any, stations: Any) -> int:
            return control.next_station(robot, stations)

    found: list[Any] = []
    apply(control.decide(Serves()), situation, control, True, found)  # type: ignore[arg-type]
    gone = [d.station for d in found if isinstance(d, BringForPicks) and d.robot.index == 0]
    assert gone == ([] if goes_to is None else [goes_to])


def test_split_orders_are_not_also_covered_later() -> None:
    with pytest.raises(InputError, match="later: cannot be combined with split"):
        choose(Problem.POA, {"name": "pile-on", "later": True, "split": True}, "test")


@pytest.mark.parametrize(
    ("problem", "given"),
    [
        (Problem.POA, {"work_s": 1.0}),
        (Problem.TA, {"work_s": 1.0}),
        (Problem.POA, {"pods_per_sku": 2}),
        (Problem.TA, {"orders_per_slot": 8}),
    ],
)
def test_limits_that_the_exact_method_would_not_keep_are_refused(
    problem: Problem, given: dict[str, Any]
) -> None:
    """The start rule may keep them, so that a set can be run with and without its search."""
    name = next(iter(given))
    with pytest.raises(InputError, match=f"{name}: has no effect with method cp_sat"):
        choose(problem, {"name": "pile-on", "method": "cp_sat", **given}, "test")
    choose(problem, {"name": "pile-on", "method": "cp_sat", "gap": 0.1}, "test")
    for method in ("joint", "greedy"):
        choose(problem, {"name": "pile-on", "method": method, **given}, "test")


@pytest.mark.parametrize("method", ["joint", "cp_sat", "greedy", "hadgs"])
def test_every_method_answers(method: str) -> None:
    """Here all find the pod that has what both orders want."""
    situation = Situation()
    situation.stock(0, s1=5)
    situation.stock(2, s1=5, s2=5)
    one, other = situation.order(s1=1), situation.order(s2=1)
    control = situation.make(PileOnControl, when_needed=False, kept_slots=0, method=method)
    assert {decision.order for decision in decisions(situation, control)} == {one, other}


def test_some_robots_bring_pods_for_bundles() -> None:
    """One robot of two at most; the other is left to the model."""
    situation = Situation()
    situation.waiting_bundle(pod=0, station=1)
    situation.waiting_bundle(pod=1, station=1)
    control = situation.make(PileOnTasks, replenishment_share=0.33)
    found = tasks(situation, control)
    assert len([d for d in found if isinstance(d, BringForBundles)]) == 1
    assert not control.is_modelled(found[0])


def test_m1g_runs() -> None:
    """Of the decisions that M1G takes nearly all come from the model."""
    run = simulate("small", "small", "m1g", seed=1, overrides=[(["scenario", "duration_s"], 900)])
    assert run.footprint["optimiser_decision_share"] >= 0.85
    assert run.footprint["units_per_h"] > 600


@pytest.mark.parametrize("split", [False, True])
def test_run_beats_one_decision_after_the_other(split: bool) -> None:
    """More units per visit and fewer metres per order than SEQU; nine of ten by the optimiser."""
    overrides = [(["scenario", "duration_s"], 2400), (["layout", "robots"], 6)]
    name = "pile-on-split" if split else "pile-on"
    limit = [(["controllers", "poa", "work_s"], 0.005)]
    joint = simulate("small", "small", name, seed=1, overrides=overrides + limit).footprint
    rules = simulate("small", "small", "sequ", seed=1, overrides=overrides).footprint
    assert joint["units_per_visit"] > 1.15 * rules["units_per_visit"]
    per_order = joint["distance_m"] / joint["orders_completed"]
    assert per_order < 0.8 * rules["distance_m"] / rules["orders_completed"]
    assert joint["optimiser_decision_share"] >= 0.9
