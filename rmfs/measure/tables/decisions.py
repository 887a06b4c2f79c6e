"""The tables `decisions`, `answers` (by optimisers) and `controllers`."""

from __future__ import annotations

from collections import Counter
from math import nan
from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.measure.columns import COUNT_OR_EMPTY, INTEGER, REAL, TEXT, Column
from rmfs.measure.tables.tidy import tidy

if TYPE_CHECKING:
    from collections.abc import Callable

    import pandas as pd
    from numpy.typing import NDArray

    from rmfs.control.asks import Answer, Call
    from rmfs.measure.tables.logs import Logs

_OF_ANSWERS: dict[str, Callable[[Answer], Any]] = {
    "backend": lambda answer: answer.backend,
    "status": lambda answer: answer.status,
    "objective": lambda answer: answer.objective,
    "bound": lambda answer: answer.bound,
    "work": lambda answer: answer.work,
    "wall_s": lambda answer: answer.wall_s,
    "build_s": lambda answer: answer.build_s,
    "built": lambda answer: answer.built,
    "scale": lambda answer: answer.scale,
}
"""Columns that describe answers in the tables `decisions` and `answers`."""

_EFFORT = (
    Column(
        "work",
        REAL,
        "",
        "Effort of the solver, in a unit of the back end that does not depend on the machine",
    ),
    Column(
        "built",
        REAL,
        "",
        "Size of the solver's model (number of nonzeros); the effort of building it is not "
        "part of `work`",
    ),
)

DECISIONS = (
    Column(
        "time_s",
        REAL,
        "s",
        "Time at which the controller was called (source rule) or asked the optimiser "
        "(source optimiser)",
    ),
    Column("problem", TEXT, "", "Decision problem: roa, poa, rps, pps, psa, ta, sa, mm, ca"),
    Column(
        "source",
        TEXT,
        "",
        "rule: the row describes a call of a controller and the decisions that it made "
        "without an optimiser; optimiser: the row describes a question to an optimiser and "
        "the decisions that followed from it. The columns after `wall_s` are empty if the "
        "source is rule",
    ),
    Column(
        "decisions",
        INTEGER,
        "decisions",
        "Decisions made; if the source is optimiser, applied + fallback",
    ),
    Column("wall_s", REAL, "s", "Wall time of the call or of the answer", measured=True),
    Column("call", COUNT_OR_EMPTY, "", "Number of the question, counted from the start of the run"),
    Column("sizes", TEXT, "", "Dimensions of the question, such as orders=80"),
    Column(
        "outcome",
        TEXT,
        "",
        "solution; nothing (the optimiser ended without a solution); failed (it crashed, "
        "raised an error or exceeded its time limit); abandoned (the controller was "
        "exchanged before the answer arrived); or waiting (no answer had taken effect by the "
        "end)",
    ),
    Column("failure", TEXT, "", "Reason for the failure if the outcome is failed"),
    Column("completed_s", REAL, "s", "Time at which the answer took effect"),
    Column("paced_s", REAL, "s", "completed_s - time_s"),
    Column("backend", TEXT, "", "Back end that solved the question"),
    Column(
        "status",
        TEXT,
        "",
        "Final status as named by the solver, such as optimal, feasible, infeasible or limit",
    ),
    Column("objective", REAL, "", "Value of the solution, in the model's own unit"),
    Column("bound", REAL, "", "Proven lower bound on the value of any solution"),
    Column("gap_abs", REAL, "", "abs(objective - bound), in the unit of the objective"),
    Column(
        "gap",
        REAL,
        "share",
        "Relative gap: gap_abs divided by the cost of the pods called (pile-on models; empty "
        "if no pod is called) or by abs(objective) (other models)",
    ),
    *_EFFORT,
    Column("build_s", REAL, "s", "Wall time of building the solver's model", measured=True),
    Column(
        "solve_s", REAL, "s", "Wall time of the solver without building the model", measured=True
    ),
    Column("applied", COUNT_OR_EMPTY, "decisions", "Decisions of the solution that were applied"),
    Column(
        "stale",
        COUNT_OR_EMPTY,
        "decisions",
        "Decisions of the solution that were not applied because they were no longer valid",
    ),
    Column(
        "fallback",
        COUNT_OR_EMPTY,
        "decisions",
        "Decisions made by the controller's own rule because the optimiser failed or found nothing",
    ),
)

