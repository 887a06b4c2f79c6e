"""TA linear: gives each robot the task with the greatest weighted sum of features."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING

import numpy as np
import pydantic

from rmfs.control.decisions import Prepare, Reposition, TaskDecision
from rmfs.control.linear import Weights, checked, default_weights, scores
from rmfs.control.ta.solo import Solo, SoloParameters
from rmfs.control.ta.stations import bring, keeper_of
from rmfs.control.task_candidates import MOVE, STORE, WORK, tasks

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterator

    from rmfs.control.ta import Consult
    from rmfs.world.robots import Robot


class LinearParameters(SoloParameters):
    """Parameters of TA linear."""

    weights: Weights = pydantic.Field(default_factory=lambda: default_weights("ta"))
    """Weights of the scaled features of a robot's possible tasks (see the page on learning), by
    name; features that are not named have the weight 0."""

    @pydantic.field_validator("weights")
    @classmethod
    def _check(cls, weights: Weights) -> Weights:
        return checked("ta", weights)


class Linear(Solo[LinearParameters]):
    """Lets each robot work for a station, store its pod, move an idle pod or rest.

    The task with the greatest weighted sum of features is chosen. PPS, PSA and repositioning choose
    pods and storage locations; if they find none, the next best task is chosen. If another robot
    without work stands beneath the pod to be fetched, that robot gets the task. A robot at rest
    gets work for a station only if the sum for this work is at least the weight of `rest`. In a
    tie, work for a station comes first (the station with the lowest number before others), then
    storing, then moving, then resting.
    """

    parameters_model = LinearParameters

    def task_for(self, robot: Robot, consult: Consult) -> Iterator[TaskDecision | Prepare]:
        """Yield the possible task with the greatest weighted sum of features."""
        for kind, station in self._best_first(robot):
            if kind == WORK:
                task = self._work(robot, station, consult)
            elif kind == STORE:
                task = next(self.park(robot, consult), None)
            elif kind == MOVE:
                task = self._move(robot, consult)
            else:
                task = self.to_rest(robot)
            if task is not None:
                yield task
                return

    def work_for(self, robot: Robot, consult: Consult) -> TaskDecision | None:
        """Find the best possible work for a robot at rest; None if there is none.

        The sum for this work must be at least the weight of `rest`.
        """
        for kind, station in self._best_first(robot, self.parameters.weights["rest"]):
            task = self._work(robot, station, consult) if kind == WORK else None
            if task is not None:
                return task
        return None

    def finds_like(self, robot: Robot) -> Hashable:
        """Return the robot's number as the key of its group: each robot is a group of its own.

        The weighted sums depend on the robot's position.
        """
        return robot.index

    def _best_first(self, robot: Robot, least: float = -inf) -> list[tuple[int, int]]:
        """List a robot's possible tasks, as kind and station (or -1), the greatest sum first.

        Tasks whose sum is below `least` are left out.
        """
        found = tasks(self.view, robots=[robot])
        worth = scores(found, "ta", self.view, self.parameters.weights)
        order = np.argsort(-worth, kind="stable")[: np.count_nonzero(worth >= least)]
        kinds, stations = found.columns["kind"][order], found.columns["station"][order]
        return list(zip(kinds.tolist(), stations.tolist(), strict=True))

    def _work(self, robot: Robot, station: int, consult: Consult) -> TaskDecision | None:
        if robot.pod >= 0:
            serves = consult.serves(robot.pod, station)
            return bring(self.view, robot, robot.pod, station) if serves else None
        if not self.view.has_open_work(station):
            return None
        pod = consult.pod_for(robot, station)
        if pod < 0:
            return None
        return bring(self.view, keeper_of(self.view, robot, pod), pod, station)

    def _move(self, robot: Robot, consult: Consult) -> TaskDecision | None:
        move = consult.move_for(robot) if consult.may_move() else None
        if move is None:
            return None
        return Reposition(keeper_of(self.view, robot, move.pod), move.pod, move.place)
