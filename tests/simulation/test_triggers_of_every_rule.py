"""Every built-in rule is asked at exactly the instants of the paper's table 1, of what it
subscribed to and of the times it named itself: not once more, not once less, in busy half hours.
"""

from __future__ import annotations

import sys
from itertools import pairwise
from math import inf
from typing import TYPE_CHECKING, Any

import pytest
from every_rule import always_busy, rules_of, tables_of

from rmfs.control import registry
from rmfs.control.base import Controller
from rmfs.control.problems import Problem, Trigger

if TYPE_CHECKING:
    from hand_made import HandMade

DURATION_S = 1800.0

TABLE_1 = {
    Problem.ROA: {Trigger.NEW_BUNDLE, Trigger.BUNDLE_STORED},
    Problem.POA: {Trigger.NEW_ORDER, Trigger.ORDER_COMPLETED, Trigger.BUNDLE_STORED},
    Problem.RPS: {Trigger.NEW_BUNDLE, Trigger.UNIT_PICKED},
    Problem.TA: {Trigger.ROBOT_FREE},
    Problem.SA: set(),
    Problem.MM: set(),
}
"""Main triggers as printed in the paper; SA and MM are not driven by events."""

STATIONS_CHANGE = {Problem.ROA, Problem.POA}
"""Besides, as in the reference system, these are asked when a station is switched."""


class Spied:
    """What a rule was told of and asked, from its start on."""

    told: list[tuple[float, Trigger]]
    asked: list[float]
    named: list[float]
    answers: list[tuple[float, Any]]


def spied(rule: type[Controller[Any]], spy: Spied) -> type[Controller[Any]]:
    """Derive from a rule one that tells a spy when it is asked, and of every event there is."""
    spy.told, spy.asked, spy.named, spy.answers = [], [], [], []

    def hear(self: Any, trigger: Trigger, subject: Any) -> None:
        goes_on = trigger is Trigger.ROBOT_FREE and self.view.robots[subject].prepared
        if not goes_on:
            spy.told.append((self.view.now_s, trigger))
        if trigger in rule.hears:
            rule.hear(self, trigger, subject)

    def decide(self: Any, *consult: Any) -> Any:
        spy.asked.append(self.view.now_s)
        spy.named.append(inf)
        yield from rule.decide(self, *consult)  # type: ignore[attr-defined]

    def next_event_s(self: Any) -> float:
        if spy.named:
            spy.named[-1] = rule.next_event_s(self)
        return rule.next_event_s(self)

    def answering(name: str) -> Any:
        def method(self: Any, *question: Any) -> Any:
            answer = getattr(rule, name)(self, *question)
            spy.answers.append((self.view.now_s, answer))
            return answer

        return method

    methods: dict[str, Any] = {"hears": frozenset(Trigger), "hear": hear}
    if hasattr(rule, "decide"):
        methods["decide"] = decide
    if rule.next_event_s is not Controller.next_event_s:
        methods["next_event_s"] = next_event_s
    for name in ("pick_pod", "replenishment_pod", "place", "move"):
        if hasattr(rule, name):
            methods[name] = answering(name)
    return type("Watched", (rule,), methods)


def watch(problem: Problem, name: str, monkeypatch) -> tuple[Spied, HandMade]:
    """Run a small warehouse that always has work, with one rule watched."""
    spy = Spied()
    rule = spied(registry.find(problem, name), spy)
    monkeypatch.setattr(sys.modules[__name__], "Watched", rule, raising=False)
    tables = tables_of(problem, name)
    tables[str(problem)]["name"] = f"{__name__}:Watched"
    made = always_busy(DURATION_S, **tables)
    made.run()
    assert made.world.orders_completed > 10
    return spy, made


def instant_of(time_s: float, after_s: float) -> float:
    """Return when a time that was named comes: at its microsecond, but not at this one again."""
    return max(time_s, after_s + 1e-6)


@pytest.mark.parametrize(("problem", "name"), rules_of(*TABLE_1), ids=str)
def test_asked_at_exactly_these_instants(problem, name, monkeypatch) -> None:
    """What the rule is told of (all events) gives the instants expected by its triggers.

    TA is asked only if some robot has no task or is at rest: after other events at most, but always
    after ROBOT_FREE, unless a task was prepared for the robot.
    """
    spy, _ = watch(problem, name, monkeypatch)
    rule = registry.find(problem, name)
    calling = TABLE_1[problem] | rule.subscriptions | {Trigger.START}
    if problem in STATIONS_CHANGE:
        calling |= {Trigger.STATION_SWITCHED}
    if (problem, name) == (Problem.MM, "none"):
        assert spy.asked == []
        return
    events = {time_s for time_s, trigger in spy.told if trigger in calling}
    certain = {time_s for time_s, trigger in spy.told if trigger is Trigger.ROBOT_FREE}
    named = set()
    for (asked_s, next_s), (again_s, _) in pairwise(
        [*zip(spy.asked, spy.named, strict=True), (DURATION_S + 1e-6, inf)]
    ):
        due_s = instant_of(next_s, asked_s)
        assert again_s <= due_s + 2e-6 or due_s > DURATION_S, "a time it named was missed"
        if again_s == pytest.approx(due_s, abs=2e-6):
            named.add(again_s)
    assert set(spy.asked) <= events | named
    assert (certain if problem is Problem.TA else events) <= set(spy.asked)


@pytest.mark.parametrize(("problem", "name"), rules_of(Problem.PSA), ids=str)
def test_psa_once_for_each_pod_to_be_parked(problem, name, monkeypatch) -> None:
    spy, made = watch(problem, name, monkeypatch)
    parked = [entry[0] for entry in made.diary.of("park")]
    assert [time_s for time_s, place in spy.answers if place >= 0] == parked
    assert len(parked) > 10


@pytest.mark.parametrize(("problem", "name"), rules_of(Problem.PPS), ids=str)
def test_pps_once_for_each_robot_that_gets_a_pod(problem, name, monkeypatch) -> None:
    """Robots that go on with the pod they carry are not among them."""
    spy, made = watch(problem, name, monkeypatch)
    tasks = [entry[0] for entry in made.diary.of("pick", "replenish")]
    chosen = [time_s for time_s, pod in spy.answers if pod >= 0]
    assert len(chosen) > 10
    for time_s in set(chosen):
        assert chosen.count(time_s) <= tasks.count(time_s)


@pytest.mark.parametrize("name", ["cache", "cache-drop-off", "utility"])
def test_repositioning_once_for_each_robot_without_other_work(name, monkeypatch) -> None:
    spy, made = watch(Problem.REPOSITIONING, name, monkeypatch)
    moved = [entry[0] for entry in made.diary.of("reposition")]
    assert [time_s for time_s, move in spy.answers if move is not None] == moved


def test_pp_for_each_new_destination(monkeypatch) -> None:
    """Each task that leads a robot elsewhere is one command to traffic, which plans the way."""
    _, made = watch(Problem.POA, "pod-match", monkeypatch)
    begun = made.diary.of("pick", "replenish", "park", "rest", "reposition")
    times = {time_us / 1e6 for time_us, _, _ in made.traffic.commands}
    assert len(made.traffic.commands) > 40
    assert {entry[0] for entry in begun if entry[1] == "park"} <= times
    departures = {entry[0] for entry in begun} | {e[0] for e in made.diary.of("leave", "set down")}
    assert times <= departures
