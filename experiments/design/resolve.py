"""Loading what an arm names, and a digest of everything that decides about its runs.

The digest is of meaning, not of text: a comment added to a file, or the same layout under another
name, leaves it as it is; one more robot, another rule or a changed SKU file does not. Runs are
stored under it, so that finished ones are found again and outdated ones are noticed.
"""

from __future__ import annotations

import hashlib
import inspect
import json
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rmfs import control, instances
from rmfs import layout as layouts
from rmfs import scenario as scenarios
from rmfs.errors import InputError
from rmfs.measure.provenance import KINDS
from rmfs.measure.provenance import digest as digest_of
from rmfs.simulation.pacing import pacing as pacing_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from experiments.design.arms import Arm, Overrides
    from rmfs.control.settings import ControllerSettings
    from rmfs.layout.model import Layout
    from rmfs.scenario import Scenario

OWN_PACKAGES = ("rmfs", "solvers")
"""Rules in these packages are told by the version of the code, others by a hash of their file."""


@dataclass(frozen=True)
class Inputs:
    """What a run simulates."""

    layout: Layout
    scenario: Scenario
    controllers: ControllerSettings


@dataclass
class Resolver:
    """Loads the inputs of many arms, each different file and set of parameters once.

    Attributes
    ----------
    files
        Hash of every file read so far, by the name under which it was given.
    """

    allow_not_well_formed: bool = False
    files: dict[str, str] = field(default_factory=dict)
    _parts: dict[str, tuple[str, str]] = field(default_factory=dict)

    def digest(self, arm: Arm, *, check: bool, seeded: list[str]) -> tuple[str, list[str]]:
        """Return the digest of an arm, and what is wrong with it.

        Parameters
        ----------
        check
            Whether its runs are proven safe.
        seeded
            Parameters that take the seed of the run.
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
        try:
            pacing_of(arm.pacing)
        except InputError as error:
            problems.append(str(error))
        told = {**found, "pacing": arm.pacing, "check": check, "seeded": sorted(seeded)}
        return _hash(told), problems

    def _part(
        self, part: str, given: str, overrides: Overrides, load: Callable[..., Any]
    ) -> tuple[str, str]:
        """Return digest and problem of one input."""
        known = json.dumps([part, given, overrides], default=str)
        if known not in self._parts:
            try:
                path = instances.locate(KINDS[part], given)
                self.files[given] = file_hash(path)
                loaded = load(given, overrides)
                if part == "layout":
                    layouts.refuse(loaded, given, allow_not_well_formed=self.allow_not_well_formed)
                self._parts[known] = (self._meaning(loaded), "")
            except InputError as error:
                self._parts[known] = ("", str(error))
        return self._parts[known]

    def _meaning(self, loaded: Any) -> str:
        """Return the digest of a loaded input, whatever its name and description."""
        if isinstance(loaded, control.ControllerSettings):
            table = loaded.to_table()
            for file in _rule_files(loaded):
                self.files[str(file)] = file_hash(file)
        elif isinstance(loaded, scenarios.Scenario):
            table = loaded.model_dump(mode="json")
        else:
            return digest_of(replace(loaded, name=""))
        table = {key: value for key, value in table.items() if key not in ("name", "description")}
        return _hash(self._with_files(table))

    def _with_files(self, value: Any) -> Any:
        """Replace the name of every file by the hash of its content."""
        if isinstance(value, dict):
            return {key: self._with_files(item) for key, item in value.items()}
        if isinstance(value, list | tuple):
            return [self._with_files(item) for item in value]
        if isinstance(value, str) and _is_file(value):
            self.files[value] = file_hash(Path(value))
            return self.files[value]
        if isinstance(value, str) and ":" in value:
            return [value, *(file_hash(file) for file in _source_of(value))]
        return value


_LOADERS: dict[str, Callable[..., Any]] = {
    "layout": layouts.load,
    "scenario": scenarios.load,
    "controllers": control.load,
}


def load(inputs: dict[str, str], overrides: Overrides) -> Inputs:
    """Load the inputs of one run.

    Raises
    ------
    InputError
        If one of them is wrong.
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


def given_hash(given: str) -> str:
    """Return the hash of an input file named as in `Resolver.files`, here and now; "" if absent."""
    if _is_file(given):
        return file_hash(Path(given))
    for kind in KINDS.values():
        for suffix in (".toml", ".json"):
            shipped = instances.ROOT / kind / f"{given}{suffix}"
            if shipped.is_file():
                return file_hash(shipped)
    return ""


def _is_file(text: str) -> bool:
    try:
        return Path(text).is_file()
    except (OSError, ValueError):
        return False


def _rule_files(settings: ControllerSettings) -> Iterator[Path]:
    for choice in settings.choices.values():
        yield from _source_of(f"{choice.controller.__module__}:{choice.controller.__name__}")


def _source_of(reference: str) -> list[Path]:
    """Return the source file of a rule named `module:Class`, unless it is part of rmfs."""
    module = reference.partition(":")[0]
    if module.split(".")[0] in OWN_PACKAGES:
        return []
    import sys

    found = sys.modules.get(module)
    try:
        source = inspect.getsourcefile(found) if found is not None else None
    except TypeError:
        return []
    return [Path(source)] if source is not None else []


def _hash(value: Any) -> str:
    text = json.dumps(value, sort_keys=True, separators=(",", ":"), default=str)
    return hashlib.sha256(text.encode()).hexdigest()
