"""Decisions from outside: a run that follows the advice of its rules is the run of these rules."""

from __future__ import annotations

import hashlib
import random
from collections import Counter
from functools import cache
from math import inf, nan
from typing import Any

import pytest

import rmfs
from rmfs.control.decisions import AssignOrder, BringForPicks, Park
from rmfs.errors import InputError
from rmfs.measure.dictionary import reproducible
from rmfs.simulation.decision import Decision, ImpossibleError
from rmfs.solvers.control.tasks.dispatch import DispatchControl

DURATION_S = 250
NEVER_ASKED = ("mm", "repositioning")  # by default: rules that never do anything
DECIDED_BY_RULES = ["poa", "roa", "rps", "pps", "psa", "ta", "sa", "mm", "repositioning"]


def simulation(
    *outside: str,
    controllers: str = "default",
    seed: int = 3,
    pacing: str = "instant",
    **given: Any,
) -> rmfs.Simulation:
    keys = {"layout.robots": 10, "scenario.warmup_s": 60, "scenario.duration_s": DURATION_S}
    keys |= {key.replace("__", "."): value for key, value in given.items()}
    return rmfs.Simulation(
        "default",
        "default",
        controllers,
        seed=seed,
        set=keys,
        outside=outside,
        pacing=pacing,
        trace=True,
    )


def told(run: rmfs.Simulation) -> dict[str, Any]:
    """What tells runs apart: the motion of all robots, orders, stock, and decisions counted."""
    motion = hashlib.sha256()
    for name, values in sorted(run.traffic.trace().items()):
        motion.update(name.encode() + values.tobytes())
    world = run.world
    return {
        "now_s": run.now_s,
        "motion": motion.hexdigest(),
        "stock": hashlib.sha256(world.inventory.contained.tobytes()).hexdigest(),
        "orders": world.orders_completed,
        "units": world.units_picked,
        "decisions": {str(p): s.decisions for p, s in run.deciding.statistics.items()},
    }


def follow(run: rmfs.Simulation) -> int:
    """Take the advice of the rules to the end; returns how many questions were asked."""
    asked = 0
    while (decision := run.step()) is not None:
        asked += 1
        take(decision)
    return asked


def take(decision: Decision) -> None:
    advice = decision.advice()
    if advice is None:
        decision.decline()
    else:
        decision.answer(advice)


RULES: dict[str, dict[str, Any]] = {
    "default": {},
    "random": {"controllers": "random"},
    "swarm": {"controllers__ta": "swarm"},
    "repositioning": {"controllers__repositioning": "utility", "controllers__psa": "utility"},
    "scheduled": {
        "controllers__poa": "queue",
        "controllers__mm": {
            "name": "scheduled",
            "exchanges": [{"at_s": 100.0, "psa": "random"}, {"at_s": 300.0, "poa": "related"}],
        },
        "controllers__sa": {"name": "backlog-threshold", "pause_s": 60.0},
    },
}


@pytest.mark.parametrize("rules", RULES)
@pytest.mark.parametrize("problem", DECIDED_BY_RULES)
def test_a_run_that_follows_the_advice_is_the_run_of_the_rule(problem: str, rules: str) -> None:
    run = simulation(problem, **RULES[rules])
    assert follow(run) > 0 or problem in NEVER_ASKED
    assert told(run) == of_the_rules(rules)


@cache
def of_the_rules(rules: str) -> dict[str, Any]:
    inside = simulation(**RULES[rules])
    inside.run()
    return told(inside)


# rules for TA that ask an optimiser, and which questions of theirs can be answered outside
BY_OPTIMISERS: dict[str, tuple[dict[str, Any], tuple[str, ...]]] = {
    "dispatch": ({"controllers__ta": "dispatch"}, ("pps", "psa", "repositioning")),
    "dispatch at once": ({"controllers__ta": {"name": "dispatch", "buffer_s": 0}}, ("pps", "psa")),
    "dispatch later": ({"controllers__ta": "dispatch", "pacing": "fixed=3"}, ("pps", "psa")),
    "planning": ({"controllers": "planning"}, ("psa", "repositioning")),
    "pile-on": (
        {"controllers": "pile-on-dispatch", "scenario__warmup_s": 0, "scenario__duration_s": 90},
        ("psa",),
    ),
    "rollout": (
        {
            "controllers__ta": {"name": "rollout", "samples": 1, "certainty": 0, "horizon_s": 5.0},
            "scenario__duration_s": 60,
        },
        ("pps", "psa"),
    ),
}


