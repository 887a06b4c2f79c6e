"""Base of TA controllers that ask an optimiser, with a rule for robots without an answer."""

from __future__ import annotations

from abc import abstractmethod
from math import nan
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import pydantic

from rmfs.control.asks import own
from rmfs.control.decisions import Park, Rest, TaskDecision
from rmfs.control.ta import TaskAllocation
from rmfs.control.ta.rest import RestPlaces, RestRule
from rmfs.control.ta.stations import bring, keeper_of
from rmfs.solvers.control.buffer import Buffer
from rmfs.solvers.control.parameters import BufferParameters

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import numpy as np

    from rmfs.control.asks import Ask, By, Call
    from rmfs.control.decisions import Prepare
    from rmfs.control.ta import Consult
    from rmfs.control.view import View
    from rmfs.world.robots import Robot

    Told = TaskDecision | Prepare | Ask[Any] | By[Any]

NotNegative = Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)]


class TaskParameters(BufferParameters):
    """Parameters shared by TA controllers that ask an optimiser."""

    robots_per_station: Annotated[int, pydantic.Field(ge=1)] = 9
    """Maximum number of robots at one station or on their way there."""
    rule_meanwhile: bool = True
    """Whether a rule decides for robots with a pod while an answer is pending, since such robots
    may block others. Robots without a pod wait for the answer."""
    rest: RestRule = "nearest"
    """Storage location where an idle robot waits: the one nearest to the middle of its tier
    (`middle`), the one nearest to the robot (`nearest`), or one drawn at random (`random`); if
    possible, beneath a stored pod."""


P = TypeVar("P", bound=TaskParameters)


class Asking(TaskAllocation[P]):
    """Asks an optimiser what to do with the robots that need a task or are at rest.

    The optimiser is asked when a robot needs a task or, for robots at rest, when there is new work,
    but at most once in `buffer_s` seconds. A rule decides for robots for which the answer contains
    no valid decision and, with `rule_meanwhile`, also for robots with a pod while an answer is
    pending. By this rule, a carried pod is brought to a station that it can serve or, if there is
    none, stored. A robot without a pod brings one to a station with work: the station that has the
    fewest robots at it or on their way to it, and among several such stations the nearest.
    """

    goes_on = True

    def __init__(self, parameters: P, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._rest = RestPlaces(view, parameters.rest, self.draw)
        self._seen: tuple[tuple[int, ...], ...] | None = None
        self._told: frozenset[int] = frozenset()
        self._told_s = nan
        self._buffer = Buffer(view, parameters.buffer_s)

    @abstractmethod
    def question(self, robots: Sequence[Robot], consult: Consult) -> Ask[Any]:
        """Return the question of what to do with robots that need a task or are at rest."""

    @abstractmethod
    def carry_out(self, call: Call, consult: Consult) -> Iterator[TaskDecision | Prepare]:
        """Yield the decisions of a solution that are still valid.

        Implementations must iterate over the parts of the solution with `call.left`.
        """

    def next_event_s(self) -> float:
        """Return when a question may next be asked, in s; inf if an event has to occur first."""
        return self._buffer.next_event_s

    def decide(self, consult: Consult) -> Iterator[Told]:
        """Ask the optimiser if there is something to decide and the buffer time is over.

        With `rule_meanwhile`, let the rule decide for robots with a pod while an answer is pending.
        """
        self._consult = consult
        if not self._was_just_told() and self._buffer.is_over(
            not self.in_flight and self._has_news()
        ):
            yield self._ask(consult)
        self._told = frozenset()
        if self.in_flight and self.parameters.rule_meanwhile:
            for robot in list(self.view.asking.values()):
                if robot.pod >= 0 and robot.task is None:
                    yield from self._by_rule(robot, consult)

    def answered(self, call: Call) -> Iterator[Told]:
        """Carry out the answer; for robots without a valid decision in it, let the rule decide."""
        consult = self._consult
        if call.solution is not None:
            yield from self.carry_out(call, consult)
        told = {robot.index for robot in call.ask.memo.robots}
        for robot in list(self.view.asking.values()):
            if robot.task is None and robot.index in told:
                yield from own(self._by_rule(robot, consult))
        waiting = (robot for robot in self.view.asking.values() if robot.task is None)
        if any(robot.index not in told for robot in waiting):
            # these robots have come to need a task meanwhile; those without an answer would get
            # none again
            yield from own(self.decide(consult))
        if call.paced_s == 0:
            self._told, self._told_s = frozenset(told), self.view.now_s

    def rest_place(self, robot: Robot) -> int:
        """Choose the resting place of a robot by the rest rule."""
        return self._rest.choose(robot)

    def to_rest(self, robot: Robot) -> Rest:
        """Return the decision to rest at the place that the rest rule chooses.

        If the rule finds no place, the robot rests where it is.
        """
        place = self._rest.choose(robot)
        return Rest(robot, place if place >= 0 else robot.waypoint)

    def place_for(self, robot: Robot, consult: Consult) -> int:
        """Return a storage location for the pod of a robot, or -1 if there is none."""
        return consult.place_for(robot)

    def pod_for(self, robot: Robot, station: int, consult: Consult) -> int:
        """Return a pod that a robot should bring to a station, or -1 if there is none."""
        return consult.pod_for(robot, station)

    def may_come(self, station: int) -> int:
        """Return how many more robots may go to a station."""
        target = self.view.stations[station]
        return max(0, self.parameters.robots_per_station - len(target.tasks))

    def _ask(self, consult: Consult) -> Ask[Any]:
        self._buffer.begin()
        self._seen = self._versions()
        robots = [robot for robot in self.view.asking.values() if robot.task is None]
        return self.question([*robots, *self.view.resting.values()], consult)

    def _was_just_told(self) -> bool:
        """Whether `decide` goes on after an answer that it got at once.

        If a program outside the simulation has to decide something while the answer is carried out,
        `decide` is interrupted at its question and starts anew. Robots that got no task would get
        none again.
        """
        if not self._told or self._told_s != self.view.now_s:
            return False
        waiting = {robot.index for robot in self.view.asking.values() if robot.task is None}
        return waiting <= self._told

    def _has_news(self) -> bool:
        """Whether a robot needs a task, or one at rest could have new work."""
        if any(robot.task is None for robot in self.view.asking.values()):
            return True
        return bool(self.view.resting) and self._versions() != self._seen

    def _versions(self) -> tuple[tuple[int, ...], ...]:
        return tuple(self.view.work_version(station.index) for station in self.view.stations)

    def _by_rule(self, robot: Robot, consult: Consult) -> Iterator[TaskDecision]:
        view = self.view
        if robot.pod >= 0:
            for station in view.stations:
                if consult.serves(robot.pod, station.index):
                    yield bring(view, robot, robot.pod, station.index)
                    return
            place = self.place_for(robot, consult)
            if place >= 0:
                yield Park(robot, place)
            return
        open_work = [s for s in view.stations if view.has_open_work(s.index)]
        for station in sorted(open_work, key=lambda s: (len(s.tasks), self._way_s(robot, s.index))):
            if self.may_come(station.index):
                pod = self.pod_for(robot, station.index, consult)
                if pod >= 0:
                    yield bring(view, keeper_of(view, robot, pod), pod, station.index)
                    if robot.task is not None:
                        return
        yield self.to_rest(robot)

    def _way_s(self, robot: Robot, station: int) -> float:
        to_station = self.view.travel.to(self.view.stations[station].waypoint, loaded=False)
        return float(to_station[robot.waypoint])
