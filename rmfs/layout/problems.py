"""Reports the errors found in a file, in a message of one line."""

from __future__ import annotations

from rmfs.errors import InputError

MOST_PROBLEMS = 10
"""Maximum number of errors listed in a message; the rest are counted."""


def stop_if_any(problems: list[str], source: object) -> None:
    """Raise an exception if a list of errors is not empty.

    Parameters
    ----------
    source
        Name of the file that contains the errors.

    Raises
    ------
    InputError
        If `problems` is not empty; the message is one line with the first ten errors and the number
        of the rest.
    """
    if problems:
        more = len(problems) - MOST_PROBLEMS
        tail = [f"and {more} more"] if more > 0 else []
        raise InputError(f"{source}: {'; '.join(problems[:MOST_PROBLEMS] + tail)}")