def measured(run: rmfs.Simulation) -> tuple[Any, ...]:
    """The footprint, and how each question to an optimiser went."""
    done = run.result()
    calls = done.recorder.questions
    went = [(c.number, c.outcome, c.applied, c.stale, c.fallback, c.completed_us) for c in calls]
    return done.footprint[reproducible("footprint")].to_json(), went


@pytest.mark.parametrize(
    ("rule", "outside"),
    [(rule, outside) for rule, (_, problems) in BY_OPTIMISERS.items() for outside in problems]
    + [("dispatch", "pps psa")],
)
def test_what_a_rule_asks_while_it_carries_out_an_answer_is_decided_outside(
    rule: str, outside: str
) -> None:
    """The run ends as the rules would have it end: also where each question waits in a copy."""
    given = BY_OPTIMISERS[rule][0]
    run = simulation(*outside.split(), **given)
    asked = 0
    while (decision := run.step()) is not None:
        asked += 1
        if asked % 25 == 1:  # it is pending: the copy goes on from there
            run = run.fork()
            decision = run.decision
            assert decision is not None
        take(decision)
    assert asked > 0 or outside in NEVER_ASKED
    inside = simulation(**given)
    inside.run()
    assert told(run) == told(inside)
    assert measured(run) == measured(inside)


@pytest.mark.parametrize("rules", ["pile-on-dispatch", "ta-balance", "ta-matching"])
def test_nobody_is_asked_for_ever_about_a_pod_that_is_not_to_be_stored(rules: str) -> None:
    """A rule with an optimiser that answers at once does not ask it again at the same instant."""
    given = {"scenario.warmup_s": 0, "scenario.duration_s": 120, "layout.robots": 10}
    run = rmfs.Simulation("small", "small", rules, seed=1, set=given, outside=["psa"])
    asked: Counter[tuple[float, int]] = Counter()
    while (decision := run.step()) is not None:
        assert decision.robot is not None
        about = decision.now_s, decision.robot.index
        asked[about] += 1
        assert asked[about] <= 4
        decision.decline()
    assert asked


def test_all_problems_at_once() -> None:
    inside = simulation()
    inside.run()
    run = simulation(*DECIDED_BY_RULES)
    assert follow(run) > 1000
    assert told(run) == told(inside)


def test_how_often_a_run_stops_changes_nothing() -> None:
    inside, run = simulation(), simulation()
    inside.run()
    for time_s in range(0, 2000, 7):
        assert run.run_until(time_s) is None
        assert run.now_s == min(time_s, run.end_s)
    assert run.ended
    assert told(run) == told(inside)


def test_the_time_to_simulate_to_is_a_number() -> None:
    run = simulation()
    for wrong in (nan, -inf):
        with pytest.raises(InputError, match=f"time_s {wrong}: must be a time in s, or inf for"):
            run.run_until(wrong)
    assert run.run_until(inf) is None
    assert run.ended


def test_a_question_stands_until_it_is_answered() -> None:
    run = simulation("poa")
    decision = run.step()
    assert decision is not None
    assert decision.is_open
    for again in (run.step(), run.run_until(500.0)):
        assert again is not None
        assert (again.problem, again.now_s) == (decision.problem, decision.now_s)
    with pytest.raises(RuntimeError, match="poa is decided outside"):
        run.run()


def test_what_is_not_possible_is_refused_and_the_question_stands() -> None:
    run = simulation("poa")
    run.step().decline()
    decision = run.step()
    order = next(iter(run.view.orders))
    robot = run.view.robots[0]
    for wrong, reason in [
        (AssignOrder(order, 99), "there is no pick station 99"),
        (AssignOrder(order, "first"), "not the number of a pick station"),
        ((order, 0), "expected AssignOrder, AssignLines, QueueOrder"),
        (Park(robot, 3), "expected AssignOrder"),
        (None, "expected AssignOrder"),
    ]:
        with pytest.raises(ImpossibleError, match=reason):
            decision.answer(wrong)
        assert decision.is_open
    decision.answer(AssignOrder(order, 0))
    with pytest.raises(ImpossibleError, match="is not in the backlog"):
        decision.answer(AssignOrder(order, 0))
    decision.decline()
    with pytest.raises(ImpossibleError, match="has already been answered"):
        decision.answer(AssignOrder(order, 0))


