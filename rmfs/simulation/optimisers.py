"""Passes questions of controllers to optimisers, and answers of optimisers to controllers."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, Protocol

from rmfs.control.asks import Call
from rmfs.digest import digest

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rmfs.control.asks import Ask
    from rmfs.control.base import Controller
    from rmfs.control.problems import Problem
    from rmfs.simulation.agenda import Agenda
    from rmfs.simulation.events import Events
    from rmfs.simulation.pacing import Pacing
    from rmfs.world import World


class Answers(Protocol):
    """Receiver of the answers of optimisers."""

    def tell(self, call: Call) -> None:
        """Immediately pass an answer to the controller that asked."""
        ...

    def came(self, call: Call) -> None:
        """Record an answer; the decision phase of this instant passes it to the controller."""
        ...


class OptimiserGateway:
    """Passes questions to the pacing, and answers to the decision phase when they take effect.

    Parameters
    ----------
    pacing
        Runs the optimisers, and determines when each answer takes effect.
    answers
        Receives the answers as they take effect.
    """

    def __init__(
        self, pacing: Pacing, *, agenda: Agenda, world: World, events: Events, answers: Answers
    ) -> None:
        self._pacing = pacing
        self._agenda, self._world, self._events = agenda, world, events
        self._answers = answers
        self._asked = 0
        self._asking = False

    @property
    def waits(self) -> bool:
        """Whether solvers run beside the simulation, which may then advance only to `limit_us`."""
        return self._pacing.waits

    def begin(self, modules: Iterable[str]) -> None:
        """Prepare the optimisers; called before the measurement of wall time begins.

        Parameters
        ----------
        modules
            Modules with the functions that answer the questions.
        """
        self._pacing.begin(dict.fromkeys(modules), self._give)

    def ask(self, problem: Problem, controller: Controller[Any], ask: Ask[Any]) -> None:
        """Submit a question; if its answer takes no simulated time, apply it before returning."""
        now_us = self._agenda.now_us
        state = digest((now_us, str(problem), _tracks(self._world), ask.question))
        call = Call(self._asked, problem, controller, ask, now_us, state)
        self._asked += 1
        controller.in_flight += 1
        self._events.optimiser_asked(call)
        self._asking = True
        try:
            self._pacing.ask(call)
        finally:
            self._asking = False

    def limit_us(self, now_us: int) -> int:
        """Wait for solvers if needed; return the latest time that may be simulated now, in us."""
        return self._pacing.limit_us(now_us)

    def end(self) -> None:
        """Abandon unanswered questions."""
        self._pacing.end()

    def _give(self, call: Call, at_us: int) -> None:
        """Let an answer take effect at a time, which may be now."""
        if self._asking and at_us <= self._agenda.now_us:
            self._asking = False
            self._answers.tell(call)
        else:
            self._agenda.at(at_us, partial(self._answers.came, call))


def _tracks(world: World) -> tuple[object, ...]:
    """Return what distinguishes states of the world with the same origin."""
    return (
        world.orders_created,
        world.orders_completed,
        world.bundles_created,
        world.bundles_stored,
        world.units_picked,
        world.storage.version,
        tuple((robot.waypoint, robot.pod, robot.station) for robot in world.robots),
    )
