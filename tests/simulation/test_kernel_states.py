"""Stepping, deciding and forking in any order: the world stays sound, and forks end alike."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import (
    RuleBasedStateMachine,
    initialize,
    invariant,
    precondition,
    rule,
    run_state_machine_as_test,
)
from test_stepping import told

import rmfs
from rmfs.simulation.decision import ImpossibleError
from rmfs.world import verify

PROBLEMS = ("poa", "roa", "rps", "pps", "psa", "ta", "sa")
END_S = 150.0
LONGEST_TURN = 400


class Kernel(RuleBasedStateMachine):
    """One simulation, decided from outside at random, and the copies made of it on the way."""

    @initialize(
        outside=st.sets(st.sampled_from(PROBLEMS), max_size=3),
        seed=st.integers(0, 2**63 - 1),
        controllers=st.sampled_from(["default", "random"]),
    )
    def begin(self, outside: set[str], seed: int, controllers: str) -> None:
        """Begin a run of five robots."""
        given = {"layout.robots": 5, "scenario.warmup_s": 20, "scenario.duration_s": END_S - 20}
        self.run = rmfs.Simulation(
            "basic", "basic", controllers, seed=seed, set=given, outside=sorted(outside), trace=True
        )
        self.forks: list[tuple[rmfs.Simulation, list[tuple[str, Any]]]] = []

    def both(self, what: str, given: Any) -> None:
        """Do it, and note it for the copies."""
        for _, done in self.forks:
            done.append((what, given))
        _do(self.run, what, given)

    @rule(seconds=st.floats(0.0, 40.0, allow_subnormal=False))
    def go_on(self, seconds: float) -> None:
        """Go on for a while, or to the next decision."""
        self.both("until", min(self.run.now_s + seconds, END_S))

    @rule(number=st.integers(0, 5))
    def decide(self, number: int) -> None:
        """Take one of the candidates, or decline."""
        self.both("decide", number)

    @rule()
    @precondition(lambda self: len(self.forks) < 3)
    def fork(self) -> None:
        """Make a copy, which is to catch up at the end."""
        self.forks.append((self.run.fork(), []))

    @rule()
    def answer_nonsense(self) -> None:
        """Nothing changes by it."""
        decision = self.run.step()
        for _, done in self.forks:
            done.append(("step", None))
        if decision is None:
            return
        before = told(self.run)
        with pytest.raises(ImpossibleError):
            decision.answer(object())
        assert told(self.run) == before
        assert decision.is_open

    @invariant()
    def the_world_is_sound(self) -> None:
        """Its own rules hold."""
        if hasattr(self, "run"):
            verify(self.run.world)

    def teardown(self) -> None:
        """Let all go on to the end, by the same answers."""
        if not hasattr(self, "run"):
            return
        _finish(self.run)
        end = told(self.run)
        for fork, done in self.forks:
            for what, given in done:
                _do(fork, what, given)
            _finish(fork)
            assert told(fork) == end


def _do(run: rmfs.Simulation, what: str, given: Any) -> None:
    if what == "step":
        run.step()
    elif what == "until":
        run.run_until(given)
    elif (decision := run.step()) is not None:
        _answer(decision, given)


def _answer(decision: Any, number: int) -> None:
    if number < len(decision.candidates):
        decision.answer(decision.candidates[number])
    elif decision.kind == "next station":
        decision.answer(decision.stations[0])
    else:
        decision.decline()


def _finish(run: rmfs.Simulation) -> None:
    """Take the first candidate of a turn, then decline, to the end."""
    turn = 0
    while (decision := run.step()) is not None:
        turn += 1
        _answer(decision, 0 if turn % 2 else 10**6)
        assert turn < LONGEST_TURN * 50


def _tried(examples: int) -> None:
    run_state_machine_as_test(
        Kernel,
        settings=settings(
            max_examples=examples,
            stateful_step_count=15,
            deadline=None,
            derandomize=True,
            suppress_health_check=list(HealthCheck),
        ),
    )


def test_any_order_of_steps() -> None:
    _tried(6)


@pytest.mark.slow
def test_any_order_of_many_steps() -> None:
    _tried(300)
