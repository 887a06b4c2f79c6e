"""Copies of a running simulation, in memory and in files.

A simulation is data: agenda entries are bound methods, no frame of a controller is alive between
two steps. A copy is what the pickle of it gives back; what never changes is referred to.
"""

from __future__ import annotations

import io
import pickle
from typing import TYPE_CHECKING, Any

from rmfs.simulation.arrays import ArrayPickler
from rmfs.traffic import Traffic

if TYPE_CHECKING:
    from rmfs.simulation.simulation import Simulation

_FLEET = "fleet"


def fork(simulation: Simulation) -> Simulation:
    """Copy a simulation; see `Simulation.fork`."""
    shared = {id(thing): thing for thing in _never_changing(simulation)}
    stream = io.BytesIO()
    _Forker(stream, simulation.traffic, shared).dump(simulation)
    copied: Simulation = _Copier(stream, shared, simulation.traffic.fork()).load()
    return copied


def _never_changing(simulation: Simulation) -> list[Any]:
    """What all copies of a simulation may share."""
    view = simulation.view
    return [
        simulation.layout,
        simulation.scenario,
        simulation.controllers,
        simulation.world.skus,
        *view.travel.tables(),
    ]


class _Forker(ArrayPickler):
    def __init__(self, stream: io.BytesIO, fleet: Traffic, shared: dict[int, Any]) -> None:
        super().__init__(stream)
        self._fleet = fleet
        self._shared = shared

    def persistent_id(self, thing: object) -> object:
        number = id(thing)
        if number in self._shared:
            return number
        return _FLEET if thing is self._fleet else None


class _Copier(pickle.Unpickler):
    def __init__(self, stream: io.BytesIO, shared: dict[int, Any], fleet: Traffic) -> None:
        stream.seek(0)
        super().__init__(stream)
        self._shared = shared
        self._fleet = fleet

    def persistent_load(self, number: Any) -> object:
        return self._fleet if number == _FLEET else self._shared[number]
