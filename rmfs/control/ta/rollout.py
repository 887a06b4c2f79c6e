"""TA rollout: gives robots the tasks of a base rule, or tasks that did better in trials."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal

import pydantic

from rmfs.control import legality
from rmfs.control.candidates import candidates_for
from rmfs.control.decisions import BringForBundles, BringForPicks, Park
from rmfs.control.features import best_rows, unscaled, weights_of
from rmfs.control.problems import Problem
from rmfs.control.questions import Question
from rmfs.control.rollouts import RolloutParameters, TriesOut, base_rule, question
from rmfs.control.ta import Consult, TaskAllocation
from rmfs.control.ta.stations import bring, keeper_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np

    from rmfs.control.asks import Call
    from rmfs.control.view import View
    from rmfs.world.robots import Robot

Part = Literal["ta", "pps", "psa"]


class TaskRolloutParameters(RolloutParameters):
    """Parameters of TA rollout."""

    over: Annotated[tuple[Part, ...], pydantic.Field(min_length=1)] = ("ta", "pps", "psa")
    """Kinds of alternatives that are tried: other stations (`ta`), other pods (`pps`) and other
    storage locations (`psa`)."""


class Rollout(TriesOut, TaskAllocation[TaskRolloutParameters]):
    """Simulates alternatives to the base rule's task: other stations, pods or storage locations.

    The TA rule `base`, with PPS and PSA, makes a default decision, which is compared with
    alternatives in simulated trials. If a pod is to be fetched for a station, the alternatives are
    work for other stations and, for a pick station, other pods; if a pod is to be stored, they are
    other storage locations. The parameter `over` selects which kinds of alternatives are
    considered. The best alternative replaces the default decision only if its advantage is certain
    enough (`certainty`). The pacing determines how much simulated time the computation takes;
    meanwhile, no robot gets a task.
    """

    parameters_model = TaskRolloutParameters

    def __init__(
        self, parameters: TaskRolloutParameters, view: View, rng: np.random.Generator
    ) -> None:
        super().__init__(parameters, view, rng)
        self.base = base_rule(Problem.TA, parameters, view, rng)
        self.subscriptions = self.base.subscriptions  # type: ignore[misc]
        self.hears = self.base.hears  # type: ignore[misc]
        self._consult: Consult

    def rest_place(self, robot: Robot) -> int:
        """Return the waypoint where the base rule lets a robot rest; -1 if it should stay."""
        return int(self.base.rest_place(robot))

    def decide(self, consult: Consult) -> Iterator[Any]:
        """Yield the decisions of the base rule, or a question if a decision has alternatives.

        The question asks which of the alternatives is best.
        """
        self._consult = consult
        while not self.in_flight:
            for first in self.base.decide(consult):
                others = self._others(first, consult)
                if others:
                    yield question(self, self.base, [first, *others], self.parameters)
                    break  # the world may have become another one
                yield first
            else:
                return

    def answered(self, call: Call) -> Iterator[Any]:
        """Yield the best decision if it is still possible.

        If the answer took simulated time, further decisions follow, as in `decide`.
        """
        yield from self.best(call)
        if call.completed_us > call.requested_us:
            yield from self.decide(self._consult)

    def _others(self, first: Any, consult: Consult) -> list[Any]:
        given, robot = self.parameters, getattr(first, "robot", None)
        found: list[Any] = []
        if isinstance(first, Park) and "psa" in given.over:
            question = Question(Problem.PSA, "place", first.robot.index)
            found = [Park(first.robot, place) for place in self._best(question, "place")]
        elif isinstance(first, BringForPicks | BringForBundles) and first.robot.pod < 0:
            assert robot is not None
            if "ta" in given.over:
                found += self._at_other_stations(robot, first.station, consult)
            if "pps" in given.over and isinstance(first, BringForPicks):
                question = Question(Problem.PPS, "pick pod", robot.index, (first.station,))
                found += [
                    BringForPicks(keeper_of(self.view, robot, pod), pod, first.station)
                    for pod in self._best(question, "pick pod")
                ]
        possible = [one for one in found if one != first and not legality.reason(one, self.view)]
        return possible[: given.candidates - 1]

    def _at_other_stations(self, robot: Robot, station: int, consult: Consult) -> list[Any]:
        tasks = []
        for other in self.view.stations:
            if other.index != station and self.view.has_open_work(other.index):
                pod = consult.pod_for(robot, other.index)
                if pod >= 0:
                    chosen = keeper_of(self.view, robot, pod)
                    tasks.append(bring(self.view, chosen, pod, other.index))
        return tasks

    def _best(self, asked: Question, kind: str) -> list[int]:
        found = candidates_for(self.view, asked)
        if not len(found):
            return []
        values = unscaled(found, kind, self.view)
        rows = best_rows(values, weights_of(kind), self.parameters.candidates)
        return [int(found[int(row)]) for row in rows]
