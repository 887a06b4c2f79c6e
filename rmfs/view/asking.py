"""What pages ask of a run, and what they are known by: numbers and names within bounds."""

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
"""More than any trace has."""

LONGEST_NAME = 64
"""Characters of the name under which a page is known."""


@dataclass(frozen=True, slots=True)
class Known:
    """What a page knows already: rows of the trace, and events.

    Raises
    ------
    InputError
        If these are no numbers of rows.
    """

    motion: int = 0
    events: int = 0

    def __post_init__(self) -> None:
        """Refuse numbers that the run could not look up."""
        for name, rows in (("motion", self.motion), ("events", self.events)):
            if not 0 <= rows <= MOST_ROWS:
                raise InputError(f"{name}: must be from 0 to {MOST_ROWS} rows")


@dataclass(eq=False)
class Request:
    """Something the run's thread does for a page; if it fails, the page receives the error."""

    done: threading.Event = field(default_factory=threading.Event)
    error: Exception | None = None

    def wait(self) -> None:
        """Wait until it is done; raise the error if it failed."""
        self.done.wait()
        if self.error is not None:
            raise self.error

    def fail(self, error: Exception) -> None:
        """Give it up."""
        self.error = error
        self.done.set()


@contextmanager
def concern_of(request: Request) -> Iterator[None]:
    """Do what a page has asked for: an error is passed to the page and does not stop the run."""
    try:
        yield
    except Exception as error:
        request.error = error
    request.done.set()


@dataclass(eq=False)
class News(Request):
    """What a page asks for, and what the run's thread copied for it."""

    known: Known = field(default_factory=Known)
    motion: dict[str, NDArray[Any]] = field(default_factory=dict)
    events: dict[str, NDArray[Any]] = field(default_factory=dict)
    header: dict[str, Any] = field(default_factory=dict)


@dataclass(eq=False)
class Exchange(Request):
    """A controller that a page wants to be installed."""

    choice: Choice = field(kw_only=True)


def page_name(page: object) -> str:
    """Return the name of a page, if it is one.

    Raises
    ------
    InputError
        If it is not.
    """
    if not isinstance(page, str) or not 0 < len(page) <= LONGEST_NAME:
        raise InputError(f"page: must be a name of at most {LONGEST_NAME} characters")
    return page
