"""The question for the worker: a snapshot, who decides, and for how long."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rmfs.control.asks import Answer
from rmfs.solvers.models.pile_on import (
    Assignment,
    Candidates,
    PileOn,
    Pruning,
    everything,
    greedy,
    hadgs,
    neighbourhood,
    objective,
    prices,
    prune,
)
from rmfs.solvers.models.solution import Limits, Solution

if TYPE_CHECKING:
    from collections.abc import Mapping

SCORED_PER_S = 1e7
"""Candidates that a rule scores in about a deterministic second."""


@dataclass(frozen=True)
class Question:
    """What is to be decided.

    Attributes
    ----------
    data
        The snapshot.
    may_call
        Stations to which pods may be called, shape (S,); the others only use what comes anyway.
    method
        `joint`, `greedy` or `hadgs`.
    limits, pruning
        Of CP-SAT.
    bound_steps
        Steps of the search for a bound.
    """

    data: PileOn
    may_call: NDArray[np.bool_]
    method: str
    limits: Limits
    pruning: Pruning
    bound_steps: int


def solve(question: Question) -> Answer:
    """Decide: a rule first, then CP-SAT from there, a few stations at a time.

    Parameters
    ----------
    question
        What is to be decided.

    Returns
    -------
    Answer
        `station` and `prospect` of each order, `pod_station` and `pod_robot` of each pod; -1 for
        none. The bound is one of all decisions that the snapshot allows.
    """
    began = time.perf_counter()
    data = question.data
    rule = hadgs if question.method == "hadgs" else greedy
    found = rule.solve(data, candidates=_allowed(everything(data), question.may_call))
    if question.method == "joint":
        return _improved(question, found, began)
    return _answer(question, found.required, "rule", found.work, began, 0.0)


def by_rule(question: Question) -> Mapping[str, Any]:
    """Decide by pod match alone, when the optimiser has failed; as `Answer.solution`."""
    found = solve(replace(question, method="greedy", bound_steps=0)).solution
    assert found is not None
    return found


def _improved(question: Question, rule: Solution[Assignment], began: float) -> Answer:
    data = question.data
    candidates = _allowed(prune(data, question.pruning), question.may_call)
    found = neighbourhood.solve(
        data, question.limits, start=rule.required, candidates=candidates.including(rule.required)
    )
    work = found.work + rule.work / SCORED_PER_S
    return _answer(question, found.required, "cp_sat", work, began, found.build_s)


def _allowed(candidates: Candidates, may_call: NDArray[np.bool_]) -> Candidates:
    """Leave out calls to stations that need no pod."""
    return Candidates(candidates.calls & may_call, candidates.places, candidates.fetches)


def _answer(
    question: Question,
    values: Assignment,
    backend: str,
    work: float,
    began: float,
    build_s: float,
) -> Answer:
    station = np.where(values.slot.any(axis=1), values.slot.argmax(axis=1), -1)
    solution = {
        "station": station,
        "prospect": values.prospect,
        "pod_station": values.pod_station,
        "pod_robot": values.pod_robot,
    }
    cost = objective(question.data, values)
    bound = prices.bound(question.data, cost, question.bound_steps)
    return Answer(
        solution=solution,
        objective=cost,
        bound=bound,
        status="optimal" if bound == cost else "feasible",
        backend=backend,
        work=work,
        wall_s=time.perf_counter() - began,
        build_s=build_s,
    )
