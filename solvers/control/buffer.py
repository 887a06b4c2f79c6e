"""Limit on the frequency of questions to an optimiser."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rmfs.control.view import View


class Buffer:
    """Lets a controller ask at most once per `buffer_s`.

    Parameters
    ----------
    view
        The view, which provides the clock.
    buffer_s
        Minimum number of seconds between two questions.
    """

    def __init__(self, view: View, buffer_s: float) -> None:
        self._view = view
        self._buffer_s = buffer_s
        self._asked_s = -inf
        self._wanted = False

    def is_over(self, wanted: bool = True) -> bool:
        """Return whether to ask now; a question wanted too early is due at `next_event_s`.

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
            Whether to ask again as soon as the buffer time is over. Default: only after an event.
        """
        self._asked_s = self._view.now_s
        self._wanted = again

    @property
    def next_event_s(self) -> float:
        """Return when a question may next be asked, in s; inf if an event has to occur first."""
        return self._asked_s + self._buffer_s if self._wanted else inf
