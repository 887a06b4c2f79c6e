"""The shipped instances (layouts, scenarios and controllers), and how files are found by name."""

from __future__ import annotations

import difflib
from pathlib import Path
from typing import Literal

from rmfs.errors import InputError

Kind = Literal["layouts", "scenarios", "controllers"]

ROOT = (Path(__file__).parent / "shipped").resolve()
"""Folder of the shipped instances: part of a wheel, or a link to `instances` in a checkout."""


def names(kind: Kind) -> list[str]:
    """Return the sorted names of the shipped instances of one kind."""
    files = (ROOT / kind).glob("*")
    return sorted({path.stem for path in files if path.suffix in (".toml", ".json")})


def locate(kind: Kind, name_or_path: str) -> Path:
    """Return the file at a path or, if there is none, the shipped instance of that name.

    Raises
    ------
    InputError
        If neither exists (the message then lists the shipped names), or if the path is
        inaccessible.
    """
    path = Path(name_or_path)
    try:
        if path.is_file():
            return path
        for suffix in (".toml", ".json"):
            shipped = ROOT / kind / f"{name_or_path}{suffix}"
            if shipped.is_file():
                return shipped
    except (OSError, ValueError) as error:  # the name is too long, or the file is inaccessible
        raise InputError(f"{name_or_path:.80}: {error.args[-1]}") from None
    known = names(kind)
    near = difflib.get_close_matches(name_or_path, known, n=1)
    hint = f"did you mean {near[0]}? " if near else ""
    raise InputError(
        f"{name_or_path}: no such file, and no shipped {kind} of that name; "
        f"{hint}shipped: {', '.join(known)}"
    )
