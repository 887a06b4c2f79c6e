"""A rule's own state, kept and restored: what it remembers, not the warehouse it looks at."""

from __future__ import annotations

import io
import pickle
from typing import TYPE_CHECKING, Any

from rmfs.control.base import Parameters
from rmfs.control.trackers import Tracker
from rmfs.control.travel import Travel
from rmfs.control.view import View
from rmfs.simulation.arrays import ArrayPickler

if TYPE_CHECKING:
    from rmfs.control.base import Controller

_WORLD = ("rmfs.world.", "rmfs.layout.", "rmfs.scenario.", "rmfs.traffic.")
_ATOMS = (Parameters, View, Travel, Tracker)
_KNOWN: dict[type, bool] = {}
"""Whether objects of a type are referred to: told once per type, there are hundreds of objects."""


class RuleState:
    """Keeps copies of what controllers remember.

    Robots, orders, pods and all else of the world is referred to, not copied; so are the view, the
    parameters, and trackers, which hear of events and do not change when a rule decides.
    """

    def keep(self, controller: Controller[Any]) -> tuple[bytes, list[object]]:
        """Copy what a controller remembers."""
        shared: list[object] = []
        stream = io.BytesIO()
        _Keeper(stream, controller, shared).dump(vars(controller))
        return stream.getvalue(), shared

    def restore(self, controller: Controller[Any], kept: tuple[bytes, list[object]]) -> None:
        """Let a controller remember what it did when this was kept."""
        content, shared = kept
        remembered: dict[str, Any] = _Restorer(io.BytesIO(content), shared).load()
        vars(controller).clear()
        vars(controller).update(remembered)


class _Keeper(ArrayPickler):
    def __init__(
        self, stream: io.BytesIO, controller: Controller[Any], shared: list[object]
    ) -> None:
        super().__init__(stream)
        self._shared = shared
        self._controller = controller

    def persistent_id(self, thing: object) -> int | None:
        kind = type(thing)
        is_shared = _KNOWN.get(kind)
        if is_shared is None:
            is_shared = issubclass(kind, _ATOMS) or kind.__module__.startswith(_WORLD)
            is_shared = _KNOWN[kind] = is_shared and not issubclass(kind, type)
        if not is_shared and thing is not self._controller:
            return None
        self._shared.append(thing)
        return len(self._shared) - 1


class _Restorer(pickle.Unpickler):
    def __init__(self, stream: io.BytesIO, shared: list[object]) -> None:
        super().__init__(stream)
        self._shared = shared

    def persistent_load(self, number: Any) -> object:
        return self._shared[number]
