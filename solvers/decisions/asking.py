"""Converts questions of controllers to `Decision`s, and solves these again as in the run."""

from __future__ import annotations

from dataclasses import fields
from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.errors import InputError
from rmfs.solvers.control.answers import answer
from rmfs.solvers.decisions.files import Decision, Found
from rmfs.solvers.decisions.models import family_of, model_data, plain_data, plain_of, plain_values
from rmfs.solvers.models.pile_on import Pruning
from rmfs.solvers.models.solution import Limits
from rmfs.solvers.models.tasks import matching

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from rmfs.control.asks import Answer

ASKERS = {
    "pile-on": "pile_on.question",
    "planning": "planning.question",
    "dispatch": "tasks.dispatch",
    "routes": "tasks.routes",
    "stocking": "stocking",
    "placement": "storage.placement",
    "prices": "storage.prices",
    "stays": "storage.stays",
    "schedule": "charging.question",
}
"""Modules of `rmfs.solvers.control` that define a `Question` and its `solve`, by name."""

_MATCHING = "matching"
"""Name for TA dispatch with the method `matching`, whose questions are of the family `matching`."""

_MADE: Mapping[str, Callable[[Any], Any]] = {
    "limits": lambda given: Limits(**given),
    "pruning": lambda given: Pruning(**given),
    "waypoint": lambda given: np.array(given, np.int64),
    "start": lambda given: tuple(map(tuple, given)),
}
"""Conversion from JSON of the settings of a question that are neither numbers nor texts."""


def question_of(question: object) -> Decision | None:
    """Convert a question of a run to a `Decision`; None if no family covers its data."""
    data = getattr(question, "data", None)
    family = family_of(data)
    if data is None or family is None:
        return None
    by = next((name for name in ASKERS if _module(name).Question is type(question)), "")
    if by == "dispatch" and getattr(question, "method", "") == _MATCHING:
        return Decision(_MATCHING, plain_data(_MATCHING, data.pairs), asked={"by": _MATCHING})
    asked: dict[str, Any] = {}
    if by:
        others = [one.name for one in fields(question) if one.name != "data"]  # type: ignore[arg-type]
        asked = {"by": by, **{name: plain_of(getattr(question, name)) for name in others}}
    return Decision(family, plain_data(family, data), asked=asked)


def asked_again(decision: Decision, where: str = "") -> Found:
    """Solve a question in the same way as in the run.

    Raises
    ------
    InputError
        If the controller that asked is unknown, or the saved data or settings are invalid.
    """
    name, data = where or decision.name, model_data(decision, where)
    by = decision.asked.get("by")
    if by == _MATCHING:
        found = matching.solve(data)
        return found_of(decision.family, answer(found, None if found.values is None else {}))
    if by not in ASKERS:
        raise InputError(f"{name}: asked.by: must be one of {', '.join([*ASKERS, _MATCHING])}")
    module = _module(by)
    rest = {key: value for key, value in decision.asked.items() if key != "by"}
    try:
        made = {key: _MADE[key](value) if key in _MADE else value for key, value in rest.items()}
        question = module.Question(data=data, **made)
    except (TypeError, ValueError) as error:
        raise InputError(f"{name}: asked: {error}") from None
    return found_of(decision.family, module.solve(question))


def found_of(family: str, given: Answer) -> Found:
    """Make a `Found` from an optimiser's answer to a question of the given family."""
    by = {"backend": given.backend, "status": given.status, "work": given.work}
    by |= {"wall_s": given.wall_s, "build_s": given.build_s, "built": given.built}
    values = None if given.found is None else plain_values(family, given.found)
    return Found(values, given.objective, given.bound, by)


def _module(name: str) -> Any:
    return import_module(f"rmfs.solvers.control.{ASKERS[name]}")
