"""Optimisers in worker processes: the law of the clock, workers that are lost, and replay.

Lower limits are exact. The upper one allows a busy machine `LATE_S` of wall time per answer.
"""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager

import asking
import pytest
from hand_made import HandMade

from rmfs.control.asks import Outcome
from rmfs.control.problems import Problem
from rmfs.measure.dictionary import reproducible
from rmfs.measure.folder import write_run
from rmfs.simulation import simulate
from rmfs.simulation.pacing import ReplayError, pacing_settings

LATE_S = 5.0
SPEED = 10.0


class Ticks:
    """Events every simulated second, with the wall time at which they happened."""

    def __init__(self, made: HandMade, count: int) -> None:
        self.happened: list[tuple[float, float]] = []
        self._made = made
        for second in range(1, count):
            made.at(second + 0.5, self._tick)

    def _tick(self) -> None:
        self.happened.append((self._made.world.now_s, time.monotonic()))


def walled(orders_at=(1.0,), speed: float = SPEED, patience_s: float = 60.0, **parameters):
    # starting a worker takes longer than most of these tests
    workers = parameters.get("at_once", 1)
    overrides = [(["speed"], speed), (["patience_s"], patience_s), (["workers"], workers)]
    made = HandMade(
        {"robots": 1},
        pacing=pacing_settings("wall", overrides),
        poa={"name": "asking:Asking", **parameters},
    )
    made.stock(0, s0=len(orders_at))
    for at_s in orders_at:
        made.order(at_s, s0=1)
    return made, made.simulation.controller_set[Problem.POA]


def test_two_seconds_of_sleep_are_two_seconds_times_speed() -> None:
    """Asked at 1 s: told at 1 + 2 x 10 = 21 s or little later, with all events before, none after.

    While the optimiser sleeps, events happen at their wall times, never ahead of them.
    """
    made, rule = walled(sleep_s=2.0)
    ticks = Ticks(made, 500)
    before: list[int] = []
    tell = made.simulation.phase.tell
    made.simulation.phase.tell = lambda call: (before.append(len(ticks.happened)), tell(call))
    handed_over = time.monotonic()
    made.run()
    told_s = rule.told[0][0]
    assert 1.0 + 2.0 * SPEED <= told_s <= 1.0 + (2.0 + LATE_S) * SPEED
    assert [tick for tick, _ in ticks.happened[: before[0]]] == [
        tick for tick, _ in ticks.happened if tick <= told_s
    ]
    for tick_s, wall_s in ticks.happened[: before[0]]:
        # what the simulation may be ahead of the wall clock, counted from before the question
        assert tick_s - 1.0 <= (wall_s - handed_over) * SPEED
    spread_s = ticks.happened[before[0] - 1][1] - ticks.happened[0][1]
    assert spread_s > 1.0, "events have happened in wall time while the optimiser slept"


def test_two_in_flight_and_the_earlier_limit_binds() -> None:
    """Both sleep 1 s of wall time, asked at 1 s and 4 s: told at 11 s and 14 s or little later."""
    made, rule = walled((1.0, 4.0), sleep_s=1.0, at_once=2)
    ticks = Ticks(made, 500)
    open_at: list[int] = []
    made.at(6.0, lambda: open_at.append(rule.in_flight))
    made.run()
    (first_s, first), (second_s, second) = sorted(rule.told, key=lambda told: told[1].number)
    assert open_at == [2]
    assert 1.0 + SPEED <= first_s <= 1.0 + (1.0 + LATE_S) * SPEED
    assert 4.0 + SPEED <= second_s <= 4.0 + (1.0 + LATE_S) * SPEED
    assert (first.requested_us, second.requested_us) == (1_000_000, 4_000_000)
    while_open = [wall_s for tick_s, wall_s in ticks.happened if 4.0 < tick_s < first_s]
    assert len(while_open) >= 5 and while_open[-1] - while_open[0] > 0.3


