"""Rows of a file become orders or bundles, if nothing is wrong with them."""

from __future__ import annotations

import hashlib
import math
from array import array
from typing import TYPE_CHECKING, Protocol

import numpy as np

from rmfs.scenario.clock import nearest_us
from rmfs.scenario.streams.stream import NO_DUE_US, BundleStreamBuilder, OrderStreamBuilder

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.scenario.problems import Problems
    from rmfs.scenario.skus import SkuSet

LATEST_S = 1e9
"""Latest time in a file: thirty years."""

MOST_UNITS = 1_000_000

LONGEST_NAME = 200
"""Characters in the name of an order."""


class Rows(Protocol):
    """Takes the rows of a file one after another."""

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the columns that a file may have."""

    @property
    def required(self) -> frozenset[str]:
        """Names of those that it must have."""

    def take(self, number: int, fields: Sequence[str]) -> None:
        """Take a row.

        Parameters
        ----------
        number
            Of the line or row, for messages.
        fields
            In the order of `columns`; empty where the file has none.
        """

    def end(self) -> None:
        """Check what only the whole file shows."""


class _FieldError(ValueError):
    """A field is wrong: its column, and why."""


class _Fields:
    """Reads single fields.

    Parameters
    ----------
    skus
        The SKUs that rows may name.
    """

    def __init__(self, skus: SkuSet) -> None:
        self._index_of = skus.index_of
        self._by_name = {name: index for index, name in enumerate(skus.names)}

    def time_us(self, column: str, text: str) -> int:
        time_s = _number(column, text)
        if not 0 <= time_s <= LATEST_S:
            raise _FieldError(f"{column} must be from 0 to {LATEST_S:g} s (given: {text:.40})")
        return nearest_us(time_s)

    def sku(self, text: str) -> int:
        index = self._by_name.get(text)
        if index is None and (not text or text.isdecimal() or not self._by_name):
            index = self._index_of.get(_whole("sku", text))
        if index is None:
            raise _FieldError(f"sku {text:.40} is unknown")
        return index

    def units(self, text: str) -> int:
        units = _whole("quantity", text)
        if not 1 <= units <= MOST_UNITS:
            raise _FieldError(f"quantity must be from 1 to {MOST_UNITS} (given: {text:.40})")
        return units


def _number(column: str, text: str) -> float:
    try:
        number = math.nan if "_" in text else float(text)
    except ValueError:
        number = math.nan
    if math.isfinite(number):
        return number
    given = f"(given: {text!r:.40})" if text else "(empty)"
    raise _FieldError(f"{column} must be a number {given}")


def _whole(column: str, text: str) -> int:
    if text.isdecimal() and len(text) < 19:
        return int(text)
    number = _number(column, text)
    if number % 1 or abs(number) > 2**53:
        raise _FieldError(f"{column} must be a whole number (given: {text:.40})")
    return int(number)


class OrderRows:
    """Rows of orders: the lines of an order follow each other and agree in time and due time.

    Parameters
    ----------
    skus
        The SKUs that rows may name.
    problems
        Where to note what is wrong.
    word
        What a row is called: line or row.
    """

    columns = ("time", "order", "sku", "quantity", "due")
    required = frozenset(("time", "order", "sku", "quantity"))

    def __init__(self, skus: SkuSet, problems: Problems, word: str) -> None:
        self.builder = OrderStreamBuilder()
        self._fields = _Fields(skus)
        self._problems = problems
        self._word = word
        self._name: str | None = None
        self._begun_at = 0
        self._time_us = 0
        self._due_us = NO_DUE_US
        self._skus: list[int] = []
        self._units: list[int] = []
        # names of orders as hashes of 8 bytes: a repetition is found without keeping the names
        self._names = array("Q")
        self._numbers = array("Q")

    def take(self, number: int, fields: Sequence[str]) -> None:
        """Take a row (see `Rows`)."""
        try:
            self._take(number, fields)
        except _FieldError as error:
            self._problems.add(f"{self._word} {number}: {error}")

    def _take(self, number: int, fields: Sequence[str]) -> None:
        time, name, sku, quantity, due = fields
        if name != self._name:
            self._begin(number, name)
        time_us = self._fields.time_us("time", time)
        due_us = self._fields.time_us("due", due) if due else NO_DUE_US
        index, units = self._fields.sku(sku), self._fields.units(quantity)
        if not self._skus:
            self._set_times(time_us, due_us, time)
        elif time_us != self._time_us:
            raise _FieldError(f"time differs from the line before of order {name:.40}")
        elif due_us != self._due_us:
            raise _FieldError(f"due differs from the line before of order {name:.40}")
        if index in self._skus:
            raise _FieldError(f"sku {sku} comes twice in order {name:.40}")
        self._skus.append(index)
        self._units.append(units)

    def _begin(self, number: int, name: str) -> None:
        if not name:
            raise _FieldError("order is empty")
        if len(name) > LONGEST_NAME:
            raise _FieldError(f"order is longer than {LONGEST_NAME} characters")
        self._close()
        self._name = name
        hashed = hashlib.blake2b(name.encode(), digest_size=8).digest()
        self._names.append(int.from_bytes(hashed, "little"))
        self._numbers.append(number)

    def _set_times(self, time_us: int, due_us: int, time: str) -> None:
        if time_us < self._time_us:
            raise _FieldError(f"time {time} is before that of the order before")
        if due_us not in (NO_DUE_US, max(due_us, time_us)):
            raise _FieldError("due is before time")
        self._time_us, self._due_us = time_us, due_us

    def _close(self) -> None:
        """Add the order whose lines have been taken."""
        if self._skus:
            self.builder.add(self._time_us, self._due_us, self._skus, self._units)
            self._skus, self._units = [], []

    def end(self) -> None:
        """Add the last order and look for orders whose lines do not follow each other."""
        self._close()
        names = np.array(self._names, dtype=np.uint64)
        _, first = np.unique(names, return_index=True)
        again = np.ones(len(names), dtype=bool)
        again[first] = False
        for at in np.flatnonzero(again).tolist():
            self._problems.add(
                f"{self._word} {self._numbers[at]}: order is one that ended before; "
                "the lines of an order must follow each other"
            )


class BundleRows:
    """Rows of bundles: each is a bundle.

    Parameters
    ----------
    skus
        The SKUs that rows may name.
    problems
        Where to note what is wrong.
    word
        What a row is called: line or row.
    largest
        Space units of the largest pod.
    """

    columns = ("time", "order", "sku", "quantity", "due")
    required = frozenset(("time", "sku", "quantity"))

    def __init__(
        self, skus: SkuSet, problems: Problems, word: str, largest: float = math.inf
    ) -> None:
        self.builder = BundleStreamBuilder()
        self._fields = _Fields(skus)
        self._space_per_unit = skus.space_per_unit
        self._problems = problems
        self._word = word
        self._largest = largest
        self._time_us = 0

    def take(self, number: int, fields: Sequence[str]) -> None:
        """Take a row (see `Rows`)."""
        try:
            self._take(fields)
        except _FieldError as error:
            self._problems.add(f"{self._word} {number}: {error}")

    def _take(self, fields: Sequence[str]) -> None:
        time, _, sku, quantity, due = fields
        time_us = self._fields.time_us("time", time)
        index, units = self._fields.sku(sku), self._fields.units(quantity)
        if due:
            raise _FieldError("due must be empty: bundles have no due time")
        if time_us < self._time_us:
            raise _FieldError(f"time {time} is before that of the bundle before")
        space = units * float(self._space_per_unit[index])
        if space > self._largest:
            raise _FieldError(
                f"quantity {units} takes {space:.6g} space units, but no pod holds more than "
                f"{self._largest:g}"
            )
        self._time_us = time_us
        self.builder.add(time_us, index, units)

    def end(self) -> None:
        """Nothing is left to check."""
