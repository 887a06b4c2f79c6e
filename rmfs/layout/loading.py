"""Loads layouts from any of the supported file formats."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs import foreign, instances
from rmfs.config import Table, apply_overrides, read_toml, validate
from rmfs.errors import InputError
from rmfs.layout.drawn import read_picture, read_station_map, stations_file
from rmfs.layout.explicit import read_json
from rmfs.layout.generator import generate
from rmfs.layout.mapf import read_map
from rmfs.layout.overrides import FACTORS, override
from rmfs.layout.parameters import LayoutParameters

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from rmfs.layout.model import Layout

Override = tuple[list[str], Any]
"""A key below "layout", as a list of its parts, and its new value."""


def names() -> list[str]:
    """Return the sorted names of the shipped layouts."""
    return instances.names("layouts")


def load(name_or_path: str | Path, overrides: Sequence[Override] = ()) -> Layout:
    """Load a layout; like `load_with_notes`, but without the notes."""
    return load_with_notes(name_or_path, overrides)[0]


def load_with_notes(
    name_or_path: str | Path, overrides: Sequence[Override] = ()
) -> tuple[Layout, list[str]]:
    """Load a layout, and return it with notes on its import.

    Parameters
    ----------
    name_or_path
        A shipped layout, or a file: `.toml` (parameters), `.json` (explicit layout), `.txt` (drawn
        as text), `.xlayo` or `.xinst` (RAWSim-O), or `.map` (grid map). The stations and storage
        locations of `NAME.map` are read from `NAME.map.toml` in the same folder. Without that file,
        the layout has no stations or storage locations, and can be used only for traffic
        experiments.
    overrides
        Pairs of a key, as a list of its parts, and its new value, such as `(["robots"], 16)`. The
        valid keys depend on the file. For `.toml`, `.xlayo`, `.txt`, and `.map` with stations, they
        are the parameters in the file, which are changed before they are validated, and
        `FACTORS`, which are applied to the finished layout. For all other files, they are the keys
        of `ExplicitOverrides`.

    Returns
    -------
    The layout, and notes on what was left out or added when it was imported.

    Raises
    ------
    InputError
        If the layout cannot be found, read or generated; the message lists the errors in one line.
    """
    path = instances.locate("layouts", str(name_or_path))
    source = str(path)
    match path.suffix.lower():
        case ".toml":
            return _generated(read_toml(path), overrides, path), []
        case ".xlayo":
            table, notes = foreign.read(path)
            return _generated(table, overrides, path), notes
        case ".json":
            return override(read_json(path), overrides, source), []
        case ".xinst":
            layout, notes = foreign.read(path)
            return override(layout, overrides, source), notes
        case ".txt":
            own, factors = split_factors(overrides)
            return override(read_picture(path, own), factors, source), []
        case ".map" if stations_file(path).is_file():
            own, factors = split_factors(overrides)
            return override(read_station_map(path, own), factors, source), []
        case ".map":
            return override(read_map(path), overrides, source), []
    raise InputError(
        f"{path}: unknown suffix of a layout; must be .toml, .json, .txt, .map, .xlayo or .xinst"
    )


def _generated(table: Table, overrides: Sequence[Override], path: Path) -> Layout:
    if not table:
        raise InputError(f'{path}: is empty; a layout must start with format = "rmfs-layout/1"')
    own, factors = split_factors(overrides)
    parameters = validate(LayoutParameters, apply_overrides(table, own), str(path))
    try:
        layout = generate(parameters, path.parent)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    return override(layout, factors, str(path))


def split_factors(overrides: Sequence[Override]) -> tuple[list[Override], list[Override]]:
    """Split overrides into those of parameters and those of `FACTORS`, and return both lists."""
    is_factor = [path[0] in FACTORS for path, _ in overrides]
    pairs = list(zip(overrides, is_factor, strict=True))
    return [one for one, late in pairs if not late], [one for one, late in pairs if late]
