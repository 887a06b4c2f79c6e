"""What an answer costs in simulated time, and what becomes of it, where runs repeat.

The optimiser of `asking` works one unit per order that waits.
"""

from __future__ import annotations

from math import nan
from pathlib import Path

import numpy as np
import pytest
from hand_made import HandMade

from rmfs.control.asks import Call, Outcome
from rmfs.control.choices import choose
from rmfs.control.problems import Problem
from rmfs.control.solutions import from_text, to_text
from rmfs.errors import InputError
from rmfs.observer import Observer
from rmfs.simulation.pacing import OptimiserError, pacing_settings
from rmfs.simulation.pacing.computed import SECONDS_PER_CALL, SECONDS_PER_UNIT


def asked(pacing: str, overrides=(), orders: int = 2, **parameters):
    """Let orders arrive at 1 s and return the controller with what it was told, and the orders."""
    made = HandMade(
        {"robots": 1},
        pacing=pacing_settings(pacing, overrides),
        poa={"name": "asking:Asking", **parameters},
    )
    made.stock(0, s0=orders)
    for _ in range(orders):
        made.order(1.0, s0=1)
    made.run()
    return made.simulation.controller_set[Problem.POA], made


def test_instant_answers_are_applied_before_the_controller_goes_on() -> None:
    rule, made = asked("instant", rule_meanwhile=True)
    assert [(time_s, call.paced_s) for time_s, call in rule.told] == [(1.0, 0.0)]
    assert rule.told[0][1].applied == 2
    assert made.world.orders_completed == 2


@pytest.mark.parametrize(
    ("pacing", "overrides", "expected_s"),
    [
        ("fixed=5", (), 5.0),
        ("fixed=0", (), 0.0),
        ("work", [(["seconds_per_unit"], 1.5), (["seconds_per_call"], 0.25)], 3.25),
        ("work", [(["seconds_per_unit", "rule"], 2.0), (["seconds_per_call"], 0.0)], 4.0),
    ],
)
def test_an_answer_takes_the_time_of_its_mode(pacing, overrides, expected_s) -> None:
    rule, made = asked(pacing, overrides)
    time_s, call = rule.told[0]
    assert (time_s, call.paced_s) == (1.0 + expected_s, expected_s)
    assert [order.assigned_s for order in made.ledger.orders.values()] == [time_s] * 2


def test_by_default_a_call_and_a_unit_take_what_was_measured() -> None:
    """Two units of work of the back end `rule`, to the microsecond above."""
    rule, _ = asked("work")
    expected_s = SECONDS_PER_CALL["rule"] + 2 * SECONDS_PER_UNIT["rule"]
    assert expected_s <= rule.told[0][1].paced_s < expected_s + 2e-6


def test_a_distribution_is_drawn_from_the_seed() -> None:
    table = {"distribution": "exponential", "rate": 0.5}
    first, second = (asked("fixed", [(["seconds"], table)])[0].told[0][0] for _ in range(2))
    assert first == second > 1.0


@pytest.mark.parametrize("pacing", ["fixed=700", "work"])
def test_a_question_without_an_answer_by_the_end_is_waiting(pacing) -> None:
    """Questions are solved when they are asked, but the answer comes after 600 s."""
    asked_calls: list[Call] = []

    class Noting(Observer):
        def optimiser_asked(self, call: Call) -> None:
            asked_calls.append(call)

    overrides = [(["seconds_per_call"], 700.0)] if pacing == "work" else []
    made = HandMade(
        {"robots": 1},
        observers=(Noting(),),
        pacing=pacing_settings(pacing, overrides),
        poa={"name": "asking:Asking"},
    )
    made.order(1.0, s0=1)
    made.run()
    (call,) = asked_calls
    assert (call.outcome, call.completed_us) == (Outcome.WAITING, -1)


def test_what_the_rule_did_meanwhile_is_stale() -> None:
    rule, _ = asked("fixed=5", rule_meanwhile=True)
    call = rule.told[0][1]
    assert (call.applied, call.stale, call.outcome) == (0, 2, Outcome.SOLUTION)


def test_without_a_solution_the_rule_decides() -> None:
    rule, made = asked("fixed=5", deeds=["nothing"])
    call = rule.told[0][1]
    assert (call.outcome, call.fallback, call.applied) == (Outcome.NOTHING, 2, 0)
    assert made.world.orders_completed == 2


def test_an_error_ends_a_run_that_must_repeat() -> None:
    with pytest.raises(
        OptimiserError,
        match=r"poa \(Asking\) at 1\.000 s: RuntimeError: no idea \(.*asking.py, line",
    ) as told:
        asked("work", deeds=["raise"])
    path, line = str(told.value).rpartition(" (")[2].removesuffix(")").split(", line ")
    assert "no idea" in Path(path).read_text().splitlines()[int(line) - 1]


def test_an_exchanged_controller_is_not_told() -> None:
    made = HandMade(pacing=pacing_settings("fixed=5"), poa={"name": "asking:Asking"}, scenario={})
    made.stock(0, s0=1)
    made.order(1.0, s0=1)
    former = made.simulation.controller_set[Problem.POA]
    choice = choose(Problem.POA, {"name": "first-come"}, "test")
    made.at(2.0, lambda: made.simulation.phase.exchange(choice))
    made.run()
    assert former.told == [] and former.in_flight == 0
    assert made.world.orders_completed == 1


@pytest.mark.parametrize(
    ("mode", "overrides", "message"),
    [
        ("slow", (), "pacing slow: unknown mode; valid: instant, wall, work, fixed, replay"),
        ("instnt", (), "did you mean instant?"),
        ("wall=3", (), "wall takes no value after ="),
        ("fixed=-1", (), "pacing fixed: seconds: Input should be greater than or equal to 0 ("),
        ("fixed=soon", (), "pacing fixed: seconds: Input should be a valid number, "),
        ("replay", (), "pacing replay: must have a value, as in replay=RUN_DIR"),
        ("wall", [(["sped"], 2)], "unknown key sped; did you mean speed?"),
        ("wall", [(["speed"], 0)], "pacing wall: speed"),
    ],
)
def test_mistakes_are_named(mode, overrides, message) -> None:
    with pytest.raises(InputError) as error:
        pacing_settings(mode, overrides)
    assert message in str(error.value)
    assert "[" not in str(error.value)  # no names of alternatives from inside the library


def test_solutions_are_kept_to_the_last_bit() -> None:
    solution = {
        "pods": np.array([[3, 1], [2, 0]], dtype=np.int32),
        "share": np.array([0.1, nan, np.inf]),
        "open": np.array([True, False]),
        "none": np.zeros((0, 3)),
        "text": "two words",
        "nested": [1, 2.5, [np.arange(2)]],
    }
    read = from_text(to_text(solution))
    for name in ("pods", "share", "open", "none"):
        assert read[name].dtype == solution[name].dtype
        assert read[name].shape == solution[name].shape
        np.testing.assert_array_equal(read[name], solution[name])
    assert read["text"] == "two words"
    assert read["nested"][:2] == [1, 2.5] and read["nested"][2][0].tolist() == [0, 1]
    with pytest.raises(TypeError, match="contains a set"):
        to_text({"pods": {1, 2}})
