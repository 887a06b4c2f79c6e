"""An intake: one or more processes that generate all orders, or all bundles, of a run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Generic, NamedTuple, Protocol, TypeVar, runtime_checkable

from rmfs.scenario.clock import US_PER_S, nearest_us
from rmfs.scenario.due import NO_CLASS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from rmfs.scenario.intake.state import State
    from rmfs.scenario.orders import OrderContent
    from rmfs.scenario.streams import BundleStream, OrderStream


class OrderArrival(NamedTuple):
    """An order that arrives.

    Attributes
    ----------
    time_us
        Arrival time.
    skus, units
        SKU and number of units of each line; all SKUs are different.
    due_us
        Due time.
    redraws
        Number of draws of a SKU that were rejected because earlier orders left too few units of it.
    in_file
        Position of the order in the file from which it comes; -1 if it comes from no file.
    priority
        Index of the order's class; -1 unless `orders.due.mode = "classes"`.
    """

    time_us: int
    skus: tuple[int, ...]
    units: tuple[int, ...]
    due_us: int
    redraws: int
    in_file: int = -1
    priority: int = NO_CLASS

    @classmethod
    def of(cls, content: OrderContent, time_us: int) -> OrderArrival:
        """Return the arrival, at a given time, of an order with the given content."""
        due_us = time_us + nearest_us(content.due_offset_s)
        skus, units, priority = content.skus, content.units, content.priority
        return cls(time_us, skus, units, due_us, content.redraws, priority=priority)

    @property
    def due_s(self) -> float:
        """Due time in s."""
        return self.due_us / US_PER_S


class BundleArrival(NamedTuple):
    """A bundle that arrives: units of one SKU, and the space they take, in space units.

    `in_file` is the position of the bundle in the file from which it comes; -1 if it comes from no
    file.
    """

    time_us: int
    sku: int
    units: int
    space: float
    in_file: int = -1


@runtime_checkable
class Redrawn(Protocol):
    """A process that draws its next arrival in advance, and can draw it again."""

    def redraw(self, now_us: int) -> None:
        """Redraw the next arrival."""


T = TypeVar("T")
T_co = TypeVar("T_co", covariant=True)


class Process(Protocol[T_co]):
    """A process that generates orders or bundles."""

    @property
    def next_us(self) -> int:
        """Time by which `draw` must be called again.

        `NEVER_US` means that it need not be called until the state changes.
        """

    def draw(self, now_us: int, state: State) -> T_co | None:
        """Return the next arrival whose time has come, or None if there is none."""


class Intake(Generic[T]):
    """All orders, or all bundles, of a run.

    Parameters
    ----------
    processes
        The processes that generate the arrivals. Simultaneous arrivals are yielded in the sequence
        of their processes.
    record
        Function that is called with each arrival.
    stream
        The orders or bundles of a file, if arrivals come from one.
    finish
        Function that transforms each arrival, for example to postpone its due time.
    """

    def __init__(
        self,
        processes: Sequence[Process[T]],
        record: Callable[[T], None] | None = None,
        stream: OrderStream | BundleStream | None = None,
        finish: Callable[[T], T] | None = None,
    ) -> None:
        self._processes = processes
        self._finish = finish
        self._record = record
        self.stream = stream

    @property
    def next_us(self) -> int:
        """Time by which `due` must be called again; valid after `due` has yielded all arrivals."""
        if len(self._processes) == 1:  # the usual case, and this is asked after every change
            return self._processes[0].next_us
        return min(process.next_us for process in self._processes)

    def redraw(self, now_us: int) -> None:
        """Redraw the next arrivals, after the random streams have been replaced.

        Raises
        ------
        InputError
            If arrivals come from a file.
        """
        for process in self._processes:
            if isinstance(process, Redrawn):
                process.redraw(now_us)

    def due(self, now_us: int, state: State) -> Iterator[T]:
        """Yield the arrivals whose time has come.

        This method must be called at time zero, at `next_us`, and after every change of backlog or
        stock. The caller must add each arrival to the state before it requests the next one.

        Parameters
        ----------
        now_us
            Current time, which must not decrease between calls.
        state
            Current state, which is evaluated again for each arrival.
        """
        for process in self._processes:
            while (thing := process.draw(now_us, state)) is not None:
                if self._finish is not None:
                    thing = self._finish(thing)
                if self._record is not None:
                    self._record(thing)
                yield thing
