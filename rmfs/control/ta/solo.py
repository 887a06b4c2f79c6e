"""Base class of TA rules that look for work for each robot separately.

The rules are `random`, `brute-force`, `swarm` and `linear`.
"""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, TypeVar

from rmfs.control.base import Parameters
from rmfs.control.decisions import Park, Prepare, Rest, TaskDecision
from rmfs.control.pps.candidates import pick_candidates, replenishment_candidates
from rmfs.control.ta import Consult, TaskAllocation
from rmfs.control.ta.rest import RestPlaces, RestRule
from rmfs.world.stations import PickStation

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterator

    import numpy as np
    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.world.robots import Robot


class SoloParameters(Parameters):
    """Parameters of rules that look for work for each robot separately."""

    rest: RestRule = "nearest"
    """Storage location where an idle robot waits: the one nearest to the middle of its tier
    (`middle`), the one nearest to the robot (`nearest`), or one drawn at random (`random`); if
    possible, beneath a stored pod."""


P = TypeVar("P", bound=SoloParameters)


class Solo(TaskAllocation[P]):
    """Finds tasks for one robot after another.

    If no work is found for a robot at rest, the search is repeated only after work has been added
    or a pod has become available. This also holds for the other robots of its group (`finds_like`).
    """

    def __init__(self, parameters: P, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._rest = RestPlaces(view, parameters.rest, self.draw)
        self._nothing_at: dict[Hashable, tuple[tuple[int, ...], ...]] = {}

    @abstractmethod
    def task_for(self, robot: Robot, consult: Consult) -> Iterator[TaskDecision | Prepare]:
        """Yield a task for a robot that needs one; a `Prepare` with later tasks may follow."""

    @abstractmethod
    def work_for(self, robot: Robot, consult: Consult) -> TaskDecision | None:
        """Return a task for a robot at rest; None if there is no work for it."""

    def finds_like(self, robot: Robot) -> Hashable:
        """Return the key of the robot's group.

        If `work_for` finds no work for a robot, it finds none for the others of its group either.

        By default, the key is the same for all robots.
        """
        return None

    def decide(self, consult: Consult) -> Iterator[TaskDecision | Prepare]:
        """Yield a task for every robot that needs one, and work for robots at rest."""
        for robot in list(self.view.asking.values()):
            while robot.task is None:
                given = 0
                for task in self.task_for(robot, consult):
                    given += 1
                    yield task
                if not given:
                    break
        now = self._work_versions()
        for robot in list(self.view.resting.values()):
            alike = self.finds_like(robot)
            if robot.index in self.view.resting and self._nothing_at.get(alike) != now:
                found = self.work_for(robot, consult)
                if found is None:
                    self._nothing_at[alike] = now
                else:
                    yield found
                    now = self._work_versions()

    def rest_place(self, robot: Robot) -> int:
        """Choose the waypoint where a robot rests, by the parameter `rest`; -1 if there is none."""
        return self._rest.choose(robot)

    def to_rest(self, robot: Robot) -> Rest:
        """Return the task of resting, at `rest_place` or, if that is -1, where the robot stands."""
        place = self.rest_place(robot)
        return Rest(robot, place if place >= 0 else robot.waypoint)

    def park(self, robot: Robot, consult: Consult) -> Iterator[Park]:
        """Yield the task of storing a robot's pod where PSA chooses; none if PSA finds no place."""
        place = consult.place_for(robot)
        if place >= 0:
            yield Park(robot, place)

    def pods_for(self, robot: Robot, station: int) -> NDArray[np.intp]:
        """Return the numbers of the C available pods with work at a station, ascending, shape (C,).

        For pick stations, only the orders assigned to the station count, not those in its pool.
        """
        target = self.view.stations[station]
        if isinstance(target, PickStation):
            return pick_candidates(self.view, robot, target).pods
        return replenishment_candidates(self.view, robot, target).pods

    def _work_versions(self) -> tuple[tuple[int, ...], ...]:
        return tuple(self.view.work_version(station.index) for station in self.view.stations)
