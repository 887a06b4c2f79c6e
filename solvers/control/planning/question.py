"""The question for the optimiser: the planning problem, the method, and its limits."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.solvers.control.answers import answer
from rmfs.solvers.models import planning
from rmfs.solvers.models.planning import Planning
from rmfs.solvers.models.solution import Limits

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rmfs.control.asks import Answer, Plain


@dataclass(frozen=True)
class Question:
    """The planning problem at one instant, and how it is to be solved.

    Attributes
    ----------
    data
        The planning problem, made from the state of the world.
    start
        For each station, the pods of the last plan that are not called yet and are still available.
    method, limits, seed
        Method of the search, its limits and its seed.
    bound_steps
        Number of steps of the search for a lower bound on the objective of every plan.
    """

    data: Planning
    start: tuple[tuple[int, ...], ...]
    method: str
    limits: Limits
    seed: int
    bound_steps: int


def solve(question: Question) -> Answer:
    """Solve the planning problem of a question.

    Returns
    -------
    Answer
        `pods`, shape (S, V): up to V pods to be called to each of the S stations, in sequence,
        padded with -1; `order_station` and `line_visit`, as in the model's `Plan`.
    """
    data = question.data
    found = planning.solve(
        data,
        question.method,
        question.limits,
        seed=question.seed,
        pods=question.start,
        bound_steps=question.bound_steps,
    )
    plan = found.required
    pods = np.full((data.stations, data.visits), -1)
    for station, new in enumerate(plan.pods):
        pods[station, : len(new)] = new
    values: Mapping[str, Plain] = {
        "pods": pods,
        "order_station": plan.order_station,
        "line_visit": plan.line_visit,
    }
    return answer(found, values)


def by_rule(question: Question) -> Mapping[str, Any]:
    """Return the solution of the start rule, for use when the optimiser has failed."""
    found = solve(replace(question, method="greedy", bound_steps=0)).solution
    assert found is not None
    return found
