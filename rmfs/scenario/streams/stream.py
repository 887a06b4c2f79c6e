"""Orders and bundles with their arrival times, as arrays."""

from __future__ import annotations

from array import array
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from rmfs.scenario.streams.order_file import OrderFile

NO_DUE_US = -1
"""Value of `due_us` for an order without a due time."""


class _Frozen:
    def __post_init__(self) -> None:
        for field in fields(self):  # type: ignore[arg-type]
            column = getattr(self, field.name)
            if isinstance(column, np.ndarray):
                column.setflags(write=False)


@dataclass(frozen=True)
class OrderStream(_Frozen):
    """A stream of n orders with a total of m lines, sorted by arrival time.

    Attributes
    ----------
    time_us
        Arrival time of each order in microseconds, shape (n,).
    due_us
        Due time of each order in microseconds, `NO_DUE_US` if it has none, shape (n,).
    first_line
        Index of the first line of each order, followed by m, shape (n + 1,).
    sku, units
        SKU (index) and number of units of each line, shape (m,) each.
    file
        Order names and additional columns if the stream was read from a file; otherwise None.
    classes
        Names of the classes of orders; empty if orders have no classes.
    priority
        Index of the class of each order, -1 for an order without a class, shape (n,). None if
        `classes` is empty.
    """

    time_us: NDArray[np.int64]
    due_us: NDArray[np.int64]
    first_line: NDArray[np.int64]
    sku: NDArray[np.int64]
    units: NDArray[np.int64]
    file: OrderFile | None = None
    classes: tuple[str, ...] = ()
    priority: NDArray[np.int64] | None = None

    def __len__(self) -> int:
        return len(self.time_us)

    def lines(self, order: int) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """Return the SKU (index) of each line of an order, and the number of units of each line."""
        here = slice(int(self.first_line[order]), int(self.first_line[order + 1]))
        return tuple(self.sku[here].tolist()), tuple(self.units[here].tolist())


@dataclass(frozen=True)
class BundleStream(_Frozen):
    """A stream of n bundles, sorted by arrival time.

    Attributes
    ----------
    time_us
        Arrival time of each bundle in microseconds, shape (n,).
    sku, units
        SKU (index) and number of units of each bundle, shape (n,) each.
    file
        Bundle names and additional columns if the stream was read from a file; otherwise None.
    """

    time_us: NDArray[np.int64]
    sku: NDArray[np.int64]
    units: NDArray[np.int64]
    file: OrderFile | None = None

    def __len__(self) -> int:
        return len(self.time_us)


class OrderStreamBuilder:
    """Collects orders; needs 16 bytes per line and 32 bytes per order.

    Attributes
    ----------
    classes
        Names of the classes of orders; empty if orders have no classes.
    """

    def __init__(self, classes: tuple[str, ...] = ()) -> None:
        self.classes = classes
        self._priority = array("q")
        self._time_us, self._due_us, self._first_line = array("q"), array("q"), array("q")
        self._sku, self._units = array("q"), array("q")

    def add(
        self,
        time_us: int,
        due_us: int,
        skus: Sequence[int],
        units: Sequence[int],
        priority: int = -1,
    ) -> None:
        """Add an order, which must not arrive before the order added last."""
        self._priority.append(priority)
        self._time_us.append(time_us)
        self._due_us.append(due_us)
        self._first_line.append(len(self._sku))
        self._sku.extend(skus)
        self._units.extend(units)

    def __len__(self) -> int:
        return len(self._time_us)

    def build(self) -> OrderStream:
        """Return a stream of the orders added so far."""
        return OrderStream(
            _copied(self._time_us),
            _copied(self._due_us),
            np.append(_copied(self._first_line), len(self._sku)),
            _copied(self._sku),
            _copied(self._units),
            classes=self.classes,
            priority=_copied(self._priority) if self.classes else None,
        )


class BundleStreamBuilder:
    """Collects bundles; needs 24 bytes per bundle."""

    def __init__(self) -> None:
        self._time_us, self._sku, self._units = array("q"), array("q"), array("q")

    def add(self, time_us: int, sku: int, units: int) -> None:
        """Add a bundle, which must not arrive before the bundle added last."""
        self._time_us.append(time_us)
        self._sku.append(sku)
        self._units.append(units)

    def __len__(self) -> int:
        return len(self._time_us)

    def build(self) -> BundleStream:
        """Return a stream of the bundles added so far."""
        return BundleStream(_copied(self._time_us), _copied(self._sku), _copied(self._units))


def _copied(column: array[int]) -> NDArray[np.int64]:
    return np.array(column, dtype=np.int64)
