"""A hash of the code, by which checkpoints of another version are recognised."""

from __future__ import annotations

import hashlib
import os
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

NOT_SIMULATED = ("experiments",)
"""Sub-packages that do not influence a run: changes in them require no new runs."""

SUFFIXES = (".py", ".so", ".pyd")


@cache
def code_hash() -> str:
    """Return a hash of the Python files and the compiled core of rmfs, as 16 hexadecimal digits.

    The sub-packages in `NOT_SIMULATED` are left out. Uncommitted changes in a checkout change the
    hash, too.
    """
    root = Path(__file__).resolve().parent
    state = hashlib.sha256()
    for path in sorted(_sources(root)):
        state.update(path.relative_to(root).as_posix().encode())
        state.update(path.read_bytes())
    return state.hexdigest()[:16]


def _sources(root: Path) -> Iterator[Path]:
    """Find the source files; in a checkout, some folders of the package are links."""
    for folder, below, files in os.walk(root, followlinks=True):
        if Path(folder) == root:
            below[:] = [name for name in below if name not in NOT_SIMULATED]
        yield from (Path(folder, name) for name in files if Path(name).suffix in SUFFIXES)
