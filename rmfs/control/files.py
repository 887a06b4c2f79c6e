"""Files that parameters of controllers make a run read."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from rmfs.control.trackers.congestion import FORECAST, RECENT

if TYPE_CHECKING:
    from collections.abc import Iterator


def named_files(controllers: dict[str, Any]) -> dict[str, Path]:
    """Return the files that controllers read, by key, such as `pp.guidance`.

    Parameters
    ----------
    controllers
        Contents of a controllers file.
    """
    return {".".join(keys): Path(given) for keys, given in _files_in([], controllers)}


def names_a_file(key: str, given: Any) -> bool:
    """Return whether a parameter of a controller, or a part of it, makes a run read a file.

    Parameters
    ----------
    key
        Name of the parameter.
    given
        Its value; the parts of tables and lists are examined as well.
    """
    return any(True for _ in _files_in([key], given))


def _files_in(keys: list[str], given: Any) -> Iterator[tuple[list[str], str]]:
    if isinstance(given, dict):
        for name, part in given.items():
            yield from _files_in([*keys, name], part)
    elif isinstance(given, list | tuple):
        for part in given:
            yield from _files_in(keys, part)
    elif keys and given is not None:
        is_table = keys[-1] == "congestion_from" and given not in (RECENT, FORECAST)
        if is_table or keys[-1] == "guidance":
            yield keys, str(given)
