"""TA random: gives robots random pods with work, and random stations for these pods."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, ClassVar

import numpy as np
import pydantic

from rmfs.control.decisions import Prepare, Reposition, TaskDecision
from rmfs.control.problems import Problem
from rmfs.control.ta.rest import RestRule
from rmfs.control.ta.solo import Solo, SoloParameters
from rmfs.control.ta.stations import bring, keeper_of

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterator

    from rmfs.control.ta import Consult
    from rmfs.control.view import View
    from rmfs.world.robots import Robot
    from rmfs.world.stations import PickStation, ReplenishmentStation

Probability = Annotated[float, pydantic.Field(ge=0, le=1)]


class RandomTasksParameters(SoloParameters):
    """Parameters of TA random."""

    rest: RestRule = "random"
    """Storage location where an idle robot waits: the one nearest to the middle of its tier
    (`middle`), the one nearest to the robot (`nearest`), or one drawn at random (`random`); if
    possible, beneath a stored pod."""
    switch_probability: Probability = 0.1
    """Probability that a robot that needs a task changes between picking and replenishment."""
    keep_pod_probability: Probability = 0.95
    """Probability that a robot looks for more work for the pod it carries before parking it."""
    reposition_probability: Probability = 0.05
    """Probability that a robot without a pod asks repositioning for a pod to move before it looks
    for other work."""
    other_kind: bool = True
    """Whether a robot that finds no work of its own kind (picking or replenishment) may take work
    of the other kind."""
    prefer_same_tier: bool = True
    """Whether a station on the pod's tier is chosen if possible."""


class RandomTasks(Solo[RandomTasksParameters]):
    """Gives each robot a random pod with work, and a random station where the pod has work.

    A robot works either for picking or for replenishment, and changes between them at random.
    Initially, it works for picking with a probability equal to the share of pick stations among all
    stations. The rule chooses pods itself, so PPS must be `dummy`, whose parameters control late
    binding. PSA chooses where pods are parked.
    """

    parameters_model = RandomTasksParameters
    decides: ClassVar[frozenset[Problem]] = frozenset({Problem.PPS})

    def __init__(
        self, parameters: RandomTasksParameters, view: View, rng: np.random.Generator
    ) -> None:
        super().__init__(parameters, view, rng)
        share = len(view.pick_stations) / len(view.stations)
        self._picks: list[bool] = (rng.random(len(view.robots)) < share).tolist()

    def task_for(self, robot: Robot, consult: Consult) -> Iterator[TaskDecision | Prepare]:
        """Draw the robot's next task at random, and yield it."""
        given = self.parameters
        if self._happens(given.switch_probability):
            self._picks[robot.index] = not self._picks[robot.index]
        if robot.pod >= 0:
            station = self._next_station(robot, consult)
            if station >= 0:
                yield bring(self.view, robot, robot.pod, station)
            else:
                yield from self.park(robot, consult)
            return
        if self._happens(given.reposition_probability):
            move = consult.move_for(robot)
            if move is not None:
                yield Reposition(keeper_of(self.view, robot, move.pod), move.pod, move.place)
                return
        yield self.work_for(robot, consult) or self.to_rest(robot)

    def work_for(self, robot: Robot, consult: Consult) -> TaskDecision | None:
        """Draw an available pod with work, then a station where the pod has work.

        The result is the task of bringing the pod to the station. Only work of the robot's present
        kind (picking or replenishment) counts or, if there is none and `other_kind` is true, work
        of the other kind. Without any such work, the result is None.
        """
        for picks in self._kinds(robot):
            stations = [s.index for s in self._stations(picks) if self.view.has_open_work(s.index)]
            useful = np.zeros((len(stations), len(self.view.storage.is_at_hand)), np.bool_)
            for row, station in zip(useful, stations, strict=True):
                row[self.pods_for(robot, station)] = True
            pods = np.flatnonzero(useful.any(axis=0))
            if len(pods):
                pod = int(pods[self.draw(len(pods))])
                rows = useful[:, pod].nonzero()[0].tolist()
                station = self._any_of([stations[row] for row in rows], pod)
                return bring(self.view, keeper_of(self.view, robot, pod), pod, station)
        return None

    def finds_like(self, robot: Robot) -> Hashable:
        """Return the robot's kind of work; None (for all robots) if robots may do both kinds."""
        return None if self.parameters.other_kind else self._picks[robot.index]

    def _next_station(self, robot: Robot, consult: Consult) -> int:
        """Draw a station where the carried pod has work, or -1 if it is to be parked."""
        if not self._happens(self.parameters.keep_pod_probability):
            return -1
        for picks in self._kinds(robot):
            stations = [
                station.index
                for station in self._stations(picks)
                if consult.serves(robot.pod, station.index)
            ]
            if stations:
                return self._any_of(stations, robot.pod)
        return -1

    def _any_of(self, stations: list[int], pod: int) -> int:
        """Draw a station, if possible on the tier of a pod."""
        if self.parameters.prefer_same_tier and self.view.travel.tiers > 1:
            tier = self.view.travel.tier[self.view.pod_waypoint(pod)]
            near = [s for s in stations if self.view.stations[s].tier == tier]
            stations = near or stations
        return stations[self.draw(len(stations))]

    def _kinds(self, robot: Robot) -> tuple[bool, ...]:
        """Whether to look for picks: the robot's own kind, then, if allowed, the other."""
        own = self._picks[robot.index]
        return (own, not own) if self.parameters.other_kind else (own,)

    def _stations(self, picks: bool) -> list[PickStation] | list[ReplenishmentStation]:
        return self.view.pick_stations if picks else self.view.replenishment_stations

    def _happens(self, probability: float) -> bool:
        return float(self.rng.random()) < probability
