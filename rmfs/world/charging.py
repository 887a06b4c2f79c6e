"""Tasks of going to chargers and swap stations, and the state of these stations."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rmfs.world.stations import Station
from rmfs.world.tasks import Keeps, Serves, Task, VisitTask

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.world.robots import Robot


@dataclass(slots=True, eq=False)
class ChargeTask(VisitTask):
    """The task of going to a charger or swap station, for a robot that carries no pod.

    Attributes
    ----------
    until_share
        Battery level (share of capacity) at which the robot leaves a charger; a robot also leaves
        at the level that counts as full. Swap stations ignore `until_share`.
    """

    kind = "charge"

    until_share: float = 1.0

    def started(self, world: Keeps) -> Task:
        """Register the task with its station and its robot; return the task."""
        return world.start_charge(self)

    def is_possible(self, world: Keeps, serves: Serves) -> bool:
        """Whether the robot carries nothing."""
        return world.robots[self.robot].pod < 0

    def ended(self, world: Keeps) -> None:
        """Remove the task from the tasks of its station."""
        del world.stations[self.station].tasks[self.robot]


class RecoveryStation(Station[ChargeTask]):
    """A charger or swap station; its `tasks` are keyed by robot instead of by pod."""

    def verify(self, robots: Sequence[Robot]) -> None:
        """Check that each task at this station is the current task of its robot.

        Raises
        ------
        AssertionError
            If a task is not the current task of its robot.
        """
        for robot, task in self.tasks.items():
            if (task.robot, task.station, robots[robot].task) != (robot, self.index, task):
                raise AssertionError(f"inconsistent world: tasks of station {self.index}")
