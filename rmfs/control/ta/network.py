"""TA network: gives robots the tasks that a network scores highest."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pydantic

from rmfs.control import errands
from rmfs.control.decisions import MovePod, Store, WorkFor
from rmfs.control.network import Network, Scorer, ScoringParameters, checked, start
from rmfs.control.ta import TaskAllocation
from rmfs.control.ta.rest import RestPlaces, RestRule
from rmfs.control.task_candidates import MOVE, lacks_tasks, tasks

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.control.decisions import TaskDecision
    from rmfs.control.ta import Consult
    from rmfs.control.view import View
    from rmfs.world.robots import Robot


class NetworkParameters(ScoringParameters):
    """Parameters of TA network."""

    network: Network = pydantic.Field(default_factory=lambda: start("ta"))
    """The network that scores pairs of a robot and a task (see the page on learning)."""
    rest: RestRule = "nearest"
    """Storage location to which a robot at rest goes if it must make room: the one nearest to the
    middle of its tier (`middle`), the one nearest to the robot (`nearest`), or one drawn at random
    (`random`); if possible, beneath a stored pod."""

    @pydantic.field_validator("network")
    @classmethod
    def _check(cls, network: Network) -> Network:
        return checked("ta", network)


class NetworkRule(TaskAllocation[NetworkParameters]):
    """Scores pairs of a robot and a task, and assigns the tasks with the highest scores.

    Tasks are assigned one after another: each time, the pair with the highest score is chosen. A
    robot that needs a task may work for a station, store its pod, move an idle pod or rest where it
    is; a robot at rest may work for a station, store its pod or move an idle pod. PPS, PSA and
    repositioning choose pods and storage locations; if they find none, the pair is left out. The
    network also scores declining, that is, assigning no further task. The rule stops when this
    score is higher than those of all pairs.
    """

    parameters_model = NetworkParameters

    def __init__(self, parameters: NetworkParameters, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._scorer = Scorer("ta", parameters.network, parameters.candidates)
        self._rest = RestPlaces(view, parameters.rest, self.draw)

    def decide(self, consult: Consult) -> Iterator[TaskDecision]:
        """Yield tasks until declining has the highest score, or no possible task is left."""
        may_move = consult.may_move()
        refused: list[Any] = []
        while may_move or not lacks_tasks(self.view):
            found = tasks(self.view, refused)
            among = None if may_move else (found.columns["kind"] != MOVE).nonzero()[0]
            row = self._scorer.best_of(found, self.view, among)
            if row < 0:
                return
            chosen = found[row]
            task = self._whole(chosen, consult)
            if task is None:
                refused.append(chosen)
            else:
                yield task

    def rest_place(self, robot: Robot) -> int:
        """Choose the waypoint to which a resting robot moves to make room; -1 if there is none.

        The parameter `rest` determines the choice.
        """
        return self._rest.choose(robot)

    def _whole(self, chosen: Any, consult: Consult) -> TaskDecision | None:
        """Return the complete task; None if no pod, storage location or move is found for it."""
        match chosen:
            case WorkFor():
                return errands.work(chosen, self.view, consult)
            case Store():
                return errands.store(chosen, consult)
            case MovePod():
                return errands.move_pod(chosen, self.view, consult)
        task: TaskDecision = chosen
        return task
