"""Collects the errors in a file, to report them in one line."""

from __future__ import annotations

from rmfs.errors import InputError

MOST_SHOWN = 10
"""Maximum number of errors listed in a message; the rest are counted."""


class Problems:
    """Collects the errors found in an input file, and reports them together.

    Parameters
    ----------
    source
        Name of the file.
    """

    def __init__(self, source: object) -> None:
        self._source = source
        self._shown: list[str] = []
        self.count = 0

    def add(self, problem: str) -> None:
        """Add an error; only the first `MOST_SHOWN` are kept, and the rest are counted."""
        self.count += 1
        if len(self._shown) < MOST_SHOWN:
            self._shown.append(problem)

    def stop_if_any(self) -> None:
        """Raise an exception if errors were added.

        Raises
        ------
        InputError
            If there are errors; the message is one line with the first errors and the number of
            the rest.
        """
        if self.count:
            more = self.count - len(self._shown)
            tail = [f"and {more} more"] if more else []
            raise InputError(f"{self._source}: {'; '.join(self._shown + tail)}")
