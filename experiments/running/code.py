"""The version of the code that produced a result."""

from __future__ import annotations

from functools import cache
from typing import Any

from rmfs.code import code_hash
from rmfs.measure.provenance import commit, version


@cache
def code() -> dict[str, Any]:
    """Return the version and commit of rmfs, and the hash of its code (see `rmfs.code`)."""
    told = commit()["git_commit"]
    return {
        "rmfs_version": version(),
        "git_commit": told if told is not None else "",
        "code": code_hash(),
    }
