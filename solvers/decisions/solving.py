"""Solution of questions (problem instances) with a given method, limit of work and seed."""

from __future__ import annotations

from dataclasses import replace
from time import perf_counter
from typing import TYPE_CHECKING, Any, Literal

from rmfs.errors import InputError
from rmfs.solvers.decisions.asking import asked_again
from rmfs.solvers.decisions.checking import check
from rmfs.solvers.decisions.files import Found
from rmfs.solvers.decisions.models import model_data, model_values, plain_values
from rmfs.solvers.models import families
from rmfs.solvers.models.checks import ModelError
from rmfs.solvers.models.solution import NO_LIMITS, Limits

if TYPE_CHECKING:
    from rmfs.solvers.decisions.files import Decision

AS_ASKED = "asked"
"""Name of the method that solves a question in the same way as in the run."""

_COUNTED: dict[str, Literal["nodes", "iterations"]] = {
    "highs": "nodes",
    "lns": "iterations",
    "beam": "iterations",
    "hadgs": "iterations",
}
"""Field of `Limits` in which a method counts its work, if not in deterministic seconds."""


def methods(family: str) -> tuple[str, ...]:
    """Return the names of the methods of a family, the default method first."""
    solve = families.family(family).solve
    return (solve.default, *(name for name in solve.names() if name != solve.default))


def rule(family: str) -> str:
    """Return the name of the fast heuristic of a family; empty if there is none."""
    return families.family(family).solve.rule


def limits_of(method: str, work: float | None) -> Limits:
    """Convert a limit of work to the `Limits` for a method.

    Parameters
    ----------
    method
        Name of the method.
    work
        Limit of work: in nodes for `highs`, in steps for `lns`, `beam` and `hadgs`, and in
        deterministic seconds for other methods. None: no limit.
    """
    if work is None:
        return NO_LIMITS
    field = _COUNTED.get(method)
    if field is None:
        return Limits(deterministic_s=work)
    return Limits(**{field: max(1, int(work))})


def solve(
    decision: Decision,
    method: str = "",
    *,
    work: float | None = None,
    seed: int | None = None,
    start: Found | None = None,
    guard_s: float | None = None,
    where: str = "",
) -> Found:
    """Solve a question, check the answer and return it.

    Parameters
    ----------
    decision
        The question to be solved.
    method
        Name of a method of the family, or `asked`: solve the question as in the run, regardless of
        `guard_s`. Default: `asked` if a controller of rmfs asked the question, and no `work`,
        `seed` or `start` is given; otherwise the default method of the family.
    work
        Limit of work, in the unit of the method (see `limits_of`). Default: none.
    seed
        Seed of the method. Default: 0.
    start
        Answer to start from. Default: none.
    guard_s
        Wall time, in s, after which an error is raised. Default: none.
    where
        Name of the question in error messages, such as the path of its file. Default: the name of
        the question itself.

    Raises
    ------
    InputError
        If there is no such method, if the model rejects the question, or if `asked` is combined
        with `work`, `seed` or `start`.
    WrongError
        If the answer violates a constraint, or states a wrong objective or bound.
    WallGuardError
        If the method took longer than `guard_s`.
    """
    name = where or decision.name
    plain = work is None and seed is None and start is None
    if not method:
        method = AS_ASKED if decision.asked.get("by") and plain else methods(decision.family)[0]
    began = perf_counter()
    if method == AS_ASKED:
        if not plain:
            raise InputError(
                f"{name}: method {AS_ASKED}: repeats the solution of the run and takes no limit, "
                "seed or start; name another method"
            )
        found = asked_again(decision, name)
        by = {**found.by, "method": method}
        answer = Found(found.values, found.objective, found.bound, by)
    else:
        limits = replace(limits_of(method, work), wall_guard_s=guard_s)
        answer = _by_model(decision, method, limits, seed or 0, start, name)
        answer = Found(
            answer.values, answer.objective, answer.bound, {**answer.by, "work_limit": work}
        )
    by = {**answer.by, "total_s": perf_counter() - began}
    if answer.values is not None:
        check(decision, answer)
    return Found(answer.values, answer.objective, answer.bound, by)


def _by_model(
    decision: Decision, method: str, limits: Limits, seed: int, start: Found | None, name: str
) -> Found:
    known = methods(decision.family)
    if method not in known:
        raise InputError(
            f"method {method}: unknown for {decision.family}; valid: {', '.join(known)}, {AS_ASKED}"
        )
    data = model_data(decision, name)
    first: Any = None
    if start is not None and start.values is not None:
        first = model_values(decision, start.values)
    try:
        solve = families.family(decision.family).solve
        found = solve(data, method, limits, seed=seed, start=first)
    except ModelError as error:
        raise InputError(f"{name}: {error}") from None
    by = {
        "method": method,
        "seed": seed,
        "backend": found.backend,
        "status": found.status.value,
        "work": found.work,
        "wall_s": found.wall_s,
        "build_s": found.build_s,
    }
    values = None if found.values is None else plain_values(decision.family, found.values)
    return Found(values, found.objective, found.bound, by)
