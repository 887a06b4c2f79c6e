"""Questions on their way to optimisers, and answers on their way back."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from rmfs.control.asks import Call
from rmfs.digest import digest

if TYPE_CHECKING:
    from rmfs.control.asks import Ask
    from rmfs.control.base import Controller
    from rmfs.control.problems import Problem
    from rmfs.simulation.pacing import Pacing
    from rmfs.simulation.simulation import Simulation
    from rmfs.world import World


class Thinking:
    """Passes questions to the pacing, and answers to the decision phase when they take effect.

    Parameters
    ----------
    pacing
        What thinking costs.
    """

    def __init__(self, simulation: Simulation, pacing: Pacing) -> None:
        self._simulation = simulation
        self._pacing = pacing
        self._asked = 0
        self._asking = False

    def begin(self) -> None:
        """Get ready, before the clock counts."""
        controllers = [
            choice.controller for choice in self._simulation.controllers.choices.values()
        ]
        modules = [module for controller in controllers for module in controller.optimisers]
        self._pacing.begin(dict.fromkeys(modules), self._give)

    def ask(self, problem: Problem, controller: Controller[Any], ask: Ask[Any]) -> None:
        """Hand a question over; if the answer takes no time, it is applied before this returns."""
        simulation = self._simulation
        state = digest((simulation.now_us, str(problem), _tracks(simulation.world), ask.question))
        call = Call(self._asked, problem, controller, ask, simulation.now_us, state)
        self._asked += 1
        controller.in_flight += 1
        simulation.observers.optimiser_asked(call)
        self._asking = True
        try:
            self._pacing.ask(call)
        finally:
            self._asking = False

    def limit_us(self, now_us: int) -> int:
        """Latest time that may be simulated now."""
        return self._pacing.limit_us(now_us)

    def end(self) -> None:
        """Give up what has no answer yet."""
        self._pacing.end()

    def _give(self, call: Call, at_us: int) -> None:
        """Let an answer take effect at a time; one that comes at once, at once."""
        simulation = self._simulation
        if self._asking and at_us <= simulation.now_us:
            self._asking = False
            simulation.phase.tell(call)
        else:
            simulation.agenda.at(at_us, partial(simulation.phase.answer_came, call))


def _tracks(world: World) -> tuple[object, ...]:
    """What tells one state of the world from another, if they come from the same beginning."""
    return (
        world.orders_created,
        world.orders_completed,
        world.bundles_created,
        world.bundles_stored,
        world.units_picked,
        world.storage.version,
        tuple((robot.waypoint, robot.pod, robot.station) for robot in world.robots),
    )
