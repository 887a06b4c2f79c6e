"""Reading of files of other systems (RAWSim-O); the suffix of a file determines its reader.

Readers are named here; each is imported only when a file with its suffix is loaded.
"""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

from rmfs.errors import InputError

_READERS = {
    ".xinst": "rmfs.rawsimo.layout.xinst:read_xinst",
    ".xlayo": "rmfs.rawsimo.layout.xlayo:read_xlayo_table",
    ".xsett": "rmfs.rawsimo.scenario.xsett:read_xsett",
    ".xgenc": "rmfs.rawsimo.scenario.xgenc:read_xgenc",
    ".xitem": "rmfs.rawsimo.scenario.xitem:read_xitem",
    ".xconf": "rmfs.rawsimo.control.xconf:read_xconf",
}


def read(path: Path) -> Any:
    """Read a file of another system with the reader for the suffix of the file.

    Returns
    -------
    Any
        The return value of that reader; see its documentation.

    Raises
    ------
    InputError
        If the file cannot be read, or there is no reader for its suffix.
    """
    reader = _READERS.get(path.suffix.lower())
    if reader is None:
        raise InputError(f"{path}: no reader for this suffix; valid: {', '.join(_READERS)}")
    module, _, name = reader.partition(":")
    return getattr(import_module(module), name)(path)
