"""The question that the controller CA schedule asks, and how it is answered."""

from __future__ import annotations

from dataclasses import dataclass

from rmfs.control.asks import Answer
from rmfs.solvers.control.answers import answer
from rmfs.solvers.models import charging
from rmfs.solvers.models.charging import Charging
from rmfs.solvers.models.solution import Limits


@dataclass(frozen=True)
class Question:
    """A charging problem, and how to solve it.

    Attributes
    ----------
    method
        `greedy`, `highs` or `cp_sat`. The latter two start from the greedy solution, and are used
        only if the gap of that solution exceeds `limits.gap`.
    """

    data: Charging
    method: str
    limits: Limits


def solve(question: Question) -> Answer:
    """Schedule the stays of robots at charging places.

    The solution in the answer consists of `group`, `begin` and `length`, as in `ChargePlan`.
    """
    found = charging.solve(question.data, "greedy")
    if question.method != "greedy" and found.gap > question.limits.gap:
        found = charging.solve(question.data, question.method, question.limits, start=found.values)
    values = found.values
    return answer(found, None if values is None else dict(vars(values)))