def test_a_full_station_takes_no_order() -> None:
    run = simulation("poa")
    while (decision := run.step()) is not None and len(decision.candidates):
        decision.answer(decision.candidates[0])
    order = next(iter(run.view.orders))
    with pytest.raises(ImpossibleError, match="has no free slot"):
        decision.answer(AssignOrder(order, 0))


def test_impossible_tasks_are_refused() -> None:
    run = simulation("ta")
    while not any(robot.task for robot in run.view.robots):
        take(run.step())
    decision = run.step()
    busy = next(robot for robot in run.view.robots if robot.task and robot.task.pod >= 0)
    free = next(robot for robot in run.view.robots if robot.index in run.view.asking)
    with pytest.raises(ImpossibleError, match=f"robot {busy.index} already has a task"):
        decision.answer(BringForPicks(busy, busy.task.pod, 0))
    with pytest.raises(ImpossibleError, match=f"pod {busy.task.pod} is not available"):
        decision.answer(BringForPicks(free, busy.task.pod, 0))
    with pytest.raises(ImpossibleError, match="carries no pod"):
        decision.answer(Park(free, 0))


@pytest.mark.parametrize(
    "problem", ["poa", "roa", "rps", "pps", "psa", "ta", "sa", "repositioning"]
)
def test_every_candidate_is_possible(problem: str) -> None:
    """What is listed can be chosen; a run goes on whatever is chosen."""
    run = simulation(problem, scenario__duration_s=200, controllers__repositioning="utility")
    chosen = 0
    while (decision := run.step()) is not None:
        candidates = decision.candidates
        assert {len(column) for column in candidates.columns.values()} == {len(candidates)}
        if len(candidates) and chosen % 3 < 2 and chosen < 300:
            decision.answer(candidates[chosen * 7 % len(candidates)])
        elif decision.kind == "next station":
            decision.answer(decision.stations[0])
        else:
            decision.decline()
        chosen += 1
    assert run.ended


@pytest.mark.parametrize("seed", range(6))
def test_a_rule_that_asks_about_several_robots_gets_all_answers(seed: int) -> None:
    """Also if some are none, and the rule goes through its robots again after each of them."""
    run = rmfs.Simulation(
        "small", "small", seed=5, set={"scenario.duration_s": 240}, outside=["pps"]
    )
    draw, asked = random.Random(seed), 0
    while (decision := run.step()) is not None:
        candidates = decision.candidates
        row = draw.randrange(len(candidates) + 1) if len(candidates) else 0
        if row < len(candidates):
            decision.answer(candidates[row])
        else:
            decision.decline()
        asked += 1
        assert asked < 200
    assert run.ended


class AsksAndForgets(DispatchControl):
    """Cannot go on with an answer."""

    goes_on = False


@pytest.mark.parametrize(
    ("outside", "rules", "reason"),
    [
        ("pp", {}, "this problem cannot be decided outside"),
        ("pick", {}, "cannot be decided outside; valid: poa, roa"),
        (
            "pps",
            {"controllers__ta": "random", "controllers__pps": "dummy"},
            "ta random also decides pps",
        ),
        (
            "psa",
            {"controllers__ta": {"name": f"{__name__}:AsksAndForgets"}},
            "needs these decisions while .* can continue after",
        ),
    ],
)
def test_what_cannot_be_decided_outside_is_refused(
    outside: str, rules: dict[str, Any], reason: str
) -> None:
    with pytest.raises(InputError, match=reason):
        simulation(outside, **rules)


def test_problems_and_seeds_of_a_wrong_type_are_named() -> None:
    with pytest.raises(
        InputError, match=r'outside pps: must be a list of problems, such as \["pps"\]'
    ):
        rmfs.Simulation("small", "small", outside="pps")
    for seed in (1.5, "1", True, None):
        with pytest.raises(InputError, match=f"seed {seed!r}: must be a whole number"):
            rmfs.simulate("small", "small", seed=seed)


def test_a_negative_row_is_not_counted_from_the_end() -> None:
    run = simulation("pps")
    decision = run.step()
    assert decision is not None and len(decision.candidates) > 1
    with pytest.raises(IndexError, match=r"row -1: must be 0 or more; .* decline\(\)"):
        decision.choose(-1)
    decision.choose(0)  # the decision remained open
