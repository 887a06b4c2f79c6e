"""Reports the errors found in a file in a one-line message."""

from __future__ import annotations

from rmfs.errors import InputError

MOST_PROBLEMS = 10
"""Maximum number of errors listed in a message; the rest are counted."""


def stop_if_any(problems: list[str], source: object) -> None:
    """Raise an exception if any errors were found in a file.

    Parameters
    ----------
    problems
        Descriptions of the errors.
    source
        Name of the file that contains the errors.

    Raises
    ------
    InputError
        If `problems` is not empty. The message, one line, contains the first ten errors and the
        number of further errors.
    """
    if problems:
        more = len(problems) - MOST_PROBLEMS
        tail = [f"and {more} more"] if more > 0 else []
        raise InputError(f"{source}: {'; '.join(problems[:MOST_PROBLEMS] + tail)}")
