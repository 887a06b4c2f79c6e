"""CA schedule: plans the charging of the whole fleet in advance."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING, Any, ClassVar

from rmfs.control.asks import Ask, By, own
from rmfs.control.ca.levels import ByLevel
from rmfs.control.ca.places import choose
from rmfs.control.decisions import Charge, Unplug
from rmfs.solvers.control.charging.forecast import Forecast
from rmfs.solvers.control.charging.parameters import ScheduleParameters
from rmfs.solvers.control.charging.question import Question, solve
from rmfs.solvers.control.charging.snapshot import Group, groups_of, snapshot
from rmfs.solvers.models.charging import AWAY

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np

    from rmfs.control.asks import Call
    from rmfs.control.view import View
    from rmfs.world.batteries import Batteries
    from rmfs.world.robots import Robot

    Told = Charge | Unplug | Ask[Any] | By[Any]


class ScheduleControl(ByLevel[ScheduleParameters]):
    """Plans which robots charge when, where and for how long, and carries out the next steps.

    Every `period_s` seconds, a model is given the battery levels of all robots, the charging
    places, and a forecast of the number of robots needed for work. It plans `slots` time slots
    ahead. The main terms of its objective are the time for which needed robots are missing, and the
    robot time that charging will take after these time slots. Robots whose stay at a charging place
    is due are sent there as soon as they are free. Charging robots stay until a new plan makes them
    leave or their battery is full. Until the first answer, and after a failure, the rule
    `threshold` applies, with `below_share`, `until_share` and `hand_over_share`.
    """

    parameters_model = ScheduleParameters
    optimisers: ClassVar[tuple[str, ...]] = ("rmfs.solvers.control.charging.question",)

    def __init__(
        self, parameters: ScheduleParameters, view: View, rng: np.random.Generator
    ) -> None:
        super().__init__(parameters, view, rng)
        self._forecast = Forecast(view, parameters.window_s, parameters.cases)
        self._groups: list[Group] | None = None
        self._asked_s = -inf
        self._plan: tuple[Call, set[int], dict[int, int]] | None = None

    def next_event_s(self) -> float:
        """Return when the next schedule is due, in s.

        The time is inf while a schedule is being computed, or if the robots have no batteries.
        """
        if self.view.batteries is None or self.in_flight:
            return inf
        return max(self._asked_s, 0.0) + self.parameters.period_s

    def decide(self) -> Iterator[Told]:
        """Ask for a new schedule if one is due; carry out the due steps of the current schedule."""
        batteries = self.view.batteries
        if batteries is None:
            return
        if not self.in_flight and self.view.now_s >= self._asked_s + self.parameters.period_s:
            self._asked_s = self.view.now_s
            question = self._question(batteries)
            if question is not None:
                yield question
        yield from self._carry_out(batteries)

    def answered(self, call: Call) -> Iterator[Told]:
        """Store the schedule, and carry out its due steps."""
        self._plan = None
        if call.solution is not None:
            stays = zip(call.solution["group"], call.solution["begin"], strict=True)
            soon: dict[int, int] = {}
            leaves: set[int] = set()
            ready, here = call.ask.memo
            for robot, (group, begin) in enumerate(stays):
                if here[robot] != AWAY:
                    if group == AWAY:
                        leaves.add(robot)
                elif group != AWAY and begin <= ready[robot]:
                    soon[robot] = int(group)
            self._plan = call, leaves, soon
        batteries = self.view.batteries
        if batteries is not None:
            yield from self._carry_out(batteries)

    def wanted_share(self, robot: Robot, share: float) -> float:
        """Return the level up to which a robot should charge by the rule `threshold`, or 0.

        The result is `until_share` if the robot's present level `share` is below `below_share`.
        Otherwise it is 0, and the robot should not charge.
        """
        given = self.parameters
        return given.until_share if share < given.below_share else 0.0

    def target_share(self) -> float:
        """Return the level of a full battery, up to which any robot may charge.

        The schedule determines which robots leave earlier.
        """
        batteries = self.view.batteries
        return 1.0 if batteries is None else batteries.given.full_share

    def _question(self, batteries: Batteries) -> Ask[Question] | None:
        view, given = self.view, self.parameters
        self._forecast.look()
        if self._groups is None:
            self._groups = groups_of(view, batteries)
        if not self._groups:
            return None
        data = snapshot(view, batteries, self._groups, self._forecast.cases(), given)
        sizes = {"robots": data.robots, "groups": len(self._groups), "slots": data.slots}
        memo = data.ready.tolist(), data.here.tolist()
        return Ask(solve, Question(data, given.method, given.limits), sizes, memo)

    def _carry_out(self, batteries: Batteries) -> Iterator[Told]:
        if self._plan is None:
            yield from own(super().decide())
            yield from own(self._leave(batteries))
            return
        call, leaves, soon = self._plan
        view = self.view
        for robot in [*view.asking.values(), *view.resting.values()]:
            if robot.index in soon and robot.pod < 0 and robot.station < 0:
                group = self._groups[soon.pop(robot.index)] if self._groups else None
                station = -1
                if group is not None:
                    station = choose(view, robot, self.parameters.place, among=group.stations)
                if station >= 0:
                    yield By(Charge(robot, station, self.target_share()), call)
                else:
                    call.stale += 1
        for charger in view.chargers:
            robot_here = charger.robot
            if robot_here in leaves and robot_here in charger.tasks:
                leaves.discard(robot_here)
                if batteries.share(robot_here) > batteries.enough_share:
                    yield By(Unplug(view.robots[robot_here]), call)

    def _leave(self, batteries: Batteries) -> Iterator[Unplug]:
        """Make robots leave that have reached `until_share`, as by the rule `threshold`."""
        for charger in self.view.chargers:
            here = charger.robot
            enough = max(self.parameters.until_share, batteries.enough_share)
            if here in charger.tasks and batteries.share(here) >= enough:
                yield Unplug(self.view.robots[here])
