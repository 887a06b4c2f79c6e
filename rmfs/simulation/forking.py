"""Copies of a running simulation, in memory and in files.

A simulation is data: agenda entries are bound methods, no frame of a controller is alive between
two steps. A copy is what the pickle of it gives back; what never changes is referred to.
"""

from __future__ import annotations

import io
import pickle
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any, TypeVar

from rmfs.simulation.arrays import ArrayPickler

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from rmfs.simulation.kernel import Kernel

K = TypeVar("K", bound="Kernel")

_SHARED: ContextVar[Sequence[Any]] = ContextVar("_SHARED")
"""What the copy that is being made refers to instead of having it."""


def fork(simulation: K) -> K:
    """Copy a simulation; see `Kernel.fork`."""
    original, copied = _never_changing(simulation), _never_changing(simulation)
    fleet = original.index(simulation.traffic)
    copied[fleet] = simulation.traffic.fork()
    twin: K = _copied(simulation, original, copied)
    return twin


def _never_changing(simulation: Kernel) -> list[Any]:
    """What all copies of a simulation may share, and the fleet, which copies itself."""
    return [
        simulation.traffic,
        simulation.layout,
        simulation.scenario,
        simulation.controllers,
        simulation.world.skus,
        simulation.view.travel.tables,
    ]


def _copied(thing: Any, original: Sequence[Any], copied: Sequence[Any]) -> Any:
    """Copy something; what is in `original` becomes what is at the same place in `copied`."""
    stream = io.BytesIO()
    arrays: list[pickle.PickleBuffer] = []
    _Referring(stream, original, arrays.append).dump(thing)
    token = _SHARED.set(copied)
    try:
        return pickle.loads(stream.getbuffer(), buffers=map(_copy, arrays))
    finally:
        _SHARED.reset(token)


def _copy(array: pickle.PickleBuffer) -> bytes | bytearray:
    """Copy the content of an array, the only time that this is done."""
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


def _shared(number: int) -> Any:
    return _SHARED.get()[number]
