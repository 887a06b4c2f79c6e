"""Copies of a running simulation in memory; for files, see `rmfs.simulation.saving`.

The whole state of a simulation can be pickled: entries of the agenda are bound methods, or partials
of bound methods, and the state contains no generators of controllers. Copies are made by pickling,
but share objects that never change.
"""

from __future__ import annotations

import io
import pickle
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import numpy as np

from rmfs.observer import Observer
from rmfs.random import Stream, generator
from rmfs.scenario.substreams import Substreams
from rmfs.simulation.arrays import ArrayPickler

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from rmfs.simulation.kernel import Kernel

K = TypeVar("K", bound="Kernel")

_SHARED: ContextVar[Sequence[Any]] = ContextVar("_SHARED")
"""Objects that the copy being made shares with the original."""

_STREAMS: ContextVar[tuple[int, tuple[int, ...]]] = ContextVar("_STREAMS")
"""Seed and path of the random streams of the copy being made."""


def fork(simulation: K) -> K:
    """Copy a simulation; see `Simulation.fork`."""
    original, copied = _never_changing(simulation), _never_changing(simulation)
    fleet = original.index(simulation.traffic)
    copied[fleet] = simulation.traffic.fork()
    twin: K = _copied(simulation, original, copied)
    return twin


class Snapshot(Generic[K]):
    """A saved state of a simulation, for copies whose future random events are drawn anew.

    Parameters
    ----------
    along
        Object that is copied together with the simulation, and may refer to parts of it.
    spectators
        Observers without influence on the run. In copies, they are replaced by observers that do
        nothing.
    """

    def __init__(self, simulation: K, along: Any, spectators: Sequence[Observer]) -> None:
        original = [*_never_changing(simulation), *spectators]
        self._seed = simulation.seed
        self._fleet = original.index(simulation.traffic)
        self._shared = [*_never_changing(simulation), *(Observer() for _ in spectators)]
        self._shared[self._fleet] = simulation.traffic.fork()
        stream = io.BytesIO()
        arrays: list[pickle.PickleBuffer] = []
        _Redrawing(stream, original, arrays.append).dump((simulation, along))
        self._content = stream.getvalue()
        self._arrays = [_copy(array) for array in arrays]

    def __call__(self, path: tuple[int, ...]) -> tuple[K, Any]:
        """Return a copy of the simulation and of `along`.

        Parameters
        ----------
        path
            Identifies the random streams: copies with the same path face the same future.
        """
        shared = list(self._shared)
        shared[self._fleet] = self._shared[self._fleet].fork()
        tokens = _SHARED.set(shared), _STREAMS.set((self._seed, path))
        try:
            buffers = (_copy(pickle.PickleBuffer(array)) for array in self._arrays)
            twin: K
            twin, along = pickle.loads(self._content, buffers=buffers)
        finally:
            _SHARED.reset(tokens[0])
            _STREAMS.reset(tokens[1])
        twin.redraw()
        return twin, along


def _never_changing(simulation: Kernel) -> list[Any]:
    """Return the objects that all copies may share, and the fleet, which copies itself."""
    from_files = simulation.arrivals.order_stream, simulation.arrivals.bundle_stream
    return [
        simulation.traffic,
        simulation.layout,
        simulation.scenario,
        simulation.controllers,
        simulation.world.skus,
        simulation.view.travel.tables,
        *(stream for stream in from_files if stream is not None),
    ]


def _copied(thing: Any, original: Sequence[Any], copied: Sequence[Any]) -> Any:
    """Copy an object; anything in `original` is replaced by its counterpart in `copied`."""
    stream = io.BytesIO()
    arrays: list[pickle.PickleBuffer] = []
    _Referring(stream, original, arrays.append).dump(thing)
    token = _SHARED.set(copied)
    try:
        return pickle.loads(stream.getbuffer(), buffers=map(_copy, arrays))
    finally:
        _SHARED.reset(token)


def _copy(array: pickle.PickleBuffer) -> bytes | bytearray:
    """Copy the contents of an array, which happens only here."""
    content = array.raw()
    return bytes(content) if content.readonly else bytearray(content)


class _Referring(ArrayPickler):
    """Refers to some objects by their number; all objects of their types must be among them."""

    def __init__(
        self,
        stream: io.BytesIO,
        shared: Sequence[Any],
        aside: Callable[[pickle.PickleBuffer], object],
    ) -> None:
        super().__init__(stream, aside)
        self._number = {id(thing): number for number, thing in enumerate(shared)}
        for thing in shared:
            self.dispatch_table[type(thing)] = self._reduced

    def _reduced(self, thing: Any) -> Any:
        number = self._number.get(id(thing))
        return thing.__reduce_ex__(5) if number is None else (_shared, (number,))


class _Redrawing(_Referring):
    """Leaves out random streams, which a copy replaces.

    Substreams of the same branch, such as those of the high periods of orders and of bundles, are
    replaced by substreams of the same branch.
    """

    def __init__(
        self,
        stream: io.BytesIO,
        shared: Sequence[Any],
        aside: Callable[[pickle.PickleBuffer], object],
    ) -> None:
        super().__init__(stream, shared, aside)
        self._streams = 0
        self._branches: dict[tuple[int, ...], int] = {}
        self.dispatch_table[np.random.Generator] = self._another_generator
        self.dispatch_table[Substreams] = self._other_substreams

    def _another_generator(self, _: Any) -> Any:
        self._streams += 1
        return _generator, (self._streams,)

    def _other_substreams(self, replaced: Substreams) -> Any:
        self._streams += 1
        return _substreams, (self._branches.setdefault(replaced.branch, self._streams),)


def _generator(number: int) -> np.random.Generator:
    seed, path = _STREAMS.get()
    return generator(seed, Stream.LOOK_AHEAD, *path, number)


def _substreams(number: int) -> Substreams:
    seed, path = _STREAMS.get()
    return Substreams(seed, Stream.LOOK_AHEAD, (*path, number))


def _shared(number: int) -> Any:
    return _SHARED.get()[number]
