"""The controllers of a run: who is installed, who is asked when, and who is told what."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.control.problems import Problem, Trigger
from rmfs.random import Stream, generator

if TYPE_CHECKING:
    from collections.abc import Callable

    from rmfs.control.base import Controller
    from rmfs.control.choices import Choice
    from rmfs.control.lookahead import LookAhead
    from rmfs.control.settings import ControllerSettings
    from rmfs.control.trackers import Tracker
    from rmfs.control.view import View

_ORDER = list(Problem)


class ControllerSet:
    """The controllers installed at present, one per problem.

    Whoever needs a controller looks it up here each time, so that any of them can be exchanged
    while the simulation runs.

    Parameters
    ----------
    settings
        The controllers of the beginning.
    seed
        The run's seed; each controller has a random stream of its own below it.
    lookahead
        For controllers that look ahead.

    Attributes
    ----------
    installed
        Per problem, the controller; the same mapping throughout the run.
    calls
        Per trigger, the problems whose controllers are to be asked after it.
    listeners
        Per trigger, methods that are told of it at once.
    """

    def __init__(
        self, settings: ControllerSettings, view: View, seed: int, lookahead: LookAhead
    ) -> None:
        self._view = view
        self._seed = seed
        self._lookahead = lookahead
        self.installed: dict[Problem, Any] = {}
        self._consulted: dict[Problem, Controller[Any]] = {}
        self._generations = dict.fromkeys(Problem, 0)
        self.calls: list[frozenset[Problem]] = []
        self.listeners: list[list[Callable[[Trigger, Any], None]]] = []
        for problem in Problem:
            self._create(settings.choices[problem])
        self._connect()

    def __getitem__(self, problem: Problem) -> Any:
        """Look up the controller of a problem."""
        return self.installed[problem]

    def consulted(self, problem: Problem) -> Any:
        """Look up who answers TA's questions about a problem: whoever decides it.

        If a dummy is installed, it is the joint controller that takes the dummy's decision; that
        one must then have the methods of the problem's protocol as well.
        """
        return self._consulted[problem]

    def install(self, choice: Choice) -> None:
        """Exchange the controller of a problem."""
        self._create(choice)
        self._connect()

    def put(self, problem: Problem, controller: Controller[Any]) -> None:
        """Let a controller that exists already take over a problem."""
        self.installed[problem] = controller
        self._connect()

    def _create(self, choice: Choice) -> None:
        problem = choice.problem
        number = self._generations[problem]
        self._generations[problem] += 1
        rng = generator(self._seed, Stream.CONTROLLERS, _ORDER.index(problem), number)
        created = choice.controller(choice.parameters, self._view, rng)
        if created.looks_ahead:
            created.lookahead = self._lookahead
        self.installed[problem] = created

    def _connect(self) -> None:
        """Work out who is asked after, and told of, each trigger, and who decides what."""
        self._consulted = dict(self.installed)
        for controller in self.installed.values():
            for problem in controller.decides:
                self._consulted[problem] = controller
        everyone = self.installed.items()
        self.calls = [
            frozenset(p for p, c in everyone if trigger in c.triggers | c.subscriptions)
            for trigger in Trigger
        ]
        told: list[Controller[Any] | Tracker] = [*self._view.trackers, *self.installed.values()]
        self.listeners = [[one.hear for one in told if t in one.hears] for t in Trigger]
