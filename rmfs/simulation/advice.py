"""What the installed rules would decide, for programs that decide outside the simulation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.control.asks import told_by
from rmfs.control.problems import Problem
from rmfs.simulation.consult import PhaseConsult

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rmfs.control.questions import Question
    from rmfs.simulation.controller_set import ControllerSet
    from rmfs.simulation.deciding import Deciding
    from rmfs.world import World
    from rmfs.world.robots import Robot


class Advice:
    """Asks the installed rules what they would decide now; nothing is applied."""

    def __init__(self, world: World, controllers: ControllerSet, deciding: Deciding) -> None:
        self._world, self._controllers = world, controllers
        self._consult = PhaseConsult(world, controllers, deciding)

    def in_turn(self, problem: Problem) -> Iterator[Any]:
        """Return the decisions that a problem's installed rule would make now."""
        rule = self._controllers[problem]
        decisions: Iterable[Any] = (
            rule.decide(self._consult) if problem is Problem.TA else rule.decide()
        )
        return iter(decisions)

    def on(self, question: Question) -> Any:
        """Return the answer that the installed rule would give to a question asked by TA."""
        rule = self._controllers[question.problem]
        robot = self._world.robots[question.robot]
        return told_by(self._answer(rule, robot, question), None)[0]

    def _answer(self, rule: Any, robot: Robot, question: Question) -> Any:
        match question.kind:
            case "pick pod":
                return rule.pick_pod(robot, self._world.pick_stations[question.stations[0]])
            case "replenishment pod":
                station = self._world.stations[question.stations[0]]
                return rule.replenishment_pod(robot, station)
            case "next station":
                return rule.next_station(robot, question.stations)
            case "place":
                return rule.place(robot)
        return rule.move(robot)
