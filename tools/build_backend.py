"""Maturin as the build back end, after a look whether Rust is there.

Without this look, maturin downloads an unpinned Rust by itself, or ends in a traceback where it
cannot.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import maturin

MANIFEST = Path(__file__).resolve().parent.parent / "rmfs" / "traffic" / "Cargo.toml"


def required() -> tuple[int, ...]:
    """Return the oldest Rust that the crate states it can be built with."""
    stated = re.search(r'^rust-version = "([\d.]+)"', MANIFEST.read_text("utf-8"), re.MULTILINE)
    if stated is None:
        raise SystemExit(f"{MANIFEST}: no rust-version")
    return numbers(stated[1])


def found() -> tuple[int, ...] | None:
    """Return the version of the Rust on PATH; None if there is none, or no cargo."""
    if shutil.which("rustc") is None or shutil.which("cargo") is None:
        return None
    told = subprocess.run(["rustc", "--version"], capture_output=True, text=True, check=False)
    version = re.match(r"rustc ([\d.]+)", told.stdout)
    return None if version is None else numbers(version[1])


def numbers(version: str) -> tuple[int, ...]:
    """Return the numbers of a version such as "1.88.0"."""
    return tuple(int(part) for part in version.split("."))


def text(version: tuple[int, ...]) -> str:
    """Return a version as it is written."""
    return ".".join(map(str, version))


def require_rust() -> None:
    """End the build in one line if it cannot succeed.

    Raises
    ------
    SystemExit
        If Rust is missing or too old.
    """
    needed, present = required(), found()
    if present is not None and present >= needed:
        return
    state = "there is none on PATH" if present is None else f"the one on PATH is {text(present)}"
    raise SystemExit(
        f"rmfs needs Rust {text(needed)} or newer to be built, and {state}: install it "
        "(https://rustup.rs), or run `make setup` in the checkout, which brings its own"
    )


def _after_looking(hook: str) -> Any:
    """Return a hook of maturin's that first looks whether Rust is there."""

    def call(*arguments: Any, **options: Any) -> Any:
        require_rust()
        return getattr(maturin, hook)(*arguments, **options)

    return call


def get_requires_for_build_wheel(config_settings: Any = None) -> list[str]:
    """Ask for nothing beyond what pyproject.toml names: Rust is there or the build ends."""
    require_rust()
    return []


get_requires_for_build_editable = get_requires_for_build_wheel
get_requires_for_build_sdist = get_requires_for_build_wheel
build_wheel = _after_looking("build_wheel")
build_editable = _after_looking("build_editable")
build_sdist = _after_looking("build_sdist")
prepare_metadata_for_build_wheel = _after_looking("prepare_metadata_for_build_wheel")
prepare_metadata_for_build_editable = _after_looking("prepare_metadata_for_build_editable")


if __name__ == "__main__":
    require_rust()
    sys.exit(0)
