"""The agenda: what happens when, in a total order, so that a run repeats."""

from __future__ import annotations

from heapq import heappop, heappush
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

Entry = list  # [time_us, priority, serial, callback or None]: lists, since they are cancelled in place

NEVER_US = 1 << 62
"""Later than any event, in microseconds."""


class Agenda:
    """A heap of callbacks ordered by time, priority and serial number.

    Of entries with equal time the one with the lower priority number comes first; of these the one
    that was entered first.
    """

    def __init__(self) -> None:
        self._heap: list[Entry] = []
        self._serial = 0

    def __len__(self) -> int:
        return sum(entry[3] is not None for entry in self._heap)

    @property
    def next_us(self) -> int:
        """Time of the next entry, `NEVER_US` if there is none."""
        heap = self._heap
        while heap and heap[0][3] is None:
            heappop(heap)
        return heap[0][0] if heap else NEVER_US

    def at(self, time_us: int, callback: Callable[[], None], priority: int = 0) -> Entry:
        """Enter a callback; the entry returned is good for `cancel`."""
        self._serial += 1
        entry: Entry = [time_us, priority, self._serial, callback]
        heappush(self._heap, entry)
        return entry

    @staticmethod
    def cancel(entry: Entry) -> None:
        """Make an entry have no effect; nothing happens if it is over already."""
        entry[3] = None

    def run_due(self, now_us: int) -> None:
        """Call everything due, in order, with what the callbacks enter for this time."""
        heap = self._heap
        while heap and heap[0][0] <= now_us:
            callback = heappop(heap)[3]
            if callback is not None:
                callback()
