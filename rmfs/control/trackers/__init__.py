"""Trackers: statistics shared by several controllers, updated as events happen."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterator

    from rmfs.control.problems import Trigger
    from rmfs.control.view import View


class Tracker:
    """Base class of trackers, which keep statistics for several controllers.

    A tracker reads the view, but changes nothing in it. It is created when a controller first
    requests it, and starts from the state of the world at that time. It exists until the end of the
    run, so it is also up to date for controllers that are installed later.

    Attributes
    ----------
    hears
        Events that are passed to `hear` as soon as they happen.
    """

    hears: ClassVar[frozenset[Trigger]] = frozenset()

    def __init__(self, view: View) -> None:
        self.view = view

    def hear(self, trigger: Trigger, subject: Any) -> None:
        """Process an event listed in `hears`; `Trigger` describes the subjects of events."""


T = TypeVar("T", bound=Tracker)


class Trackers:
    """The trackers of a run, created on request: one per combination of class and settings."""

    def __init__(self, view: View) -> None:
        self._view = view
        self._made: dict[tuple[type[Tracker], tuple[Hashable, ...]], Tracker] = {}

    def __iter__(self) -> Iterator[Tracker]:
        return iter(self._made.values())

    def get(self, kind: type[T], *settings: Hashable) -> T:
        """Return a tracker, creating it if necessary.

        A controller that uses trackers, or a tracker that uses others, must request them in its
        constructor. A tracker that is created later is not notified of events until a controller is
        exchanged.

        Parameters
        ----------
        kind
            Class of the tracker.
        settings
            Further arguments of the constructor, after the view.
        """
        key = (kind, settings)
        if key not in self._made:
            self._made[key] = kind(self._view, *settings)
        made = self._made[key]
        assert isinstance(made, kind)
        return made
