"""The question for the optimiser: a snapshot, the method, and its limits."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.solvers.control.answers import answer
from rmfs.solvers.models import pile_on
from rmfs.solvers.models.pile_on import PileOn, Pruning
from rmfs.solvers.models.pile_on.values import cost_of_calls
from rmfs.solvers.models.solution import Limits

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rmfs.control.asks import Answer


@dataclass(frozen=True)
class Question:
    """The decision problem at one instant.

    Attributes
    ----------
    data
        Snapshot of the orders, stations, pods and robots.
    method
        `joint`, `cp_sat`, `greedy` or `hadgs`.
    limits, pruning
        Limits on the search of CP-SAT (`limits`), and on the number of candidates that CP-SAT
        considers, such as pods for each station (`pruning`).
    bound_steps
        Number of steps of the search for a lower bound on the cost of every decision.
    """

    data: PileOn
    method: str
    limits: Limits
    pruning: Pruning
    bound_steps: int


def solve(question: Question) -> Answer:
    """Solve the problem.

    Parameters
    ----------
    question
        The decision problem.

    Returns
    -------
    Answer
        For each order (or line, if orders are split): `station`, at which it gets a slot, and
        `prospect`, the station whose pods can serve it although it gets no slot now. For each pod:
        `pod_station`, to which it is called, and `pod_robot`, the robot that fetches it. A value of
        -1 means none. The bound is valid for all decisions that the snapshot allows.
    """
    data = question.data
    if question.method == "joint":
        options: dict[str, Any] = {
            "pruning": question.pruning,
            "bound_steps": question.bound_steps,
        }
        found = pile_on.solve(data, "joint", question.limits, **options)
    elif question.method == "cp_sat":
        start = pile_on.solve(data, "greedy").required
        limits = Limits(gap=question.limits.gap)
        found = pile_on.solve(data, "cp_sat", limits, start=start)
    else:
        rule = pile_on.solve(data, question.method)
        found = pile_on.bounded(data, rule, question.bound_steps)
    values = found.required
    solution = {
        "station": np.where(values.slot.any(axis=1), values.slot.argmax(axis=1), -1),
        "prospect": values.prospect,
        "pod_station": values.pod_station,
        "pod_robot": values.pod_robot,
    }
    return answer(found, solution, cost_of_calls(data, values))


def by_rule(question: Question) -> Mapping[str, Any]:
    """Return the solution of the method `greedy`, for use when the optimiser has failed."""
    found = solve(replace(question, method="greedy", bound_steps=0)).solution
    assert found is not None
    return found