ANSWERS = (
    Column("call", INTEGER, "", "Number of the question, counted from the start of the run"),
    Column("problem", TEXT, "", "Decision problem of the controller that asked"),
    Column("state", TEXT, "", "Hash of the question and of the state of the simulated warehouse"),
    Column("requested_us", INTEGER, "µs", "Time of the question"),
    Column("completed_us", INTEGER, "µs", "Time at which the answer took effect; -1 if not yet"),
    Column("outcome", TEXT, "", "As in `decisions`"),
    Column("failure", TEXT, "", "As in `decisions`"),
    Column("backend", TEXT, "", "Back end that solved the question; empty without an answer"),
    Column("status", TEXT, "", "As in `decisions`; empty without an answer"),
    Column("objective", REAL, "", "Value of the solution"),
    Column("bound", REAL, "", "Proven lower bound on the value of any solution"),
    *_EFFORT,
    Column(
        "scale",
        REAL,
        "",
        "Number by which the absolute gap is divided to obtain the relative gap; if empty, "
        "abs(objective) is used",
    ),
    Column(
        "wall_s", REAL, "s", "Wall time of the answer, including building the model", measured=True
    ),
    Column("build_s", REAL, "s", "Wall time of building the model", measured=True),
    Column("solution", TEXT, "", "The solution as JSON; empty if there is none"),
)

CONTROLLERS = (
    Column("problem", TEXT, "", "Decision problem"),
    Column("calls", INTEGER, "calls", "Number of calls of the controller of the problem"),
    Column("decisions", INTEGER, "decisions", "Decisions made"),
    Column("wall_s", REAL, "s", "Wall time of all calls", measured=True),
    Column("wall_mean_s", REAL, "s", "Mean wall time of a call", measured=True),
    Column("optimiser_calls", INTEGER, "calls", "Questions to optimisers"),
    Column(
        "optimiser_decisions", INTEGER, "decisions", "Decisions based on solutions of optimisers"
    ),
    Column(
        "heuristic_decisions",
        INTEGER,
        "decisions",
        "If the controller has an optimiser: decisions made by its own rule, except those in "
        "failed_decisions; otherwise 0",
    ),
    Column(
        "stale_decisions",
        INTEGER,
        "decisions",
        "Decisions of optimisers' solutions that were not applied because they were no "
        "longer valid",
    ),
    Column(
        "failed_decisions",
        INTEGER,
        "decisions",
        "Decisions made by the controller's own rule because an optimiser failed or found nothing",
    ),
)


def decisions(logs: Logs) -> pd.DataFrame:
    """Return the calls of controllers and the questions to optimisers, one per row, by time.

    A call has a row only if the controller made decisions in it without an optimiser. Calls and
    questions of the warm-up are left out.
    """
    import pandas as pd

    calls = _calls(logs)
    names = [str(problem) for problem in logs.recorder.problems]
    rules = {
        **calls,
        "problem": pd.Categorical.from_codes(calls["problem"], pd.Index(names)),
        "source": "rule",
        "call": pd.NA,
        **dict.fromkeys(("sizes", "outcome", "failure", "backend", "status"), ""),
        **dict.fromkeys(("completed_s", "paced_s", "objective", "bound", "gap_abs", "gap"), nan),
        **dict.fromkeys(("work", "built", "build_s", "solve_s"), nan),
        **dict.fromkeys(("applied", "stale", "fallback"), pd.NA),
    }
    by_rule = tidy("decisions", DECISIONS, rules)
    asked = _measured(logs)
    if not asked:
        return by_rule
    by_optimiser = tidy("decisions", DECISIONS, _questions(asked))
    together = pd.concat([by_rule, by_optimiser], ignore_index=True)
    return together.sort_values("time_s", kind="stable", ignore_index=True)


