"""Quality of answers over work: anytime profiles, primal gaps and primal integrals.

Methods are deterministic, so the best answer after work W is the answer of a run with the limit W.
A profile therefore consists of separately timed runs, each with twice the limit of the one before.

The primal gap of a value v against the best known value b is 0 if both are 0, 1 if their signs
differ, and ``|v - b| / max(|v|, |b|)`` otherwise; it is 1 while there is no value (Berthold 2013,
Measuring the impact of primal heuristics). The primal integral is the mean of the gap over time,
from 0 to the end of the longest run of any method, or over work, from 0 to the method's largest
limit. A primal integral of 0 is perfect; 1 means that nothing was found.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from rmfs.solvers.decisions.solving import limits_of, solve
from rmfs.solvers.models import WallGuardError
from rmfs.solvers.models.solution import NO_LIMITS

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rmfs.solvers.decisions.files import Decision

FIRST = {"deterministic_s": 0.001, "nodes": 1, "iterations": 1}
"""Smallest limit, by the unit in which a method counts work."""

UNLIMITED = frozenset(
    {"assignment", "flow", "greedy", "dynamic", "clarabel", "rounding"},
)
"""Methods that ignore limits; their profile has one point."""


def limits(method: str, most: float) -> list[float]:
    """Return limits of work, each twice the one before, up to `most`.

    For methods that ignore limits (`UNLIMITED`), return only `most`.

    Parameters
    ----------
    method
        Name of the method.
    most
        Largest limit allowed, in the unit in which the method counts work.
    """
    if method in UNLIMITED:
        return [most]
    counted = limits_of(method, 1.0)
    field = next(name for name in FIRST if getattr(counted, name) != getattr(NO_LIMITS, name))
    found = [float(FIRST[field])]
    while found[-1] * 2 <= most:
        found.append(found[-1] * 2)
    return found


def points(
    decision: Decision, method: str, most: float, seeds: Sequence[int] = (0,)
) -> Iterator[dict[str, Any]]:
    """Solve a question with each limit and each seed, and yield a row for each run.

    Parameters
    ----------
    decision
        The question to be solved.
    method
        Name of the method.
    most
        Largest limit of work.
    seeds
        Seeds of the method. Default: 0.
    """
    for seed in seeds:
        for work in limits(method, most):
            try:
                found = solve(decision, method, work=work, seed=seed)
            except WallGuardError:
                continue
            yield {
                "question": decision.name,
                "family": decision.family,
                "method": method,
                "seed": seed,
                "work_limit": work,
                "work": found.by["work"],
                "build_s": found.by["build_s"],
                "solve_s": found.by["wall_s"] - found.by["build_s"],
                "wall_s": found.by["wall_s"],
                "status": found.by["status"],
                "value": found.objective if found.values is not None else math.nan,
                "bound": found.bound if math.isfinite(found.bound) else math.nan,
            }


def primal_gap(value: float, best: float) -> float:
    """Return the primal gap of a value; 1 if the value or the best known value is nan.

    Parameters
    ----------
    value
        The value found; nan if none was.
    best
        The best known value; nan if none is known.
    """
    if math.isnan(value) or math.isnan(best):
        return 1.0
    if value == best:
        return 0.0
    if value * best < 0.0:
        return 1.0
    return abs(value - best) / max(abs(value), abs(best))


def primal_integral(steps: Iterable[tuple[float, float]], end: float) -> float:
    """Return the primal integral: the mean of the smallest gap so far, from 0 to the end.

    Parameters
    ----------
    steps
        Pairs of a time (or amount of work) and the primal gap of the answer found by then, in any
        order. Before the first answer, the gap is 1.
    end
        End of the integral; positive.
    """
    total, gap, since = 0.0, 1.0, 0.0
    for time, found in sorted(steps):
        if time >= end:
            break
        if found < gap:
            total += gap * (time - since)
            gap, since = found, time
    return (total + gap * (end - since)) / end
