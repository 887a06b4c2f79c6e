"""Reports all errors in a file in one line."""

from __future__ import annotations

from rmfs.errors import InputError

MOST_PROBLEMS = 10
"""Maximum number of errors listed in a message; the rest are counted."""


def stop_if_any(problems: list[str], source: object) -> None:
    """Raise an exception if a list of errors is not empty.

    Parameters
    ----------
    source
        Name of the file.

    Raises
    ------
    InputError
        One line with the first errors and the number of the rest.
    """
    if problems:
        more = len(problems) - MOST_PROBLEMS
        tail = [f"and {more} more"] if more > 0 else []
        raise InputError(f"{source}: {'; '.join(problems[:MOST_PROBLEMS] + tail)}")
