"""What the tests of the project itself read: its tracked files and its metadata."""

from __future__ import annotations

import subprocess
import tomllib
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]


def text(name: str) -> str:
    """Return the content of a file of the checkout."""
    return (ROOT / name).read_text("utf-8")


def toml(name: str) -> dict[str, Any]:
    """Return the content of a TOML file of the checkout."""
    return tomllib.loads(text(name))


def tracked(*patterns: str) -> list[Path]:
    """Return the files that git tracks; skip the test where this is no checkout."""
    told = subprocess.run(
        ["git", "-C", str(ROOT), "ls-files", "-z", *patterns], capture_output=True, check=False
    )
    if told.returncode:
        pytest.skip("not a git checkout")
    paths = (ROOT / name for name in told.stdout.decode().split("\0") if name)
    return [path for path in paths if path.is_file()]


def make_targets() -> set[str]:
    """Return the names of what can be made."""
    lines = text("Makefile").splitlines()
    prefix = ".PHONY: "
    return {line.removeprefix(prefix) for line in lines if line.startswith(prefix)}
