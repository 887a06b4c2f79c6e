"""Files of other systems: which reader makes ours of a file, by its ending.

Readers are named here and imported when a file of theirs is loaded: nothing else of the simulator
knows what other systems write.
"""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

_READERS = {
    ".xinst": "rmfs.rawsimo.layout.xinst:read_xinst",
    ".xlayo": "rmfs.rawsimo.layout.xlayo:read_xlayo_table",
    ".xsett": "rmfs.rawsimo.scenario.xsett:read_xsett",
    ".xgenc": "rmfs.rawsimo.scenario.xgenc:read_xgenc",
    ".xitem": "rmfs.rawsimo.scenario.xitem:read_xitem",
    ".xconf": "rmfs.rawsimo.control.xconf:read_xconf",
}


def read(path: Path) -> Any:
    """Read a file of another system with the reader of its ending.

    Returns
    -------
    What that reader returns; each says so itself.

    Raises
    ------
    InputError
        If the file cannot be read.
    """
    module, _, name = _READERS[path.suffix.lower()].partition(":")
    return getattr(import_module(module), name)(path)
