"""Open requests, by SKU, of the orders at a pick station or of the orders in its pool.

The pool of a station consists of orders of the backlog that are reserved for it.
"""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    import numpy as np
    from numpy.typing import NDArray

    from rmfs.world.news import News
    from rmfs.world.orders import Order, OrderLine


class OpenRequests:
    """Open requests of the orders at a pick station or of the orders in its pool.

    A request is open until it is bound to a pod.

    Parameters
    ----------
    need
        Open units per SKU, shape (K,): the station's row of `WorldState.need` or `queued_need`,
        which this object keeps up to date.
    news, station
        Followers of `news` are notified of a change at `station` whenever the number of open
        requests rises from zero or falls to zero.

    Attributes
    ----------
    lines
        By SKU, the lines with open units, in the sequence in which they were added; lines that
        `reopen` added come first.
    units
        Open units in total.
    version
        Increases whenever requests are added, and whenever only some of the open requests of an
        order in the pool are bound to a pod, since another pod may be able to serve the rest. A
        rule that found no pod for the requests need not search again until the version has
        increased or a pod has become available.
    """

    def __init__(self, need: NDArray[np.int32], news: News, station: int) -> None:
        self._need = need
        self._news, self._station = news, station
        self.lines: dict[int, deque[OrderLine]] = {}
        self.units = 0
        self.version = 0

    def add(self, order: Order) -> None:
        """Add the open requests of an order."""
        self.add_lines(order.lines)

    def add_lines(self, lines: Iterable[OrderLine]) -> None:
        """Add the open requests of lines."""
        before = self.units
        for line in lines:
            if line.open_units:
                self.lines.setdefault(line.sku, deque()).append(line)
                self._need[line.sku] += line.open_units
                self.units += line.open_units
        self.version += 1
        self._count_from(before)

    def _count_from(self, before: int) -> None:
        if (before == 0) != (self.units == 0):
            self._news.tell(self._station)

    def remove(self, order: Order) -> None:
        """Remove the open requests of an order."""
        for line in order.lines:
            if line.open_units:
                waiting = self.lines[line.sku]
                waiting.remove(line)
                if not waiting:
                    del self.lines[line.sku]
                self._need[line.sku] -= line.open_units
        before = self.units
        self.units -= order.open_units
        self._count_from(before)

    def reopen(self, line: OrderLine) -> None:
        """Reopen a request of a line; a line without open requests becomes the first in `lines`."""
        if not line.open_units:
            self.lines.setdefault(line.sku, deque()).appendleft(line)
        line.open_units += 1
        line.order.open_units += 1
        self._need[line.sku] += 1
        self.units += 1
        self.version += 1
        self._count_from(self.units - 1)

    def take(self, sku: int, at_most: int) -> list[OrderLine]:
        """Remove at most `at_most` open requests for a SKU, line by line in the order of `lines`.

        Returns
        -------
        list of OrderLine
            The line of each request removed.
        """
        waiting = self.lines.get(sku)
        taken: list[OrderLine] = []
        while waiting and len(taken) < at_most:
            line = waiting[0]
            count = min(line.open_units, at_most - len(taken))
            line.open_units -= count
            line.order.open_units -= count
            taken.extend([line] * count)
            if not line.open_units:
                waiting.popleft()
        if waiting is not None and not waiting:
            del self.lines[sku]
        if taken:
            self._need[sku] -= len(taken)
            self.units -= len(taken)
            self._count_from(self.units + len(taken))
        return taken

    def take_line(self, line: OrderLine, at_most: int) -> int:
        """Remove at most `at_most` open requests of one line; return how many."""
        count = min(line.open_units, at_most)
        if count:
            line.open_units -= count
            line.order.open_units -= count
            if not line.open_units:
                waiting = self.lines[line.sku]
                waiting.remove(line)
                if not waiting:
                    del self.lines[line.sku]
            self._need[line.sku] -= count
            self.units -= count
            self._count_from(self.units + count)
        return count
