"""Trackers: what several controllers count together, kept up to date as things happen."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterator

    from rmfs.control.problems import Trigger
    from rmfs.control.view import View


class Tracker:
    """Counts something over a run; it reads the view and changes nothing.

    A tracker starts from the world as it is when a controller first asks for it, and lives to the
    end of the run, so that a controller installed later finds it up to date.

    Attributes
    ----------
    hears
        Events that are passed to `hear` immediately.
    """

    hears: ClassVar[frozenset[Trigger]] = frozenset()

    def __init__(self, view: View) -> None:
        self.view = view

    def hear(self, trigger: Trigger, subject: Any) -> None:
        """Take note of an event of `hears`; the subject is as described at the trigger."""


T = TypeVar("T", bound=Tracker)


class Trackers:
    """The trackers of a run: one for each kind and settings, made when first asked for."""

    def __init__(self, view: View) -> None:
        self._view = view
        self._made: dict[tuple[type[Tracker], tuple[Hashable, ...]], Tracker] = {}

    def __iter__(self) -> Iterator[Tracker]:
        return iter(self._made.values())

    def get(self, kind: type[T], *settings: Hashable) -> T:
        """Look up, or make, a tracker.

        To be called by controllers and trackers at construction; later it would not be notified of
        events before the next exchange of a controller.

        Parameters
        ----------
        settings
            What is passed to its constructor, after the view.
        """
        key = (kind, settings)
        if key not in self._made:
            self._made[key] = kind(self._view, *settings)
        made = self._made[key]
        assert isinstance(made, kind)
        return made