def answers(logs: Logs) -> pd.DataFrame:
    """Return one row per question to an optimiser, including questions asked in the warm-up.

    The rows cover the warm-up because a later run with the pacing `replay` needs all answers.
    """
    asked = logs.recorder.questions
    solutions = logs.recorder.solutions
    return tidy(
        "answers",
        ANSWERS,
        {
            "call": [call.number for call in asked],
            "problem": [str(call.problem) for call in asked],
            "state": [call.state for call in asked],
            "requested_us": [call.requested_us for call in asked],
            "completed_us": [call.completed_us for call in asked],
            "outcome": [str(call.outcome) for call in asked],
            "failure": [call.failure for call in asked],
            "solution": [solutions.get(call.number, "") for call in asked],
            **_told(asked),
        },
    )


def controllers(logs: Logs) -> pd.DataFrame:
    """Return one row per decision problem whose controller was called in the measured time."""
    asked = dict(sorted(logs.recorder.asked.items()))
    calls = np.array([number for number, _ in asked.values()])
    wall_s = np.array([wall for _, wall in asked.values()])
    recorded = _calls(logs)
    problems = logs.recorder.problems
    given = np.bincount(recorded["problem"], weights=recorded["decisions"], minlength=len(problems))
    decisions = dict(zip(problems, given.tolist(), strict=True))
    questions = _measured(logs)
    counted = {
        name: _by_problem(questions, count)
        for name, count in {
            "optimiser_calls": lambda call: 1,
            "optimiser_decisions": lambda call: call.applied,
            "stale_decisions": lambda call: call.stale,
            "failed_decisions": lambda call: call.fallback,
        }.items()
    }
    based = counted["optimiser_decisions"] + counted["failed_decisions"]
    return tidy(
        "controllers",
        CONTROLLERS,
        {
            "problem": list(asked),
            "calls": calls,
            "decisions": [decisions.get(problem, 0) + based[problem] for problem in asked],
            "wall_s": wall_s,
            "wall_mean_s": wall_s / calls,
            "heuristic_decisions": [logs.recorder.by_rule.get(problem, 0) for problem in asked],
            **{name: [count[problem] for problem in asked] for name, count in counted.items()},
        },
    )


def _by_problem(questions: list[Call], count: Callable[[Call], int]) -> Counter[str]:
    totals: Counter[str] = Counter()
    for call in questions:
        totals[str(call.problem)] += count(call)
    return totals


def _measured(logs: Logs) -> list[Call]:
    """Return the questions asked in the measured time."""
    return [call for call in logs.recorder.questions if call.requested_us / 1e6 >= logs.start_s]


def _questions(asked: list[Call]) -> dict[str, Any]:
    """Return columns that describe questions."""
    told = _told(asked)
    del told["scale"]
    return {
        **told,
        "time_s": [call.requested_us / 1e6 for call in asked],
        "problem": [str(call.problem) for call in asked],
        "source": ["optimiser"] * len(asked),
        "decisions": [call.applied + call.fallback for call in asked],
        "call": [call.number for call in asked],
        "sizes": [" ".join(f"{k}={v}" for k, v in call.ask.sizes.items()) for call in asked],
        "outcome": [str(call.outcome) for call in asked],
        "failure": [call.failure for call in asked],
        "completed_s": [
            nan if call.completed_us < 0 else call.completed_us / 1e6 for call in asked
        ],
        "paced_s": [call.paced_s for call in asked],
        "gap_abs": [nan if call.answer is None else call.answer.gap_abs for call in asked],
        "gap": [nan if call.answer is None else call.answer.gap for call in asked],
        "solve_s": np.array(told["wall_s"]) - np.array(told["build_s"]),
        "applied": [call.applied for call in asked],
        "stale": [call.stale for call in asked],
        "fallback": [call.fallback for call in asked],
    }


def _told(asked: list[Call]) -> dict[str, list[Any]]:
    """Return columns that describe answers; empty for questions without an answer."""
    empty = dict.fromkeys(_OF_ANSWERS, nan) | {"backend": "", "status": ""}
    return {
        name: [empty[name] if call.answer is None else tell(call.answer) for call in asked]
        for name, tell in _OF_ANSWERS.items()
    }


def _calls(logs: Logs) -> dict[str, NDArray[Any]]:
    """Return the calls of the measured time."""
    calls = logs.recorder.calls.columns()
    now = calls["time_s"] >= logs.start_s
    return {name: column[now] for name, column in calls.items()}
