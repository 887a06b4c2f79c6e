"""The input files named by parameters of controllers."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from rmfs.control.trackers.congestion import FORECAST, RECENT

if TYPE_CHECKING:
    from collections.abc import Iterator


def named_files(controllers: dict[str, Any]) -> dict[str, Path]:
    """Return the files named by parameters of controllers, by key, such as `pp.guidance`.

    Parameters
    ----------
    controllers
        Contents of a controllers file.
    """
    return {".".join(keys): Path(given) for keys, given in _files_in([], controllers)}


def names_a_file(key: str, given: Any) -> bool:
    """Return whether the value of a controller's parameter, or a part of it, names an input file.

    Parameters
    ----------
    key
        Name of the parameter.
    given
        Value of the parameter; if it is a table or a list, its parts are examined as well.
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
