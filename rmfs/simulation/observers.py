"""Telling observers: each callback reaches only those that override it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.observer import Observer

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence


class Observers(Observer):
    """Passes every callback on to several observers.

    For each callback that only one observer overrides, its method takes the place of the one here,
    and a callback nobody overrides does nothing: in a run there are tens of thousands of calls.
    """

    def __init__(self, observers: Sequence[Observer]) -> None:
        for name in _callbacks():
            listeners = [
                getattr(observer, name)
                for observer in observers
                if getattr(type(observer), name) is not getattr(Observer, name)
            ]
            if len(listeners) == 1:
                setattr(self, name, listeners[0])
            elif listeners:
                setattr(self, name, _ToAll(listeners))


def _callbacks() -> list[str]:
    return [name for name in vars(Observer) if not name.startswith("_")]


class _ToAll:
    """Calls several listeners; no closure, so that a copy calls the listeners' copies."""

    def __init__(self, listeners: list[Callable[..., None]]) -> None:
        self._listeners = listeners

    def __call__(self, *arguments: object, **named: object) -> None:
        for listener in self._listeners:
            listener(*arguments, **named)
