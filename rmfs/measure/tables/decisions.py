"""The tables of decisions, answers of optimisers, and controllers."""

from __future__ import annotations

from collections import Counter
from math import nan
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from rmfs.measure.tables.tidy import tidy

if TYPE_CHECKING:
    from collections.abc import Callable

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
}
"""What both tables of questions tell of an answer."""


def decisions(logs: Logs) -> pd.DataFrame:
    """One row per call of a controller that came to a decision, and one per question it asked."""
    calls = _calls(logs)
    names = [str(problem) for problem in logs.recorder.problems]
    rules = {
        **calls,
        "problem": pd.Categorical.from_codes(calls["problem"], pd.Index(names)),
        "source": "rule",
        "call": pd.NA,
        **dict.fromkeys(("sizes", "outcome", "failure", "backend", "status"), ""),
        **dict.fromkeys(("completed_s", "paced_s", "objective", "bound", "gap"), nan),
        **dict.fromkeys(("work", "build_s", "solve_s"), nan),
        **dict.fromkeys(("applied", "stale", "fallback"), pd.NA),
    }
    by_rule = tidy("decisions", rules)
    asked = _measured(logs)
    if not asked:
        return by_rule
    by_optimiser = tidy("decisions", _questions(asked))
    together = pd.concat([by_rule, by_optimiser], ignore_index=True)
    return together.sort_values("time_s", kind="stable", ignore_index=True)


def answers(logs: Logs) -> pd.DataFrame:
    """One row per question to an optimiser, warm-up included: what a replay needs."""
    asked = logs.recorder.questions
    solutions = logs.recorder.solutions
    return tidy(
        "answers",
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
    """One row per decision problem whose controller was asked in the measured time."""
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
    """Questions asked in the measured time."""
    return [call for call in logs.recorder.questions if call.requested_us >= logs.start_s * 1e6]


def _questions(asked: list[Call]) -> dict[str, Any]:
    """Columns of the rows of questions."""
    told = _told(asked)
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
        "gap": [nan if call.answer is None else call.answer.gap for call in asked],
        "solve_s": np.array(told["wall_s"]) - np.array(told["build_s"]),
        "applied": [call.applied for call in asked],
        "stale": [call.stale for call in asked],
        "fallback": [call.fallback for call in asked],
    }


def _told(asked: list[Call]) -> dict[str, list[Any]]:
    """Return what answers tell of themselves; empty where there is none."""
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
