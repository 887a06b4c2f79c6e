"""Passes each event of a run to all observers that override its callback."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.observer import Observer

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence


class Events(Observer):
    """Passes every event to several observers, in order.

    If only one observer overrides a callback, this object's method of that name is replaced by the
    observer's method. This is for speed, as events are frequent. A callback that no observer
    overrides does nothing.
    """

    def __init__(self) -> None:
        self._observers: list[Observer] = []

    @property
    def observers(self) -> Sequence[Observer]:
        """The observers, in order of notification."""
        return tuple(self._observers)

    def tell(self, observers: Sequence[Observer]) -> None:
        """Notify only these observers from now on."""
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
                setattr(self, name, (_BothOfOne if _arguments(name) == 1 else _Both)(*listeners))
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
    """Calls two methods with the same arguments; most callbacks have two listeners."""

    __slots__ = ("_first", "_second")

    def __init__(self, first: Callable[..., None], second: Callable[..., None]) -> None:
        self._first, self._second = first, second

    def __call__(self, *arguments: object) -> None:
        self._first(*arguments)
        self._second(*arguments)


class _BothOfOne:
    """Does the same as `_Both` for callbacks with one argument, but faster."""

    __slots__ = ("_first", "_second")

    def __init__(self, first: Callable[[Any], None], second: Callable[[Any], None]) -> None:
        self._first, self._second = first, second

    def __call__(self, what: Any) -> None:
        self._first(what)
        self._second(what)


def _arguments(name: str) -> int:
    """Return how many arguments a callback has."""
    return int(getattr(Observer, name).__code__.co_argcount) - 1


_CALLBACKS = [name for name in vars(Observer) if not name.startswith("_")]
