"""Loading the inputs of an arm, and a digest of everything that determines its runs.

The digest depends on content, not on text: it stays the same if a comment is added to a file or a
layout is renamed, but changes with the number of robots, with a rule or with the contents of an SKU
file. Runs are stored with this digest, so that finished runs are found again and outdated ones are
detected.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rmfs import control, instances
from rmfs import layout as layouts
from rmfs import scenario as scenarios
from rmfs.digest import digest as digest_of
from rmfs.errors import InputError
from rmfs.measure.provenance import KINDS
from rmfs.simulation.pacing import pacing_settings
from rmfs.sources import sources

if TYPE_CHECKING:
    from collections.abc import Callable

    from rmfs.control.settings import ControllerSettings
    from rmfs.experiments.design.arms import Arm, Overrides
    from rmfs.layout.model import Layout
    from rmfs.measure.base import Measure
    from rmfs.scenario import Scenario

_SHIPPED = "instances/"


@dataclass(frozen=True)
class Inputs:
    """The loaded inputs of a run."""

    layout: Layout
    scenario: Scenario
    controllers: ControllerSettings


@dataclass
class Resolver:
    """Loads the inputs of many arms; every combination of file and parameters is loaded only once.

    Attributes
    ----------
    measures
        The user's own measures. The digest covers their code, which determines columns of the
        results.
    files
        Hash of every file read so far, by the name that `file_name` returns.
    """

    allow_not_well_formed: bool = False
    measures: list[type[Measure]] = field(default_factory=list)
    files: dict[str, str] = field(default_factory=dict)
    _parts: dict[str, tuple[str, str]] = field(default_factory=dict)
    _made_of: dict[type, list[Path]] = field(default_factory=dict)

    def digest(self, arm: Arm, *, check: bool, seeded: list[str]) -> tuple[str, list[str]]:
        """Return the digest of an arm, and the errors in its inputs.

        Parameters
        ----------
        check
            Whether the traces of the arm's runs are checked.
        seeded
            Parameters that are set to the seed of the run.
        """
        found: dict[str, Any] = {}
        problems: list[str] = []
        for part, load in _LOADERS.items():
            own = [(path[1:], value) for path, value in arm.overrides if path[0] == part]
            # a parameter that takes the seed is tried with one
            own += [(key.split(".")[1:], 0) for key in seeded if key.split(".")[0] == part]
            found[part], problem = self._part(part, arm.inputs[part], own, load)
            if problem:
                problems.append(problem)
        pacing: Any = arm.pacing
        own = [(path[1:], value) for path, value in of_pacing(arm.overrides)]
        try:
            settings = pacing_settings(arm.pacing, own)
        except InputError as error:
            problems.append(str(error))
        else:
            pacing = settings.model_dump(mode="json") if own else arm.pacing
        told = {**found, "pacing": pacing, "check": check, "seeded": sorted(seeded)}
        if self.measures:
            files = [[*map(str, sources([one]).values())] for one in self.measures]
            names = [one.__qualname__ for one in self.measures]
            told["measures"] = [names, self._with_files(files)]
        return _hash(told), problems

    def _part(
        self, part: str, given: str, overrides: Overrides, load: Callable[..., Any]
    ) -> tuple[str, str]:
        """Return the digest of one input and its error message; one of the two is empty."""
        known = json.dumps([part, given, overrides], default=str)
        if known not in self._parts:
            try:
                path = instances.locate(KINDS[part], given)
                self.files[file_name(path)] = file_hash(path)
                loaded = load(given, overrides)
                if part == "layout":
                    layouts.refuse(loaded, given, allow_not_well_formed=self.allow_not_well_formed)
                self._parts[known] = (self._meaning(loaded), "")
            except InputError as error:
                self._parts[known] = ("", str(error))
        return self._parts[known]

    def _meaning(self, loaded: Any) -> str:
        """Return the digest of a loaded input; its name and description do not matter."""
        if isinstance(loaded, control.ControllerSettings):
            table = loaded.to_table() | {"sources": self._sources(loaded)}
        elif isinstance(loaded, scenarios.Scenario):
            table = loaded.model_dump(mode="json")
        else:
            return digest_of(replace(loaded, name=""))
        table = {key: value for key, value in table.items() if key not in ("name", "description")}
        return _hash(self._with_files(table))

    def _sources(self, settings: ControllerSettings) -> list[str]:
        """Return the source files of the user's rules, in an order independent of their names."""
        found: dict[Path, str] = {}
        for rule in settings.rules():
            if rule not in self._made_of:
                self._made_of[rule] = [*sources([rule]).values()]
            found |= {path: file_hash(path) for path in self._made_of[rule]}
        return [str(path) for path, _ in sorted(found.items(), key=lambda one: one[::-1])]

    def _with_files(self, value: Any) -> Any:
        """Replace the name of every file by the hash of its content."""
        if isinstance(value, dict):
            return {key: self._with_files(item) for key, item in value.items()}
        if isinstance(value, list | tuple):
            return [self._with_files(item) for item in value]
        if isinstance(value, str) and _is_file(value):
            self.files[file_name(Path(value))] = file_hash(Path(value))
            return file_hash(Path(value))
        return value


_LOADERS: dict[str, Callable[..., Any]] = {
    "layout": layouts.load,
    "scenario": scenarios.load,
    "controllers": control.load,
}


def of_pacing(overrides: Overrides) -> Overrides:
    """Return those of the given overrides that set parameters of the pacing."""
    return [(path, value) for path, value in overrides if path[0] == "pacing"]


def load(inputs: dict[str, str], overrides: Overrides) -> Inputs:
    """Load the inputs of one run.

    Raises
    ------
    InputError
        If an input is invalid.
    """
    loaded = {
        part: loader(
            inputs[part], [(path[1:], value) for path, value in overrides if path[0] == part]
        )
        for part, loader in _LOADERS.items()
    }
    return Inputs(**loaded)


def file_hash(path: Path) -> str:
    """Return the SHA-256 of a file."""
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from None


def file_name(path: Path) -> str:
    """Return the name by which plans refer to an input file.

    The name of a shipped file is the same on every machine; other files have absolute paths.
    """
    if path.is_relative_to(instances.ROOT):
        return f"{_SHIPPED}{path.relative_to(instances.ROOT).as_posix()}"
    return str(path.absolute())


def present_hash(name: str) -> str:
    """Return the current hash of a file named in a plan; empty if the file does not exist."""
    shipped = name.startswith(_SHIPPED)
    path = instances.ROOT / name.removeprefix(_SHIPPED) if shipped else Path(name)
    return file_hash(path) if path.is_file() else ""


def _is_file(text: str) -> bool:
    try:
        return Path(text).is_file()
    except (OSError, ValueError):
        return False


def _hash(value: Any) -> str:
    text = json.dumps(value, sort_keys=True, separators=(",", ":"), default=str)
    return hashlib.sha256(text.encode()).hexdigest()
