"""Requests from pages to a live run, and validation of the numbers and names in them."""

from __future__ import annotations

import threading
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from rmfs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from rmfs.control.choices import Choice

MOST_ROWS = 1 << 48
"""Largest number of rows that a page may claim to have; no trace has as many."""

LONGEST_NAME = 64
"""Maximum length of the name of a page."""


@dataclass(frozen=True, slots=True)
class Known:
    """How many rows of the trace, and how many events, a page already has.

    Raises
    ------
    InputError
        If a number is negative or greater than `MOST_ROWS`.
    """

    motion: int = 0
    events: int = 0

    def __post_init__(self) -> None:
        """Refuse numbers that are out of range."""
        for name, rows in (("motion", self.motion), ("events", self.events)):
            if not 0 <= rows <= MOST_ROWS:
                raise InputError(f"{name}: must be from 0 to {MOST_ROWS} rows")


@dataclass(eq=False)
class Request:
    """A task that the run's thread does for a page; if it fails, the page gets the error."""

    done: threading.Event = field(default_factory=threading.Event)
    error: Exception | None = None

    def wait(self) -> None:
        """Wait until the task is done; raise its error if it failed."""
        self.done.wait()
        if self.error is not None:
            raise self.error

    def fail(self, error: Exception) -> None:
        """Mark the task as failed."""
        self.error = error
        self.done.set()


@contextmanager
def concern_of(request: Request) -> Iterator[None]:
    """Return a context manager for work on a page's request, which is marked as done on exit.

    An error is passed to the page and does not stop the run.
    """
    try:
        yield
    except Exception as error:
        request.error = error
    request.done.set()


@dataclass(eq=False)
class News(Request):
    """A request for new motion and events, and the data copied by the run's thread to answer it."""

    known: Known = field(default_factory=Known)
    motion: dict[str, NDArray[Any]] = field(default_factory=dict)
    events: dict[str, NDArray[Any]] = field(default_factory=dict)
    header: dict[str, Any] = field(default_factory=dict)


@dataclass(eq=False)
class Exchange(Request):
    """A request to install another controller."""

    choice: Choice = field(kw_only=True)


def page_name(page: object) -> str:
    """Return `page` if it can be the name of a page: a string of 1 to `LONGEST_NAME` characters.

    Raises
    ------
    InputError
        If `page` is not such a name.
    """
    if not isinstance(page, str) or not 0 < len(page) <= LONGEST_NAME:
        raise InputError(f"page: must be a name of 1 to {LONGEST_NAME} characters")
    return page
