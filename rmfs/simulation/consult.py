"""What TA asks the controllers of the other problems."""

from __future__ import annotations

from time import perf_counter_ns
from typing import TYPE_CHECKING, Any

from rmfs.control.problems import Problem

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from rmfs.control.base import Controller
    from rmfs.control.pps import PodSelection
    from rmfs.control.psa import PodStorageAssignment
    from rmfs.control.repositioning import Move, Repositioning
    from rmfs.simulation.phase import DecisionPhase
    from rmfs.simulation.simulation import Simulation
    from rmfs.world.robots import Robot


class PhaseConsult:
    """Passes TA's questions on to the controllers installed now, and measures them."""

    def __init__(self, phase: DecisionPhase, simulation: Simulation) -> None:
        self._phase = phase
        self._world = simulation.world
        self._panel = simulation.panel

    def serves(self, pod: int, station: int) -> bool:
        """Ask PPS whether there is work for a pod."""
        pps: PodSelection[Any] = self._panel[Problem.PPS]
        return pps.serves(pod, station)

    def pod_for(self, robot: Robot, station: int) -> int:
        """Ask PPS for a pod."""
        pps: PodSelection[Any] = self._panel.consulted(Problem.PPS)
        if self._world.is_pick_station(station):
            target = self._world.pick_stations[station]
            return self._number(Problem.PPS, pps, lambda: pps.pick_pod(robot, target))
        other = self._world.replenishment_station(station)
        # RPS chose the pods of the bundles; which of them comes first is not left to a model
        return self._number(
            Problem.PPS, pps, lambda: pps.replenishment_pod(robot, other), modelled=False
        )

    def next_station(self, robot: Robot, stations: Sequence[int]) -> int:
        """Ask PPS for the next station of a carried pod."""
        pps: PodSelection[Any] = self._panel.consulted(Problem.PPS)
        return self._number(Problem.PPS, pps, lambda: pps.next_station(robot, stations))

    def place_for(self, robot: Robot) -> int:
        """Ask PSA for a place."""
        psa: PodStorageAssignment[Any] = self._panel.consulted(Problem.PSA)
        return self._number(Problem.PSA, psa, lambda: psa.place(robot))

    def move_for(self, robot: Robot) -> Move | None:
        """Ask repositioning for a pod to move, unless it would not answer now."""
        rule: Repositioning[Any] = self._panel.consulted(Problem.REPOSITIONING)
        if not rule.is_ready(robot):
            return None
        start = perf_counter_ns()
        move = rule.move(robot)
        spent_ns = perf_counter_ns() - start
        self._phase.consulted(Problem.REPOSITIONING, rule, spent_ns, move is not None)
        return move

    def _number(
        self,
        problem: Problem,
        controller: Controller[Any],
        question: Callable[[], int],
        modelled: bool = True,
    ) -> int:
        """Ask for a number; -1 is no decision."""
        former, controller.basis = controller.basis, None
        start = perf_counter_ns()
        number = question()
        spent_ns = perf_counter_ns() - start
        self._phase.consulted(problem, controller, spent_ns, number >= 0, modelled)
        controller.basis = former
        return number
