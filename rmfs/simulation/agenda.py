"""The agenda: current time and future events, in a unique order that makes runs repeatable."""

from __future__ import annotations

from heapq import heappop, heappush
from math import ceil
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

NEVER_US = 1 << 62
"""A time later than any event, in microseconds."""

LAST = 9
"""Priority of entries that only observe: they come after all others at the same time."""


def us_at(time_s: float) -> int:
    """Convert a time in s to microseconds, rounded up."""
    time_us = ceil(time_s * 1e6)
    return time_us if time_us / 1e6 >= time_s else time_us + 1


class Agenda:
    """A heap of callbacks ordered by time, priority and serial number.

    Of entries with equal time, the one with the lowest priority number comes first; of those with
    equal priority, the one that was added first. Callbacks must be bound methods or partials of
    bound methods, so that a simulation can be copied and saved with its future events.

    Attributes
    ----------
    now_us
        Current time in microseconds; the run loop advances it.
    """

    def __init__(self) -> None:
        self.now_us = 0
        self._heap: list[tuple[int, int, int, Callable[[], None]]] = []
        self._cancelled: dict[int, None] = {}
        self._serial = 0
        self._settled: list[Callable[[], None]] = []

    def __len__(self) -> int:
        return len(self._heap) - len(self._cancelled)

    @property
    def next_us(self) -> int:
        """Time of the next entry in microseconds; `NEVER_US` if there is none."""
        if self._cancelled:
            self._drop_cancelled()
        return self._heap[0][0] if self._heap else NEVER_US

    def at(self, time_us: int, callback: Callable[[], None], priority: int = 0) -> int:
        """Add a callback; return its serial number, which is needed to cancel it."""
        self._serial += 1
        heappush(self._heap, (time_us, priority, self._serial, callback))
        return self._serial

    def after(self, us: int, callback: Callable[[], None]) -> int:
        """Add a callback after a delay in microseconds; return its serial number."""
        return self.at(self.now_us + us, callback)

    def cancel(self, serial: int) -> None:
        """Cancel the entry with this serial number; its callback must not have been called yet."""
        self._cancelled[serial] = None

    def run_due(self) -> None:
        """Call all callbacks due now, in order, including those added meanwhile for this time."""
        heap, now_us = self._heap, self.now_us
        while heap and heap[0][0] <= now_us:
            _, _, serial, callback = heappop(heap)
            if serial in self._cancelled:
                del self._cancelled[serial]
            else:
                callback()

    def when_settled(self, callback: Callable[[], None]) -> None:
        """Add a callback to be called at the current time, after the controllers have decided."""
        self._settled.append(callback)

    def run_settled(self) -> bool:
        """Call all callbacks added by `when_settled`; return whether there were any."""
        if not self._settled:
            return False
        callbacks, self._settled = self._settled, []
        for callback in callbacks:
            callback()
        return True

    def _drop_cancelled(self) -> None:
        while self._heap and self._heap[0][2] in self._cancelled:
            del self._cancelled[heappop(self._heap)[2]]
