"""Maturin as the build back end, after a look whether Rust is there.

Left alone, maturin downloads an unpinned Rust, or ends in a traceback where it cannot.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

from maturin import (
    build_editable,
    build_sdist,
    build_wheel,
    prepare_metadata_for_build_editable,
    prepare_metadata_for_build_wheel,
)

__all__ = [
    "build_editable",
    "build_sdist",
    "build_wheel",
    "get_requires_for_build_editable",
    "get_requires_for_build_sdist",
    "get_requires_for_build_wheel",
    "prepare_metadata_for_build_editable",
    "prepare_metadata_for_build_wheel",
]

MANIFEST = Path(__file__).resolve().parent.parent / "rmfs" / "traffic" / "Cargo.toml"

os.environ["MATURIN_NO_INSTALL_RUST"] = "1"


def required() -> str:
    """Return the oldest Rust that the crate states it can be built with."""
    stated = re.search(r'^rust-version = "(.+)"', MANIFEST.read_text("utf-8"), re.MULTILINE)
    if stated is None:
        raise SystemExit(f"{MANIFEST}: rust-version is missing")
    return stated[1]


def found() -> str | None:
    """Return the version of the Rust on PATH; None if there is none, or no cargo."""
    if shutil.which("rustc") is None or shutil.which("cargo") is None:
        return None
    told = subprocess.run(["rustc", "--version"], capture_output=True, text=True, check=False)
    version = re.match(r"rustc ([\d.]+)", told.stdout)
    return None if version is None else version[1]


def numbers(version: str) -> list[int]:
    """Return the numbers of a version, to compare it with others."""
    return [int(part) for part in version.split(".")]


def get_requires_for_build_wheel(config_settings: Any = None) -> list[str]:
    """End the build in one line if Rust is missing or too old; ask for no further packages.

    Raises
    ------
    SystemExit
        If the build cannot succeed.
    """
    needed, present = required(), found()
    if present is None or numbers(present) < numbers(needed):
        state = "none is on PATH" if present is None else f"the one on PATH is {present}"
        raise SystemExit(
            f"rmfs is built with Rust {needed} or newer, and {state}: get one from "
            "https://rustup.rs, or run `make setup` in a checkout, which brings its own"
        )
    return []


get_requires_for_build_editable = get_requires_for_build_wheel
get_requires_for_build_sdist = get_requires_for_build_wheel
