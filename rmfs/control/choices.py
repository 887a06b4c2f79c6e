"""Choice of controllers: which one solves each problem, and which may be combined."""

from __future__ import annotations

import difflib
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from rmfs import config
from rmfs.control import registry
from rmfs.control.problems import Problem
from rmfs.control.trackers.turnover import TurnoverParameters
from rmfs.control.trackers.zones import ZoneParameters
from rmfs.errors import InputError
from rmfs.references import anchored

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rmfs.config import Table
    from rmfs.control.base import Controller, Parameters

DEFAULTS = {problem: problem.default for problem in Problem}
"""For each problem, the name of the rule used if a controllers file does not mention it."""

_SHARED: dict[type[Parameters], str] = {TurnoverParameters: "classes", ZoneParameters: "zones"}
"""Models of parameters that must be equal in all rules that have them, and what they define."""


@dataclass(frozen=True)
class Choice:
    """The controller chosen for a problem, and its validated parameters.

    Attributes
    ----------
    name
        Name as in a controllers file: a registered name, `module:Class` or `path/to/file.py:Class`.
    """

    problem: Problem
    name: str
    parameters: Parameters

    @property
    def controller(self) -> type[Controller[Any]]:
        """The class of the controller."""
        return registry.find(self.problem, self.name)

    def to_table(self) -> Table:
        """Return the controller's name and parameters as a table of a controllers file."""
        return {"name": self.name, **self.parameters.model_dump(mode="json", exclude_none=True)}


def choose(problem: Problem, table: Table, source: str) -> Choice:
    """Return the controller that the table of a problem selects, with validated parameters.

    The key `name` selects the controller; the other keys are its parameters.

    Raises
    ------
    InputError
        If the name, a key or a value is invalid; the message states the key and what is valid.
    """
    parameters = dict(table)
    name = parameters.pop("name", DEFAULTS[problem])
    if not isinstance(name, str):
        raise InputError(f"{source}: {problem}.name: must be a string (given: {name!r})")
    name = anchored(name)
    try:
        model = registry.find(problem, name).parameters_model
    except InputError as error:
        raise InputError(f"{source}: {problem}.name: {error}") from None
    _refuse_unknown(problem, parameters, [*model.model_fields, "name"], source)
    validated = config.validate(model, parameters, f"{source}: {problem}")
    return Choice(problem, name, validated)


def check_together(choices: Mapping[Problem, Choice], source: str) -> None:
    """Refuse controllers that cannot be combined.

    Parameters
    ----------
    choices
        One choice for each problem.

    Raises
    ------
    InputError
        If a controller decides a further problem for which no dummy is selected; if a dummy is
        selected for a problem that no other controller decides; if two controllers wait for each
        other's decisions; or if two controllers define turnover classes or zones differently.
    """
    _refuse_mutual_waiting(choices, source)
    _refuse_different_views(choices, source)
    taken: dict[Problem, Choice] = {}
    for choice in choices.values():
        for problem in choice.controller.decides:
            taken[problem] = choice
            partner = choices[problem]
            if not partner.controller.is_dummy:
                raise InputError(
                    f"{source}: {choice.problem} {choice.name} decides {problem} as well: "
                    f"{problem}.name must be dummy (given: {partner.name})"
                )
    for problem, choice in choices.items():
        if choice.controller.is_dummy and problem not in taken:
            raise InputError(
                f"{source}: {problem}.name: a dummy decides nothing, and no other controller "
                f"decides {problem}"
            )


def _refuse_mutual_waiting(choices: Mapping[Problem, Choice], source: str) -> None:
    for choice in choices.values():
        for problem in choice.controller.waits_for:
            partner = choices[problem]
            if choice.problem in partner.controller.waits_for:
                raise InputError(
                    f"{source}: {choice.problem} {choice.name} waits for the decision of "
                    f"{problem}, and {problem} {partner.name} for that of {choice.problem}, so "
                    "neither would ever decide; choose a rule that does not wait: "
                    f"{_that_do_not_wait(choice.problem, problem)}; or "
                    f"{_that_do_not_wait(problem, choice.problem)}"
                )


def _that_do_not_wait(problem: Problem, other: Problem) -> str:
    names = [
        name
        for name in registry.built_in(problem)
        if other not in (rule := registry.find(problem, name)).waits_for and not rule.is_dummy
    ]
    return f"for {problem} {', '.join(names)}"


def _refuse_different_views(choices: Mapping[Problem, Choice], source: str) -> None:
    for model, what in _SHARED.items():
        sharing = [c for c in choices.values() if isinstance(c.parameters, model)]
        for one, other in pairwise(sharing):
            first, second = (c.parameters.model_dump() for c in (one, other))
            for key in model.model_fields:
                if first[key] != second[key]:
                    raise InputError(
                        f"{source}: {one.problem}.{key} and {other.problem}.{key} must be equal: "
                        f"{one.problem} {one.name} and {other.problem} {other.name} share their "
                        f"{what}"
                    )


def _refuse_unknown(problem: Problem, parameters: Table, valid: list[str], source: str) -> None:
    for key in parameters:
        if key not in valid:
            near = difflib.get_close_matches(key, valid, n=1)
            hint = f"did you mean {near[0]}?" if near else f"valid: {', '.join(sorted(valid))}"
            raise InputError(f"{source}: unknown key {problem}.{key}; {hint}")
