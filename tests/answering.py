"""A controller whose optimiser answers what it should not."""

from __future__ import annotations

from dataclasses import dataclass
from math import nan
from typing import Any

from rmfs.control.asks import Answer, Ask
from rmfs.control.base import Parameters
from rmfs.control.decisions import AssignOrder
from rmfs.control.poa import PickOrderAssignment


@dataclass(frozen=True)
class Question:
    deed: str


def solve(question: Question) -> Any:
    """Return something else than an answer, or an answer with something else in it."""
    if question.deed == "no answer":
        return {"station": 0}
    work = nan if question.deed == "no number" else 1.0
    solution = {"place": 0} if question.deed == "no key" else {"station": 7}
    return Answer(solution, 0.0, 0.0, "optimal", "rule", work=work)


class AnsweringParameters(Parameters):
    deed: str = "no answer"


class Answering(PickOrderAssignment[AnsweringParameters]):
    """Puts orders on the station of the answer, or, without one, on the first."""

    parameters_model = AnsweringParameters
    optimisers = ("answering",)

    def __init__(self, parameters: AnsweringParameters, view: Any, rng: Any) -> None:
        super().__init__(parameters, view, rng)
        self.failures: list[str] = []

    def decide(self) -> Any:
        if not self.in_flight and len(self.view.orders):
            yield Ask(solve, Question(self.parameters.deed))

    def answered(self, call: Any) -> Any:
        station = 0 if call.solution is None else call.solution["station"]
        if call.failure:
            self.failures.append(call.failure)
        for order in list(self.view.orders):
            yield AssignOrder(order, station)
