"""Maturin as the build back end, after a look whether Rust is there.

Left alone, maturin downloads an unpinned Rust, or ends in a traceback where it cannot; and it does
not follow the links by which `solvers`, `experiments` and `instances` are parts of the package.
"""

from __future__ import annotations

import base64
import hashlib
import json
import os
import re
import shutil
import subprocess
import zipfile
from pathlib import Path
from typing import Any

import maturin
from maturin import (
    build_editable,
    build_sdist,
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

ROOT = Path(__file__).resolve().parent.parent
MANIFEST = ROOT / "rmfs" / "traffic" / "Cargo.toml"

FOLDERS = {
    "solvers": "rmfs/solvers",
    "experiments": "rmfs/experiments",
    "instances": "rmfs/shipped",
}
"""Folders of the repository that are installed below the package: no name at the top is taken."""

_AGE = (1980, 1, 1, 0, 0, 0)  # of every file that is added: equal sources give equal wheels

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


def build_wheel(
    wheel_directory: str, config_settings: Any = None, metadata_directory: str | None = None
) -> str:
    """Build the wheel, and put the folders into it that are installed below the package."""
    name: str = maturin.build_wheel(wheel_directory, config_settings, metadata_directory)
    add_folders(Path(wheel_directory) / name)
    return name


def add_folders(wheel: Path) -> None:
    """Put the files of `FOLDERS` into a wheel and its record."""
    added = {
        f"{target}/{path.relative_to(ROOT / folder).as_posix()}": path.read_bytes()
        for folder, target in FOLDERS.items()
        for path in sorted((ROOT / folder).rglob("*"))
        if path.is_file() and "__pycache__" not in path.parts
    }
    whole = wheel.with_suffix(".new")
    with zipfile.ZipFile(wheel) as old, zipfile.ZipFile(whole, "w", zipfile.ZIP_DEFLATED) as new:
        content = {entry.filename: old.read(entry) for entry in old.infolist()}
        changed = {name: repeatable(bill) for name, bill in content.items() if "/sboms/" in name}
        for entry in old.infolist():
            one = changed.get(entry.filename, content[entry.filename])
            if entry.filename.endswith(".dist-info/RECORD"):
                told = {**added, **changed}
                rest = [line for line in one.splitlines(True) if _name(line) not in changed]
                one = b"".join([*map(recorded, told, told.values()), *rest])
            new.writestr(entry, one, zipfile.ZIP_DEFLATED)
        for name, content in added.items():
            entry = zipfile.ZipInfo(name, _AGE)
            entry.external_attr = 0o644 << 16
            new.writestr(entry, content, zipfile.ZIP_DEFLATED)
    whole.replace(wheel)


def repeatable(bill: bytes) -> bytes:
    """Return maturin's bill of materials without what differs from build to build.

    That is a number drawn at random, the time of day, and the folder of the build.
    """
    told = json.loads(bill.replace(f"file://{ROOT}/".encode(), b"file:///"))
    told.pop("serialNumber", None)
    told.get("metadata", {}).pop("timestamp", None)
    return json.dumps(told, indent=1).encode()


def _name(line: bytes) -> str:
    """Return the file that a line of a record is about."""
    return line.decode().rsplit(",", 2)[0]


def recorded(name: str, content: bytes) -> bytes:
    """Return the line of a file in the record of a wheel."""
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(content)}\n".encode()
