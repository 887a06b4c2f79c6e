"""An intake: several processes by which orders, or bundles, come into being."""

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
    """An order that comes now.

    Attributes
    ----------
    time_us
        Now.
    skus, units
        The SKU of each line, all different, and how many units of it.
    due_us
        When it is due.
    redraws
        How often a SKU was drawn of which too little was uncommitted.
    in_file
        Its place among the orders of a file, or -1.
    priority
        Its class, or -1 where there are none.
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
        """Let a drawn order come at a time."""
        due_us = time_us + nearest_us(content.due_offset_s)
        skus, units, priority = content.skus, content.units, content.priority
        return cls(time_us, skus, units, due_us, content.redraws, priority=priority)

    @property
    def due_s(self) -> float:
        """When it is due, in s."""
        return self.due_us / US_PER_S


class BundleArrival(NamedTuple):
    """A bundle that comes now: so many units of one SKU, and the space units they take.

    `in_file` is its place among the bundles of a file, or -1.
    """

    time_us: int
    sku: int
    units: int
    space: float
    in_file: int = -1


@runtime_checkable
class Redrawn(Protocol):
    """A process that knows what comes next before it comes."""

    def redraw(self, now_us: int) -> None:
        """Draw that again."""


T = TypeVar("T")
T_co = TypeVar("T_co", covariant=True)


class Process(Protocol[T_co]):
    """One way in which things come into being."""

    @property
    def next_us(self) -> int:
        """When to be asked again at the latest; `NEVER_US`: after a change of state only."""

    def draw(self, now_us: int, state: State) -> T_co | None:
        """Return the next thing that comes now, or None if nothing more does."""


class Intake(Generic[T]):
    """All orders, or all bundles, of a run.

    Parameters
    ----------
    processes
        How they come into being; at one time, those of the first process come first.
    record
        Told of each.
    stream
        The orders or bundles of a file, if they come from one.
    finish
        Makes of each what comes.
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
        """When to be asked again at the latest, after all that is due has been taken."""
        return min(process.next_us for process in self._processes)

    def redraw(self, now_us: int) -> None:
        """Draw again when things come next, after the streams have been renewed.

        Raises
        ------
        InputError
            If they come at times that stand in a file.
        """
        for process in self._processes:
            if isinstance(process, Redrawn):
                process.redraw(now_us)

    def due(self, now_us: int, state: State) -> Iterator[T]:
        """Yield what comes now; the caller adds each to the state before it asks for the next.

        To be asked at time zero, at `next_us`, and after every change of backlog or stock.

        Parameters
        ----------
        now_us
            Present time, not before that of the call before.
        state
            Is read anew for each thing.
        """
        for process in self._processes:
            while (thing := process.draw(now_us, state)) is not None:
                if self._finish is not None:
                    thing = self._finish(thing)
                if self._record is not None:
                    self._record(thing)
                yield thing
