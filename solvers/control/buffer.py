"""Limit on the frequency of questions to an optimiser."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rmfs.control.view import View


class Buffer:
    """Lets a controller ask its optimiser at most once in `buffer_s` seconds (the buffer time).

    Parameters
    ----------
    view
        The controller's view of the world, which provides the clock.
    buffer_s
        Minimum number of seconds between two questions.
    """

    def __init__(self, view: View, buffer_s: float) -> None:
        self._view = view
        self._buffer_s = buffer_s
        self._asked_s = -inf
        self._wanted = False

    def is_over(self, wanted: bool = True) -> bool:
        """Return whether to ask the optimiser now.

        The result is true if `wanted` is true and the buffer time is over. If `wanted` is true but
        the buffer time is not over, the call also sets `next_event_s` to the end of the buffer
        time.

        Parameters
        ----------
        wanted
            Whether there is something to ask.
        """
        over = self._view.now_s >= self._asked_s + self._buffer_s
        self._wanted = wanted and not over
        return wanted and over

    def begin(self, again: bool = False) -> None:
        """Record that the optimiser is asked now.

        Parameters
        ----------
        again
            Whether to ask again at the end of the buffer time even if no event occurs until then.
        """
        self._asked_s = self._view.now_s
        self._wanted = again

    @property
    def next_event_s(self) -> float:
        """Return when a question may next be asked, in s; inf if an event has to occur first."""
        return self._asked_s + self._buffer_s if self._wanted else inf
