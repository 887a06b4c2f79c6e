"""Conversion of RAWSim-O's layout files to those of rmfs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.errors import InputError
from rmfs.files import write_text
from rmfs.layout.explicit import save_json
from rmfs.layout.toml import to_toml
from rmfs.rawsimo.layout.xinst import read_xinst
from rmfs.rawsimo.layout.xlayo import read_xlayo

if TYPE_CHECKING:
    from pathlib import Path

SUFFIXES = {".xinst": ".json", ".xlayo": ".toml"}
"""Suffixes of RAWSim-O's files, and of the files written for them."""


def import_layout(path: Path, target: Path) -> list[str]:
    """Convert a layout file of RAWSim-O to a layout file of rmfs; return remarks on differences.

    Parameters
    ----------
    path
        The file of RAWSim-O: .xinst is converted to .json, and .xlayo to .toml.
    target
        The file to write.

    Raises
    ------
    InputError
        If the file of RAWSim-O is invalid or has another suffix, or if the target has the wrong
        suffix or cannot be written.
    """
    suffix = SUFFIXES.get(path.suffix.lower())
    if suffix is None:
        raise InputError(f"{path}: expected a .xinst or .xlayo file")
    if target.suffix.lower() != suffix:
        raise InputError(f"{target}: the name must end in {suffix}")
    if suffix == ".json":
        layout, notes = read_xinst(path)
        save_json(layout, target)
    else:
        parameters, notes = read_xlayo(path)
        write_text(target, to_toml(parameters))
    return notes
