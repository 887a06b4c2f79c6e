"""How answers get better with work: anytime profiles, primal gaps and primal integrals.

A method is deterministic: what it has found after the work W is what it finds under the limit W.
So a profile is a row of runs with limits that double, each timed by itself; nothing is restarted
within one.

The primal gap of a value v against the best known one b is 0 if both are 0, 1 if their signs
differ, and ``|v - b| / max(|v|, |b|)`` otherwise; it is 1 while there is none (Berthold 2013,
Measuring the impact of primal heuristics). The primal integral is its integral over time up to the
end of the longest run, as a share of that time: 0 is perfect, 1 is nothing found.
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
"""Smallest limit, by what a method counts."""

UNLIMITED = frozenset(
    {"assignment", "flow", "greedy", "dynamic", "clarabel", "rounding"},
)
"""Methods that run to their end whatever the limit: one point is their profile."""


def limits(method: str, most: float) -> list[float]:
    """Return limits of work that double, up to `most`.

    Parameters
    ----------
    method
        Who solves.
    most
        The last one; in the unit of the method.
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
    """Yield a row for every limit and seed.

    Parameters
    ----------
    decision
        The question.
    method
        Who solves.
    most
        Largest limit of work.
    seeds
        Of the method. Default: 0.
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
    """Return the primal gap of a value; 1 for nan.

    Parameters
    ----------
    value
        What was found; nan for nothing.
    best
        The best known value.
    """
    if math.isnan(value) or math.isnan(best):
        return 1.0
    if value == best:
        return 0.0
    if value * best < 0.0:
        return 1.0
    return abs(value - best) / max(abs(value), abs(best))


def primal_integral(steps: Iterable[tuple[float, float]], end: float) -> float:
    """Return the mean primal gap from 0 to the end.

    Parameters
    ----------
    steps
        Time, or work, and primal gap then; in any order.
    end
        Where it ends; positive.
    """
    total, gap, since = 0.0, 1.0, 0.0
    for time, found in sorted(steps):
        if time >= end:
            break
        if found < gap:
            total += gap * (time - since)
            gap, since = found, time
    return (total + gap * (end - since)) / end
