"""What an optimiser may not answer, and who is named when a decision is not possible."""

from __future__ import annotations

from math import inf, isnan, nan

import pytest
from hand_made import HandMade

from rmfs.control.asks import Answer, checked
from rmfs.errors import RuleError
from rmfs.simulation.pacing import OptimiserError, pacing_settings


def run(pacing: str, **parameters: object) -> HandMade:
    """Let two orders arrive at 1 s."""
    made = HandMade(
        {"robots": 1},
        pacing=pacing_settings(pacing, [(["workers"], 1)] if pacing == "wall" else []),
        poa={"name": "answering:Answering", **parameters},
    )
    made.stock(0, s0=2)
    for _ in range(2):
        made.order(1.0, s0=1)
    made.run()
    return made


@pytest.mark.parametrize(
    ("numbers", "complaint"),
    [
        ({"work": nan}, "work must be a finite number, 0 or more; it is nan"),
        ({"work": -1.0}, "work must be a finite number"),
        ({"built": inf}, "built must be a finite number"),
        ({"objective": nan}, "objective must be a number, or inf if it is unknown; it is nan"),
        ({"objective": 1.0, "bound": 2.0}, "bound 2.0 exceeds the objective 1.0"),
        ({"solution": [1, 2]}, "solution must map names to values, or be None; it is a list"),
    ],
)
def test_an_answer_checks_itself(numbers: dict[str, object], complaint: str) -> None:
    given = {"solution": {}, "objective": 0.0, "bound": 0.0} | numbers
    with pytest.raises((TypeError, ValueError), match=complaint):
        Answer(status="optimal", backend="rule", **given)  # type: ignore[arg-type]


def test_a_bound_may_pass_the_objective_by_rounding() -> None:
    assert Answer({}, 1e6, 1e6 + 0.5, "optimal", "highs").gap < 1e-6


def test_a_gap_is_held_against_the_scale() -> None:
    """Of an objective near zero the relative gap would mean nothing."""
    answer = Answer({}, -0.01, -20.0, "feasible", "cp_sat", scale=80.0)
    assert answer.gap_abs == pytest.approx(19.99)
    assert answer.gap == pytest.approx(19.99 / 80.0)
    assert Answer({}, -0.01, -20.0, "feasible", "cp_sat").gap == pytest.approx(1999.0)
    assert isnan(Answer({}, 0.0, -20.0, "feasible", "cp_sat").gap)
    assert Answer({}, 0.0, 0.0, "optimal", "cp_sat").gap == 0.0
    assert isnan(Answer(None, inf, -20.0, "limit", "cp_sat").gap_abs)
    assert isnan(Answer({}, inf, -20.0, "feasible", "cp_sat").gap)


def test_what_is_no_answer_is_refused() -> None:
    with pytest.raises(TypeError, match="must return an Answer; it returned dict"):
        checked({"order": [0]})


@pytest.mark.parametrize("deed", ["no answer", "no number"])
def test_a_wrong_answer_ends_a_run_that_must_repeat_with_the_controller_named(deed: str) -> None:
    with pytest.raises(OptimiserError, match=r"poa \(Answering\) at 1.000 s: \w+Error: "):
        run("instant", deed=deed)


@pytest.mark.parametrize("deed", ["no answer", "no number"])
def test_a_wrong_answer_of_a_worker_is_a_failure(deed: str) -> None:
    made = run("wall", deed=deed)
    assert (
        made.simulation.controller_set["poa"]
        .failures[0]
        .startswith(("TypeError: ", "ValueError: "))
    )
    assert made.world.orders_completed == 2


def test_a_solution_without_the_key_that_is_read_names_the_controller() -> None:
    with pytest.raises(KeyError) as told:
        run("instant", deed="no key")
    assert "poa" in told.value.__notes__[0]
    assert "(Answering) at 1.000 s" in told.value.__notes__[0]


def test_an_impossible_decision_names_the_controller() -> None:
    with pytest.raises(RuleError, match=r"poa Answering at 1.000 s: .* there is no pick station 7"):
        run("instant", deed="no such station")
