"""Converts the rows of a file to orders or bundles, and validates them."""

from __future__ import annotations

import difflib
import math
from typing import TYPE_CHECKING, Protocol

from rmfs.scenario.due import NO_CLASS
from rmfs.scenario.streams.order_file import OrderFileBuilder
from rmfs.scenario.streams.stream import NO_DUE_US, BundleStreamBuilder, OrderStreamBuilder
from rmfs.scenario.streams.times import FieldError, Times, number

if TYPE_CHECKING:
    from collections.abc import Sequence
    from datetime import datetime

    from rmfs.scenario.problems import Problems
    from rmfs.scenario.skus import SkuSet

MOST_UNITS = 1_000_000

LONGEST_NAME = 200
"""Maximum length of the name of an order."""

MOST_COMPARED = 10_000
"""Maximum number of SKUs among which an error message looks for similar names."""


class Rows(Protocol):
    """Receives the rows of a file one after another."""

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the columns known to rmfs, in the order in which `take` expects their fields."""

    @property
    def required(self) -> frozenset[str]:
        """Names of the required columns."""

    def begin(self, further: Sequence[str]) -> None:
        """Store the names of the file's columns that are not in `columns`."""

    def take(self, number: int, fields: Sequence[str]) -> None:
        """Process a row.

        Parameters
        ----------
        number
            Number of the line (CSV) or row (Parquet) in the file.
        fields
            Fields of the columns in `columns`, in this order, with an empty text for each column
            that the file lacks; then the fields of the file's other columns.
        """

    def end(self) -> None:
        """Finish after the last row; for example, add the last order."""


class _Fields:
    """Parses single fields.

    Parameters
    ----------
    skus
        The valid SKUs.
    """

    def __init__(self, skus: SkuSet) -> None:
        self._index_of = skus.index_of
        self._by_name = {name: index for index, name in enumerate(skus.names)}

    def sku(self, text: str) -> int:
        index = self._by_name.get(text)
        if index is None and (not text or text.isdecimal() or not self._by_name):
            index = self._index_of.get(_whole("sku", text))
        if index is None:
            raise FieldError(f"sku {text:.40} is unknown; valid: {self._valid(text)}")
        return index

    def _valid(self, text: str) -> str:
        """List valid SKUs, the most similar to a text first."""
        known = list(self._by_name) or [str(sku) for sku in self._index_of]
        some = difflib.get_close_matches(text[:LONGEST_NAME], known[:MOST_COMPARED]) or known[:3]
        more = f", ... ({len(known)} SKUs)" if len(known) > len(some) else ""
        return f"{', '.join(some):.100}{more}"

    def units(self, text: str) -> int:
        units = _whole("quantity", text)
        if not 1 <= units <= MOST_UNITS:
            raise FieldError(f"quantity must be from 1 to {MOST_UNITS} (given: {text:.40})")
        return units


def _whole(column: str, text: str) -> int:
    if text.isdecimal() and len(text) < 19:
        return int(text)
    given = number(column, text)
    if given % 1 or abs(given) > 2**53:
        raise FieldError(f"{column} must be a whole number (given: {text:.40})")
    return int(given)


class _StreamRows:
    """Converts rows to orders or bundles."""

    columns: tuple[str, ...] = ("time", "order", "sku", "quantity", "due")

    def __init__(self, skus: SkuSet, problems: Problems, word: str, zero: datetime | None) -> None:
        self.file = OrderFileBuilder(())
        self._fields = _Fields(skus)
        self._times = Times(zero)
        self._problems = problems
        self._word = word
        self._time_us = 0

    def begin(self, further: Sequence[str]) -> None:
        """Store the names of the file's columns that are not in `columns`."""
        self.file = OrderFileBuilder(further)

    def take(self, number: int, fields: Sequence[str]) -> None:
        """Process a row (see `Rows`)."""
        try:
            self._take(number, fields)
        except FieldError as error:
            self._problems.add(f"{self._word} {number}: {error}")

    def _take(self, number: int, fields: Sequence[str]) -> None:
        raise NotImplementedError


