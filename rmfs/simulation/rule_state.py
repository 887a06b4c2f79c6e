"""Saving and restoring a rule's own state, without the state of the warehouse."""

from __future__ import annotations

import io
import pickle
from typing import TYPE_CHECKING, Any, NamedTuple

from rmfs.control.asks import Call
from rmfs.control.base import Parameters
from rmfs.control.trackers import Tracker
from rmfs.control.travel import Travel
from rmfs.control.view import View
from rmfs.simulation.arrays import ArrayPickler
from rmfs.world.news import Follower

if TYPE_CHECKING:
    from rmfs.control.base import Controller

_WORLD = ("rmfs.world.", "rmfs.layout.", "rmfs.scenario.", "rmfs.traffic.", "rmfs.simulation.")
_ATOMS = (Parameters, View, Travel, Tracker, Call)
_KNOWN: dict[type, bool] = {}
"""Whether objects of a type are stored by reference, cached by type."""


class Kept(NamedTuple):
    """A saved state of a controller.

    It includes the objects stored by reference (see `RuleState`) and, of each call to an optimiser,
    the values of `stale` and `done` (see `Call`).
    """

    content: bytes
    shared: list[object]
    counted: list[tuple[Call, int, dict[str, int]]]


class RuleState:
    """Saves and restores the states of controllers.

    Robots, orders, pods and everything else in the world are stored by reference, not copied. So
    are the view, the parameters, and trackers (which change with events, not while a rule decides).
    A call to an optimiser is also stored by reference, but the values of its attributes `stale` and
    `done` are saved.
    """

    def keep(self, controller: Controller[Any], answer: Call | None) -> Kept:
        """Save the state of a controller, and how much of `answer`, if any, it has handled."""
        shared: list[object] = []
        stream = io.BytesIO()
        _Keeper(stream, controller, shared).dump(vars(controller))
        calls = {id(thing): thing for thing in (*shared, answer) if isinstance(thing, Call)}
        counted = [(call, call.stale, dict(call.done)) for call in calls.values()]
        return Kept(stream.getvalue(), shared, counted)

    def restore(self, controller: Controller[Any], kept: Kept) -> None:
        """Restore the saved state of a controller."""
        remembered: dict[str, Any] = _Restorer(io.BytesIO(kept.content), kept.shared).load()
        vars(controller).clear()
        vars(controller).update(remembered)
        for thing in kept.shared:
            if isinstance(thing, Follower):
                thing.begin_anew()
        for call, stale, done in kept.counted:
            call.stale, call.done = stale, dict(done)


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
