"""The controllers file: the controller of each decision problem, with its parameters."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, cast

import pydantic

from rmfs import config, foreign, instances
from rmfs.config import Table
from rmfs.control import registry
from rmfs.control.base import RuleTables
from rmfs.control.choices import DEFAULTS, Choice, check_together, choose
from rmfs.control.problems import Problem
from rmfs.references import anchored, anchored_file

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from rmfs.control.base import Controller
    from rmfs.control.mm import MethodManagement

FORMAT = "rmfs-controllers/1"


@dataclass(frozen=True)
class ControllerSettings:
    """A complete set of controllers.

    Attributes
    ----------
    choices
        The controller chosen for each problem, with its parameters.
    """

    name: str
    description: str
    choices: Mapping[Problem, Choice]

    def to_table(self) -> Table:
        """Return the contents of a controllers file for this set, including all defaults."""
        head: Table = {"format": FORMAT, "name": self.name, "description": self.description}
        return head | {str(problem): choice.to_table() for problem, choice in self.choices.items()}

    def rules(self) -> list[type[Controller[Any]]]:
        """Return the classes of all controllers, each once, including those that MM may install."""
        named = dict.fromkeys(_rules_in(self.to_table()))
        return list(dict.fromkeys(registry.find(problem, name) for problem, name in named))


def _rules_in(value: Any) -> Iterator[tuple[Problem, str]]:
    """Yield the problem and name of every rule in a table, at any depth."""
    if isinstance(value, dict):
        for key, item in value.items():
            if key in DEFAULTS and isinstance(item, dict) and isinstance(item.get("name"), str):
                yield Problem(key), item["name"]
            yield from _rules_in(item)
    elif isinstance(value, list | tuple):
        for item in value:
            yield from _rules_in(item)


class _File(RuleTables):
    """The keys of a controllers file."""

    format: Literal["rmfs-controllers/1"]
    name: str = pydantic.Field(min_length=1)
    description: str = ""


def load(
    name_or_path: str | Path, overrides: Sequence[tuple[list[str], Any]] = ()
) -> ControllerSettings:
    """Load a controllers file; arguments and errors are those of `load_with_notes`."""
    return load_with_notes(name_or_path, overrides)[0]


def load_with_notes(
    name_or_path: str | Path, overrides: Sequence[tuple[list[str], Any]] = ()
) -> tuple[ControllerSettings, list[str]]:
    """Load a controllers file, and return it with notes on the import if it is from RAWSim-O.

    Parameters
    ----------
    name_or_path
        A TOML file, a file of RAWSim-O (.xconf), or the name of a shipped set.
    overrides
        Pairs of a key path and a value, for example `(["psa", "name"], "random")`. An override that
        selects another controller drops the parameters of the previous one. `(["psa"], "random")`
        has the same effect as `(["psa", "name"], "random")`.

    Returns
    -------
    The controllers, and the notes: what the import has left out, and what differs from RAWSim-O.
    There are no notes on other files.

    Raises
    ------
    InputError
        If there is no such file or set, or if its contents are invalid. For invalid contents, the
        message names the key and what would be valid.
    """
    path = instances.locate("controllers", str(name_or_path))
    if path.suffix.lower() == ".xconf":
        table, notes = foreign.read(path)
    else:
        table, notes = config.read_toml(path), []
        _anchor(table, path.parent)
    return settings(table, overrides, source=str(path)), notes


def _anchor(table: Table, folder: Path) -> None:
    """Resolve files of rules and of guidance relative to the controllers file first."""
    for problem in Problem:
        rule = table.get(problem)
        if isinstance(rule, dict) and isinstance(rule.get("name"), str):
            rule["name"] = anchored(rule["name"], folder)
        if isinstance(rule, dict) and isinstance(rule.get("guidance"), str):
            rule["guidance"] = anchored_file(rule["guidance"], folder)


def settings(
    table: Table, overrides: Sequence[tuple[list[str], Any]] = (), source: str = "controllers"
) -> ControllerSettings:
    """Validate the contents of a controllers file, and return the controllers that it selects.

    Parameters
    ----------
    table
        The contents.
    overrides
        As in `load_with_notes`.
    source
        Name of the source in error messages.

    Raises
    ------
    InputError
        If the contents are invalid; the message names the key and what would be valid.
    """
    file = config.validate(_File, _overridden(table, list(overrides)), source)
    choices = {
        problem: choose(problem, getattr(file, problem) or {}, source) for problem in Problem
    }
    check_together(choices, source)
    managing = cast("type[MethodManagement[Any]]", choices[Problem.MM].controller)
    managing.check(choices, source)
    return ControllerSettings(file.name, file.description, choices)


def _overridden(table: Table, overrides: list[tuple[list[str], Any]]) -> Table:
    """Apply overrides; those that select a rule come first and drop the previous parameters."""
    result = config.apply_overrides(table, [])
    others = []
    for path, value in overrides:
        if len(path) == 1 and path[0] in DEFAULTS and isinstance(value, str):
            path = [path[0], "name"]
        if len(path) == 2 and path[0] in DEFAULTS and path[1] == "name":
            before = result.get(path[0], {})
            if before.get("name", DEFAULTS[Problem(path[0])]) != value:
                result[path[0]] = {"name": value}
        else:
            others.append((path, value))
    return config.apply_overrides(result, others)
