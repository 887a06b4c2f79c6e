"""Proven bounds on the objective of a question, by several methods."""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING

from rmfs.solvers.decisions.exact import exact
from rmfs.solvers.decisions.models import model_data
from rmfs.solvers.decisions.solving import limits_of, methods, rule
from rmfs.solvers.models import families, pile_on, planning
from rmfs.solvers.models.backends import highs
from rmfs.solvers.models.checks import ModelError
from rmfs.solvers.models.solution import Limits, WallGuardError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.solvers.decisions.files import Decision

STEPS = 400
"""Number of subgradient steps of Lagrangian bounds."""

_SEARCH = {"pile_on": "cp_sat", "planning": "cp_sat", "sequence": "columns"}
"""Method whose own bound is used, for families in which it is not the default method."""

_LARGEST = 4_000_000
"""Nonzeros of the largest program whose relaxation is solved."""

_LARGE = 50_000
"""Nonzeros beyond which the relaxation is solved by an interior-point method."""


def bounds(
    decision: Decision,
    work: float,
    where: str = "",
    *,
    guard_s: float | None = None,
    search: bool = True,
) -> Iterator[tuple[str, float]]:
    """Yield the name of each method with its bound; methods without a bound are left out.

    A question has no solution if its bound is inf (-inf if the objective is maximised). The exact
    search is left out, too, if the solver refuses the integer program, for example because costs
    are huge.

    Parameters
    ----------
    decision
        The question whose answers are bounded.
    work
        Limit of the exact search, in the unit in which its method counts work.
    where
        Name of the question in error messages, such as the path of its file. Default:
        `decision.name`.
    guard_s
        Wall time after which the relaxation, or the search, is given up, in s. Default: none.
    search
        Whether the exact search is run as well. Default: yes.
    """
    guard = Limits(wall_guard_s=guard_s)
    data, family = model_data(decision, where), decision.family
    if family == "pile_on":
        first = pile_on.solve(data, "greedy")
        yield from _known(decision, "prices", pile_on.bounded(data, first, STEPS).bound)
    stated = None if family in ("zones", "run_bound") else exact(decision, where)
    if stated is not None and stated.program.nonzeros <= _LARGEST:
        with suppress(WallGuardError):
            interior = stated.program.nonzeros > _LARGE
            relaxed = highs.relax(stated.program, guard, interior=interior)
            yield from _known(decision, "relaxation", relaxed.bound * stated.factor)
    elif family == "planning":  # whose prices say less than its relaxation
        yield from _known(
            decision, "prices", planning.solve(data, "greedy", bound_steps=STEPS).bound
        )
    if not search:
        return
    method = _SEARCH.get(family, methods(family)[0])
    given = families.family(family).solve
    limits = replace(limits_of(method, work), wall_guard_s=guard_s)
    with suppress(WallGuardError, ModelError):
        start = given(data, rule(family)).values if rule(family) else None
        yield from _known(decision, method, given(data, method, limits, start=start).bound)


def best(
    decision: Decision,
    work: float,
    where: str = "",
    *,
    guard_s: float | None = None,
    search: bool = True,
) -> tuple[str, float]:
    """Return the name of the method with the best bound, and this bound.

    If no method finds a bound, the name is "" and the bound is nan.

    Parameters
    ----------
    decision, work, where, guard_s, search
        As for `bounds`.
    """
    found = list(bounds(decision, work, where, guard_s=guard_s, search=search))
    if not found:
        return "", math.nan
    return max(found, key=lambda one: one[1] * decision.sign)


def _known(decision: Decision, name: str, bound: float) -> Iterator[tuple[str, float]]:
    if bound * decision.sign > -math.inf:
        yield name, bound
