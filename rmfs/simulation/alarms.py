"""Calls of controllers at the times that they request by `next_event_s`."""

from __future__ import annotations

from functools import partial
from math import inf
from typing import TYPE_CHECKING

from rmfs.control.base import Controller
from rmfs.simulation.agenda import us_at

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from rmfs.control.problems import Problem
    from rmfs.simulation.agenda import Agenda
    from rmfs.simulation.controller_set import ControllerSet


class Alarms:
    """Agenda entries for the times at which controllers request to be called.

    Each controller has at most one entry.

    Parameters
    ----------
    due
        Function that is called at each such time, with the decision problem of the controller.
    outside
        Decision problems that are decided outside the simulation. Their installed rules still
        determine the times at which decisions are requested.

    Attributes
    ----------
    punctual
        Problems whose controllers request to be called at certain times.
    overdue
        Problems whose controllers are due but have not been called yet.
    """

    def __init__(
        self,
        agenda: Agenda,
        controllers: ControllerSet,
        due: Callable[[Problem], None],
        outside: frozenset[Problem] = frozenset(),
    ) -> None:
        self._outside = outside
        self._agenda = agenda
        self._controllers = controllers
        self._due = due
        self._set: dict[Problem, tuple[float, int]] = {}
        self.punctual: frozenset[Problem] = frozenset()
        self.overdue: set[Problem] = set()

    def connect(self, problems: Iterable[Problem]) -> None:
        """Determine which installed controllers request to be called at certain times."""
        self.punctual = frozenset(
            problem
            for problem in problems
            if type(self._controllers[problem]).next_event_s is not Controller.next_event_s
        )

    def asked(self, problem: Problem) -> None:
        """Update the entry of a problem's controller after a call of the controller.

        After the call, the controller may request another time than before.
        """
        if self.overdue:
            self.overdue.discard(problem)
        if problem in self.punctual:
            self._enter(problem)

    def cancel(self, problem: Problem) -> None:
        """Cancel the entry of a problem's controller, if there is one."""
        if problem in self._set:
            self._agenda.cancel(self._set.pop(problem)[1])

    def _enter(self, problem: Problem) -> None:
        time_s = self._controllers[problem].next_event_s()
        if problem in self._set and self._set[problem][0] == time_s:
            return
        self.cancel(problem)
        if problem in self._outside and time_s <= self._agenda.now_us / 1e6:
            return  # the outside has just been asked, and decided otherwise than the rule
        if time_s < inf:
            # never at the current instant, or a controller could prevent it from ending
            time_us = max(us_at(time_s), self._agenda.now_us + 1)
            entry = self._agenda.at(time_us, partial(self._ring, problem))
            self._set[problem] = (time_s, entry)

    def _ring(self, problem: Problem) -> None:
        del self._set[problem]
        self.overdue.add(problem)
        self._due(problem)
