"""Which code made a result."""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path
from typing import Any

import rmfs
from rmfs.measure.provenance import commit, version

PACKAGES = ("rmfs", "solvers")
SUFFIXES = (".py", ".so", ".pyd")


@cache
def code() -> dict[str, Any]:
    """Return version, commit and a hash of the code that runs are made with.

    The hash covers the Python files and the compiled core of `rmfs` and `solvers`, so that runs of
    a checkout with changes can be told apart, too.
    """
    root = Path(rmfs.__file__).resolve().parent.parent
    state = hashlib.sha256()
    for package in PACKAGES:
        for path in sorted((root / package).rglob("*")):
            if path.suffix in SUFFIXES:
                state.update(path.relative_to(root).as_posix().encode())
                state.update(path.read_bytes())
    told = commit()["git_commit"]
    return {
        "rmfs_version": version(),
        "git_commit": told if told is not None else "",
        "code": state.hexdigest()[:16],
    }
