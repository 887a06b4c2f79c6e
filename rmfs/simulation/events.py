"""The one way in which a run tells what happens: every callback reaches those that override it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.observer import Observer

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence


class Events(Observer):
    """Passes every callback on to several observers, in their order.

    For each callback that only one observer overrides, its method takes the place of the one here,
    and a callback nobody overrides does nothing: in a run there are tens of thousands of calls.
    """

    def __init__(self) -> None:
        self._observers: list[Observer] = []

    @property
    def observers(self) -> Sequence[Observer]:
        """Who is told, in their order."""
        return tuple(self._observers)

    def tell(self, observers: Sequence[Observer]) -> None:
        """Tell these, and nobody else, from now on."""
        self._observers = list(observers)
        for name in _CALLBACKS:
            listeners = [
                getattr(observer, name)
                for observer in observers
                if getattr(type(observer), name) is not getattr(Observer, name)
            ]
            vars(self).pop(name, None)
            if len(listeners) == 1:
                setattr(self, name, listeners[0])
            elif len(listeners) == 2:
                setattr(self, name, _Both(*listeners))
            elif listeners:
                setattr(self, name, _All(listeners))


class _All:
    """Calls several methods with the same arguments."""

    def __init__(self, listeners: Sequence[Callable[..., None]]) -> None:
        self._listeners = tuple(listeners)

    def __call__(self, *arguments: object) -> None:
        for listener in self._listeners:
            listener(*arguments)


class _Both:
    """Calls two methods with the same arguments: most callbacks have as many."""

    __slots__ = ("_first", "_second")

    def __init__(self, first: Callable[..., None], second: Callable[..., None]) -> None:
        self._first, self._second = first, second

    def __call__(self, *arguments: object) -> None:
        self._first(*arguments)
        self._second(*arguments)


_CALLBACKS = [name for name in vars(Observer) if not name.startswith("_")]
