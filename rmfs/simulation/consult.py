"""Questions of TA to the controllers of the other problems."""

from __future__ import annotations

from time import perf_counter_ns
from typing import TYPE_CHECKING, Any

from rmfs.control.asks import By, told_by
from rmfs.control.problems import Problem
from rmfs.control.questions import Question
from rmfs.simulation.deciding import is_foreign
from rmfs.world.stations import PickStation

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from rmfs.control.base import Controller
    from rmfs.control.pps import PodSelection
    from rmfs.control.psa import PodStorageAssignment
    from rmfs.control.repositioning import Move, Repositioning
    from rmfs.simulation.controller_set import ControllerSet
    from rmfs.simulation.deciding import Deciding
    from rmfs.simulation.outside import Outside
    from rmfs.world import World
    from rmfs.world.robots import Robot


class PhaseConsult:
    """Passes TA's questions to the installed controllers, and records their decisions."""

    def __init__(self, world: World, controllers: ControllerSet, deciding: Deciding) -> None:
        self._world = world
        self._controllers = controllers
        self._deciding = deciding

    def serves(self, pod: int, station: int) -> bool:
        """Return whether a pod has work at a station, according to the PPS controller."""
        pps: PodSelection[Any] = self._controllers[Problem.PPS]
        return pps.serves(pod, station)

    def pod_for(self, robot: Robot, station: int) -> int:
        """Return the pod that a robot should bring to a station, as chosen by PPS; -1 for none."""
        pps: PodSelection[Any] = self._controllers.consulted(Problem.PPS)
        target = self._world.work_stations[station]
        if isinstance(target, PickStation):
            asked = (Problem.PPS, "pick pod", robot.index, (station,))
            return self._number(asked, pps, lambda: pps.pick_pod(robot, target))
        # RPS chose the pods of the bundles; which of them comes first is not left to a model
        asked = (Problem.PPS, "replenishment pod", robot.index, (station,))
        return self._number(
            asked, pps, lambda: pps.replenishment_pod(robot, target), modelled=False
        )

    def next_station(self, robot: Robot, stations: Sequence[int]) -> int:
        """Return the next station of a robot's pod, as chosen by PPS from `stations`."""
        pps: PodSelection[Any] = self._controllers.consulted(Problem.PPS)
        asked = (Problem.PPS, "next station", robot.index, tuple(stations))
        return self._number(asked, pps, lambda: pps.next_station(robot, stations))

    def place_for(self, robot: Robot) -> int:
        """Return a storage location (waypoint) for a robot's pod, chosen by PSA; -1 for none."""
        psa: PodStorageAssignment[Any] = self._controllers.consulted(Problem.PSA)
        asked = (Problem.PSA, "place", robot.index, ())
        return self._number(asked, psa, lambda: psa.place(robot))

    def may_move(self) -> bool:
        """Return whether the repositioning rule ever moves pods."""
        rule: Repositioning[Any] = self._controllers.consulted(Problem.REPOSITIONING)
        return not rule.never

    def move_for(self, robot: Robot) -> Move | None:
        """Return a repositioning move for a robot; None if the rule has none or is not ready."""
        rule: Repositioning[Any] = self._controllers.consulted(Problem.REPOSITIONING)
        if not rule.is_ready(robot):
            return None
        start = perf_counter_ns()
        move = rule.move(robot)
        spent_ns = perf_counter_ns() - start
        if move is not None and is_foreign(rule):
            question = Question(Problem.REPOSITIONING, "move", robot.index)
            self._deciding.require_possible(rule, move, question)
        self._deciding.consulted(Problem.REPOSITIONING, rule, spent_ns, move is not None)
        return move

    def _number(
        self,
        asked: tuple[Problem, str, int, tuple[int, ...]],
        controller: Controller[Any],
        ask: Callable[[], int | By[int]],
        modelled: bool = True,
    ) -> int:
        """Return the result of `ask`, -1 for no decision; `asked`: arguments of `Question`."""
        start = perf_counter_ns()
        number, call = told_by(ask(), None)
        spent_ns = perf_counter_ns() - start
        if number != -1 and is_foreign(controller):
            self._deciding.require_possible(controller, number, Question(*asked))
        self._deciding.consulted(asked[0], controller, spent_ns, number >= 0, call, modelled)
        return int(number)


class OutsideConsult(PhaseConsult):
    """Answers TA's questions in a run in which some problems are decided outside the simulation.

    Questions about all other problems are answered as by `PhaseConsult`. The methods that return a
    pod, station, storage location or move raise `Awaits` if the question must first be answered
    outside the simulation.
    """

    def __init__(
        self, world: World, controllers: ControllerSet, deciding: Deciding, outside: Outside
    ) -> None:
        super().__init__(world, controllers, deciding)
        self._outside = outside

    def pod_for(self, robot: Robot, station: int) -> int:
        """Return the pod that a robot should bring to a station; -1 for none."""
        picks = isinstance(self._world.stations[station], PickStation)
        kind = "pick pod" if picks else "replenishment pod"
        question = Question(Problem.PPS, kind, robot.index, (station,))
        return self._asked(question, lambda: super(OutsideConsult, self).pod_for(robot, station))

    def next_station(self, robot: Robot, stations: Sequence[int]) -> int:
        """Return the next station of a robot's pod, one of `stations`."""
        question = Question(Problem.PPS, "next station", robot.index, tuple(stations))
        return self._asked(
            question, lambda: super(OutsideConsult, self).next_station(robot, stations)
        )

    def place_for(self, robot: Robot) -> int:
        """Return a storage location (waypoint) for a robot's pod; -1 for none."""
        question = Question(Problem.PSA, "place", robot.index)
        return self._asked(question, lambda: super(OutsideConsult, self).place_for(robot))

    def may_move(self) -> bool:
        """Return whether repositioning ever moves pods; true if it is decided outside."""
        return Problem.REPOSITIONING in self._outside.problems or super().may_move()

    def move_for(self, robot: Robot) -> Move | None:
        """Return a repositioning move for a robot; None if the rule has none or is not ready."""
        rule: Repositioning[Any] = self._controllers.consulted(Problem.REPOSITIONING)
        question = Question(Problem.REPOSITIONING, "move", robot.index)
        if not self._outside.knows(question) and not rule.is_ready(robot):
            return None
        move: Move | None = self._outside.answer_to(
            question, lambda: super(OutsideConsult, self).move_for(robot)
        )
        return move

    def _asked(self, question: Question, otherwise: Callable[[], int]) -> int:
        number: int = self._outside.answer_to(question, otherwise)
        return number