class OrderRows(_StreamRows):
    """Converts rows to orders; each row is one order line.

    The lines of an order must be consecutive and have the same time, due time and priority.

    Parameters
    ----------
    skus
        The valid SKUs.
    problems
        Collects the errors of rows.
    word
        What error messages call a row: "line" or "row".
    zero
        Date and time at which simulated time is 0, for times in ISO 8601 (see `Times`).
    classes
        Names of the classes of orders. If empty, the content of a column `priority` has no meaning
        and is stored like that of other columns unknown to rmfs.
    """

    required = frozenset(("time", "order", "sku", "quantity"))

    def __init__(
        self,
        skus: SkuSet,
        problems: Problems,
        word: str,
        zero: datetime | None = None,
        classes: tuple[str, ...] = (),
    ) -> None:
        super().__init__(skus, problems, word, zero)
        if classes:
            self.columns = (*self.columns, "priority")
        self.builder = OrderStreamBuilder(classes)
        self._classes, self._priority = classes, NO_CLASS
        self._name: str | None = None
        self._due_us = NO_DUE_US
        self._skus: list[int] = []
        self._units: list[int] = []
        self._names: set[str] = set()

    def _take(self, number: int, fields: Sequence[str]) -> None:
        time, name, sku, quantity, due, *further = fields
        priority = self._class(further.pop(0)) if self._classes else NO_CLASS
        if name != self._name:
            self._begin(name)
        time_us = self._times.us("time", time)
        due_us = self._times.us("due", due) if due else NO_DUE_US
        index, units = self._fields.sku(sku), self._fields.units(quantity)
        if not self._skus:
            self._set_times(time_us, due_us, time)
            self._priority = priority
            self.file.add_order(name)
        elif time_us != self._time_us:
            raise FieldError(f"time differs from that of the previous line of order {name:.40}")
        elif due_us != self._due_us:
            raise FieldError(f"due differs from that of the previous line of order {name:.40}")
        elif priority != self._priority:
            raise FieldError(f"priority differs from that of the previous line of order {name:.40}")
        if index in self._skus:
            raise FieldError(f"sku {sku} occurs twice in order {name:.40}")
        self._skus.append(index)
        self._units.append(units)
        self.file.add_line(number, further)

    def _class(self, text: str) -> int:
        if text and text not in self._classes:
            raise FieldError(
                f"priority {text:.40} is not a class; valid: {', '.join(self._classes)}"
            )
        return self._classes.index(text) if text else NO_CLASS

    def _begin(self, name: str) -> None:
        if not name:
            raise FieldError("order is empty")
        if len(name) > LONGEST_NAME:
            raise FieldError(f"order is longer than {LONGEST_NAME} characters")
        self._close()
        self._name = name
        if name in self._names:
            raise FieldError(
                "order occurs again after another order; the lines of an order must be consecutive"
            )
        self._names.add(name)

    def _set_times(self, time_us: int, due_us: int, time: str) -> None:
        if time_us < self._time_us:
            raise FieldError(
                f"time {time} is earlier than that of the previous order; sort the file by time"
            )
        if due_us not in (NO_DUE_US, max(due_us, time_us)):
            raise FieldError("due is earlier than time")
        self._time_us, self._due_us = time_us, due_us

    def _close(self) -> None:
        """Add the order whose lines have been taken."""
        if self._skus:
            self.builder.add(self._time_us, self._due_us, self._skus, self._units, self._priority)
            self._skus, self._units = [], []

    def end(self) -> None:
        """Add the last order to the stream."""
        self._close()


class BundleRows(_StreamRows):
    """Converts rows to bundles; each row is one bundle.

    Parameters
    ----------
    skus
        The valid SKUs.
    problems
        Collects the errors of rows.
    word
        What error messages call a row: "line" or "row".
    largest
        Capacity of the largest pod, in space units; a larger bundle is an error.
    zero
        Date and time at which simulated time is 0, for times in ISO 8601 (see `Times`).
    """

    required = frozenset(("time", "sku", "quantity"))

    def __init__(
        self,
        skus: SkuSet,
        problems: Problems,
        word: str,
        largest: float = math.inf,
        zero: datetime | None = None,
    ) -> None:
        super().__init__(skus, problems, word, zero)
        self.builder = BundleStreamBuilder()
        self._space_per_unit = skus.space_per_unit
        self._largest = largest

    def _take(self, number: int, fields: Sequence[str]) -> None:
        time, name, sku, quantity, due, *further = fields
        time_us = self._times.us("time", time)
        index, units = self._fields.sku(sku), self._fields.units(quantity)
        if due:
            raise FieldError("due must be empty: bundles have no due time")
        if time_us < self._time_us:
            raise FieldError(
                f"time {time} is earlier than that of the previous bundle; sort the file by time"
            )
        space = units * float(self._space_per_unit[index])
        if space > self._largest:
            raise FieldError(
                f"quantity {units} takes {space:.6g} space units, but no pod holds more than "
                f"{self._largest:g}"
            )
        self._time_us = time_us
        self.builder.add(time_us, index, units)
        self.file.add_order(name)
        self.file.add_line(number, further)

    def end(self) -> None:
        """Do nothing, because `take` has already added all bundles."""