@pytest.mark.parametrize(
    ("deed", "patience_s", "failure"),
    [
        ("die", 60.0, "its worker died"),
        ("raise", 60.0, "RuntimeError: no idea"),
        ("sleep", 0.3, "no answer within 0.3 s"),
    ],
)
def test_a_lost_optimiser_is_replaced_and_the_rule_decides(deed, patience_s, failure) -> None:
    """The first question is lost; the second, after the first order is done, is answered."""
    made, rule = walled(
        (1.0, 400.0),
        speed=5.0,
        patience_s=patience_s,
        deeds=[deed, "short"],
        sleep_s=30.0 if deed == "sleep" else 0.0,
    )
    if deed == "sleep":
        # only the first sleeps
        made.at(300.0, lambda: object.__setattr__(rule.parameters, "sleep_s", 0.0))
    made.run()
    lost, answered = (call for _, call in rule.told)
    assert (lost.outcome, lost.failure, lost.fallback) == (Outcome.FAILED, failure, 1)
    assert (answered.outcome, answered.applied) == (Outcome.SOLUTION, 1)
    assert made.world.orders_completed == 2


OVERRIDES = [
    (["scenario", "warmup_s"], 60),
    (["scenario", "duration_s"], 300),
    (["controllers", "poa", "name"], "asking:Asking"),
]


def whole(pacing: str, seed: int = 1, more=()):
    return simulate(
        "basic", "basic", "default", seed=seed, pacing=pacing, overrides=[*OVERRIDES, *more]
    )


def repeating(run):
    return run.footprint[[n for n in reproducible("footprint") if n in run.footprint]]


def test_a_recorded_run_is_replayed_to_the_last_bit_without_a_solver(tmp_path, monkeypatch) -> None:
    sleep = (["controllers", "poa", "sleep_s"], 0.01)
    recorded = whole("wall", more=[(["pacing", "speed"], 100.0), sleep])
    assert recorded.footprint["optimiser_calls"] > 20
    assert recorded.footprint["paced_s"] > 20 * 1.0
    folder = tmp_path / "run"
    write_run(recorded, folder)
    monkeypatch.setattr(asking, "solve", None)
    replayed = whole(f"replay={folder}", more=[sleep])
    assert repeating(replayed).equals(repeating(recorded))
    with pytest.raises(ReplayError, match="another"):
        whole(f"replay={folder}", seed=2, more=[sleep])


def test_a_replay_knows_the_answers_that_come_after_the_end_of_the_run(tmp_path) -> None:
    """Their gaps count in the recorded run, and so they do in the replay."""
    recorded = whole("fixed=45")
    late = recorded.recorder.questions[-1]
    assert late.completed_us < 0
    assert late.answer.gap_abs > 0
    folder = tmp_path / "run"
    write_run(recorded, folder)
    replayed = whole(f"replay={folder}")
    assert replayed.recorder.questions[-1].answer.gap_abs == late.answer.gap_abs
    assert repeating(replayed).equals(repeating(recorded))


def test_work_repeats() -> None:
    rates = (["pacing", "seconds_per_unit"], 0.05)
    first, second = (whole("work", more=[rates]) for _ in range(2))
    assert first.footprint["paced_s"] > 0
    assert repeating(first).equals(repeating(second))


SPIN = "import time\nend = time.monotonic() + 60\nwhile time.monotonic() < end: pass"


@contextmanager
def busy(cores: int) -> Iterator[None]:
    """Keep cores busy with something else."""
    others = [subprocess.Popen([sys.executable, "-c", SPIN]) for _ in range(cores)]
    try:
        yield
    finally:
        for other in others:
            other.kill()
            other.wait()


def test_work_repeats_with_one_core_busy_or_two() -> None:
    """What else the machine does changes the wall time of a question, and nothing of the run."""
    rates = (["pacing", "seconds_per_unit"], 0.05)
    with busy(1):
        one = repeating(whole("work", more=[rates]))
    with busy(2):
        two = repeating(whole("work", more=[rates]))
    assert one.equals(two)


@pytest.mark.slow
def test_a_real_solver_repeats_with_one_core_busy_or_two() -> None:
    """The same with CP-SAT in the loop: the joint controller of orders and pods."""
    overrides = [(["scenario", "duration_s"], 900)]
    footprints = []
    for cores in (1, 2):
        with busy(cores):
            run = simulate("small", "small", "pile-on", seed=1, pacing="work", overrides=overrides)
        footprints.append(repeating(run))
    assert footprints[0]["optimiser_calls"] > 20
    assert footprints[0].equals(footprints[1])
