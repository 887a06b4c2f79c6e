"""The agenda: what happens when, in a total order, so that a run repeats."""

from __future__ import annotations

from heapq import heappop, heappush
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

NEVER_US = 1 << 62
"""Later than any event, in microseconds."""


class Agenda:
    """A heap of callbacks ordered by time, priority and serial number.

    Of entries with equal time the one with the lower priority number comes first; of these the one
    that was entered first.
    """

    def __init__(self) -> None:
        self._heap: list[tuple[int, int, int, Callable[[], None]]] = []
        self._cancelled: set[int] = set()
        self._serial = 0

    def __len__(self) -> int:
        return len(self._heap) - len(self._cancelled)

    @property
    def next_us(self) -> int:
        """Time of the next entry, `NEVER_US` if there is none."""
        if self._cancelled:
            self._drop_cancelled()
        return self._heap[0][0] if self._heap else NEVER_US

    def at(self, time_us: int, callback: Callable[[], None], priority: int = 0) -> int:
        """Enter a callback; returns its serial number, by which it can be cancelled."""
        self._serial += 1
        heappush(self._heap, (time_us, priority, self._serial, callback))
        return self._serial

    def cancel(self, serial: int) -> None:
        """Make an entry that has not been called yet have no effect."""
        self._cancelled.add(serial)

    def run_due(self, now_us: int) -> None:
        """Call everything due, in order, with what the callbacks enter for this time."""
        heap = self._heap
        while heap and heap[0][0] <= now_us:
            _, _, serial, callback = heappop(heap)
            if serial in self._cancelled:
                self._cancelled.remove(serial)
            else:
                callback()

    def _drop_cancelled(self) -> None:
        while self._heap and self._heap[0][2] in self._cancelled:
            self._cancelled.remove(heappop(self._heap)[2])
