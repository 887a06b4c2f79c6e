"""The events of a run as arrays; events can be selected by kind."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rmfs.measure.events import KINDS, Happening

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

    Integers = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Rows:
    """Events of a run: one array per column, each of shape (E,).

    Attributes
    ----------
    number
        Row number of each event in `events.parquet`.
    kind
        Kind of each event (`Happening`).
    """

    number: Integers
    time_us: Integers
    kind: Integers
    robot: Integers
    pod: Integers
    station: Integers
    order: Integers
    sku: Integers
    units: Integers

    @classmethod
    def of(cls, events: pd.DataFrame) -> Rows:
        """Create the rows from the table of all events of a run, in chronological order."""
        numbers = {name: number for number, name in enumerate(KINDS)}
        kind = np.asarray(events["kind"].map(numbers), np.int64)
        names = ("time_us", "robot", "pod", "station", "order", "sku", "units")
        columns = {name: events[name].to_numpy(np.int64) for name in names}
        return cls(number=np.arange(len(events)), kind=kind, **columns)

    def __len__(self) -> int:
        """Return the number of events."""
        return len(self.number)

    def taken(self, which: NDArray[np.bool_] | Integers) -> Rows:
        """Return the selected events."""
        return Rows(*(getattr(self, name)[which] for name in self.__slots__))

    def of_kind(self, *kinds: Happening) -> Rows:
        """Return the events of the given kinds."""
        return self.taken(np.isin(self.kind, kinds))

    def tell(self, row: int, what: str) -> str:
        """Return a line of text that states the event at index `row` and its fault, `what`."""
        kind = KINDS[int(self.kind[row])]
        return f"{self.time_us[row] / 1e6:.6f} s, row {self.number[row]} ({kind}): {what}"

    def lines(self, wrong: NDArray[np.bool_], what: str) -> list[str]:
        """Return a line of text for each event that is marked as wrong, in order of row numbers.

        Parameters
        ----------
        wrong
            Whether each event is wrong, shape (E,).
        what
            Description of the fault.
        """
        rows = np.flatnonzero(wrong)
        return [
            self.tell(int(row), what) for row in rows[np.argsort(self.number[rows], kind="stable")]
        ]


def running(
    groups: tuple[Integers, ...], change: NDArray[np.float64]
) -> tuple[Integers, NDArray[np.float64]]:
    """Return the cumulative sums of changes, separately for each group of changes.

    Parameters
    ----------
    groups
        Arrays with one key per change. Changes that have the same keys in all arrays form a group.
    change
        The changes, in chronological order.

    Returns
    -------
    tuple
        A permutation that sorts the changes by group, and the cumulative sums in this sorted order:
        each is the sum of a change and all earlier changes of its group.
    """
    order = np.lexsort(groups[::-1])
    total = np.cumsum(change[order])
    first = np.zeros(len(order), np.bool_)
    if len(order):
        first[0] = True
    for group in groups:
        sorted_ = group[order]
        first[1:] |= sorted_[1:] != sorted_[:-1]
    begins = np.flatnonzero(first)
    before = np.zeros(len(order))
    if len(begins):
        sizes = np.diff(np.append(begins, len(order)))
        offset = np.append(0.0, total)[begins]
        before = np.repeat(offset, sizes)
    return order, total - before
