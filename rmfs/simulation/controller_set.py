"""The controllers of a run: when they are called, and which events they are notified of."""

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
    """The currently installed controllers, one per problem.

    Controllers are always looked up here, so that they can be exchanged during the simulation.

    Parameters
    ----------
    settings
        The initial controllers.
    seed
        The run's seed; each controller has its own random stream.
    lookahead
        Function that prepares trials of decisions, for controllers that look ahead.

    Attributes
    ----------
    installed
        The controller of each problem; the mapping is updated when a controller is exchanged.
    calls
        For each `Trigger`, the problems whose controllers are called after it.
    listeners
        For each `Trigger`, the methods `hear` of the controllers and trackers that are immediately
        notified of the event.
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
        """Return the installed controller of a problem."""
        return self.installed[problem]

    def consulted(self, problem: Problem) -> Any:
        """Return the controller that answers TA's questions about a problem.

        This is the installed controller or, if that is a placeholder (dummy), the joint controller
        that decides in its place. The joint controller must therefore also have the methods by
        which TA asks about the problem.
        """
        return self._consulted[problem]

    def install(self, choice: Choice) -> None:
        """Create a controller and install it in place of the present controller of its problem.

        Raises
        ------
        InputError
            If the new controller is incompatible with the layout or the scenario; the present
            controller then remains installed.
        """
        self._create(choice)
        self._connect()

    def put(self, problem: Problem, controller: Controller[Any]) -> None:
        """Install an existing controller for a problem."""
        self.installed[problem] = controller
        self._connect()

    def made(self, choice: Choice) -> Controller[Any]:
        """Create a controller for a problem without installing it.

        Raises
        ------
        InputError
            If the controller is incompatible with the layout or the scenario.
        """
        problem = choice.problem
        number = self._generations[problem]
        rng = generator(self._seed, Stream.CONTROLLERS, _ORDER.index(problem), number)
        return choice.controller(choice.parameters, self._view, rng)

    def _create(self, choice: Choice) -> None:
        created = self.made(choice)
        self._generations[choice.problem] += 1
        if created.looks_ahead:
            created.lookahead = self._lookahead
        self.installed[choice.problem] = created

    def _connect(self) -> None:
        """Update which controllers are called or notified after each trigger, or asked by TA."""
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
