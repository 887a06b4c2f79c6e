"""Loads scenario files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from rmfs import foreign
from rmfs.config import apply_overrides, read_toml, validate
from rmfs.instances import locate
from rmfs.scenario.parameters import Scenario

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.config import Table

_FILES = (
    ("skus", "file"),
    ("skus", "words"),
    ("demand", "file"),
    ("replenishment", "file"),
    ("pickers", "unit_time", "file"),
)
"""Keys whose values are file names."""


def load(name_or_path: str | Path, overrides: Sequence[tuple[Sequence[str], Any]] = ()) -> Scenario:
    """Load a scenario; see `load_with_notes`."""
    return load_with_notes(name_or_path, overrides)[0]


def load_with_notes(
    name_or_path: str | Path, overrides: Sequence[tuple[Sequence[str], Any]] = ()
) -> tuple[Scenario, list[str]]:
    """Load a scenario; also return notes if it is imported from a file of RAWSim-O.

    Parameters
    ----------
    name_or_path
        A TOML file, a file of RAWSim-O (.xsett), or the name of a shipped scenario.
    overrides
        Pairs of a key path and a value, for example `(["duration_s"], 7200)`, which replace values
        of the file before validation.

    Returns
    -------
    The scenario, and notes on settings that the import left out and on differences between RAWSim-O
    and rmfs. For files in other formats, there are no notes.

    Raises
    ------
    InputError
        If the file cannot be read or is invalid; the message lists all errors on one line.
    """
    path = locate("scenarios", str(name_or_path))
    notes: list[str] = []
    if path.suffix.lower() == ".xsett":
        read = foreign.read(path)
        table, notes = read.table, read.notes
    else:
        table = read_toml(path)
        table.setdefault("name", path.stem)
        _anchor_files(table, path.resolve().parent)
    table = apply_overrides(table, [(list(keys), value) for keys, value in overrides])
    return validate(Scenario, table, str(path)), notes


def asked_of_layout(name_or_path: str | Path) -> list[tuple[list[str], Any]]:
    """Return the overrides that a scenario file of RAWSim-O implies for the layout.

    They are pairs of a key path and a value; the list is empty for files in other formats.

    Raises
    ------
    InputError
        If the file cannot be read.
    """
    path = locate("scenarios", str(name_or_path))
    if path.suffix.lower() != ".xsett":
        return []
    asked: list[tuple[list[str], Any]] = foreign.read(path).layout
    return asked


def named_files(scenario: Scenario) -> dict[str, Path]:
    """Return the files that a scenario refers to, by key, such as `demand.file`."""
    found: dict[str, Path] = {}
    for keys in _FILES:
        value: Any = scenario
        for key in keys:
            value = getattr(value, key, None)
        if value is not None:
            found[".".join(keys)] = value
    return found


def _anchor_files(table: Table, folder: Path) -> None:
    """Make paths absolute: those in a scenario file are relative to its folder.

    Those in an override are relative to the working directory, like all paths on the command line.
    """
    for *names, key in _FILES:
        block: Any = table
        for name in names:
            block = block.get(name) if isinstance(block, dict) else None
        if isinstance(block, dict) and isinstance(block.get(key), str):
            block[key] = str(folder / block[key])
