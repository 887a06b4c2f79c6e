"""TA pile-on: assigns orders, pods and robots jointly by the model M1G of Jiao et al. (2025)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

import numpy as np
import pydantic

from rmfs.control.asks import By
from rmfs.control.decisions import (
    BringForPicks,
    Park,
)
from rmfs.control.problems import Trigger
from rmfs.control.ta.rest import RestRule
from rmfs.control.ta.stations import bring, keeper_of, near_by
from rmfs.solvers.control.buffer import Buffer
from rmfs.solvers.control.joint import JointAllocation
from rmfs.solvers.control.pile_on import snapshot
from rmfs.solvers.control.pile_on.parameters import JointParameters
from rmfs.solvers.control.pile_on.plan import Plan
from rmfs.solvers.control.pile_on.question import by_rule

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.control.asks import Ask, Call
    from rmfs.control.decisions import TaskDecision
    from rmfs.control.ta import Consult
    from rmfs.control.view import View
    from rmfs.solvers.control.pile_on.question import Question
    from rmfs.world.robots import Robot
    from rmfs.world.stations import PickStation

    Decision = Ask[Question] | TaskDecision | By[Any]


AsksTasks = Literal["pod-at-station", "robot-free", "new-order"]


class PileOnTasksParameters(JointParameters):
    """Parameters of TA pile-on; by default, the weights of the objective are those of M1G."""

    triggers: tuple[AsksTasks, ...] = ("pod-at-station", "robot-free", "new-order")
    """Events after which the optimiser is asked: `pod-at-station` (a pod has reached a station),
    `robot-free` (a robot needs a task) and `new-order` (an order has arrived while a robot
    rests)."""

    when_needed: bool = False
    """Whether pods are called only for two groups of stations: those that have less than
    `horizon_s` seconds of work, and those with orders for which pods are still missing. If false,
    pods are called whenever a slot can be filled, as in the model M1G of Jiao et al. (2025)."""
    kept_slots: Annotated[int, pydantic.Field(ge=0)] = 0
    """Number of slots of each station that are reserved for orders that the pod at the head of the
    station's queue can serve."""
    reward_s: Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)] = 40.0
    """Value, in seconds of robot time, of each order (with `split`, of each line) that the pods of
    one station (present, under way or called) can serve completely."""
    visit_s: Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)] = 0.0
    """Cost of a visit, in seconds of robot time, in addition to the trips to the pod and to the
    station."""
    age_reward: Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)] = 0.0
    """Additional value of assigning an order, in seconds of robot time, per second that the order
    has waited, times the weight of the order's class."""
    replenishment_share: Annotated[float, pydantic.Field(ge=0, le=1)] = 0.33
    """Maximum share of all robots that may work for replenishment stations at a time; at least one
    robot may."""
    other_stations: bool = False
    """Whether a robot may take its pod to another station nearby when the present station has no
    more work for the pod."""
    search_radius_m: Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)] = 8.0
    """With `other_stations`, maximum Euclidean distance, in m, from the robot to the other
    station."""
    rest: RestRule = "nearest"
    """Storage location where an idle robot waits: the one nearest to the middle of its tier
    (`middle`), the one nearest to the robot (`nearest`), or one drawn at random (`random`); if
    possible, beneath a stored pod."""


_ASKS: dict[Trigger, AsksTasks] = {
    Trigger.POD_AT_STATION: "pod-at-station",
    Trigger.ROBOT_FREE: "robot-free",
    Trigger.NEW_ORDER: "new-order",
    Trigger.ORDER_CUT: "new-order",
}


class PileOnTasks(JointAllocation[PileOnTasksParameters]):
    """Asks a model which orders get slots, which pods are called, and which robots fetch the pods.

    The model is used after the events in `triggers`, at most once in `buffer_s` seconds, and only
    if it is needed by some station: one with a free slot for which no order is planned, or one with
    requests that the pods under way to it cannot serve. The model chooses from the robots that
    carry no pod and have no task other than resting. Its answer is added to a plan: planned orders
    get slots when slots are free, and called pods are fetched by the robots that the answer names.
    If the robot named for a pod is no longer free, the nearest free robot fetches the pod.

    All other decisions are made by rules. A robot keeps its pod at the station while there is work
    for the pod, then (with `other_stations`) takes it to pick stations nearby that the pod can
    serve, and finally parks it where PSA chooses. Up to `replenishment_share` of the robots bring
    pods to replenishment stations, each to the nearest station with work; PPS lexicographic chooses
    the pods. A robot rests if it gets no task. If the optimiser fails, its method `greedy` decides.
    """

    parameters_model = PileOnTasksParameters
    optimisers: ClassVar[tuple[str, ...]] = ("rmfs.solvers.control.pile_on.question",)

    def __init__(
        self, parameters: PileOnTasksParameters, view: View, rng: np.random.Generator
    ) -> None:
        super().__init__(parameters, view, rng, parameters.rest)
        self._plan = Plan(
            view,
            parameters.kept_slots,
            later=parameters.later,
            split_orders=parameters.split_orders,
        )
        self._most_at_bundles = max(round(parameters.replenishment_share * len(view.robots)), 1)
        self._buffer = Buffer(view, parameters.buffer_s)
        self._changed = True

    def hear(self, trigger: Trigger, subject: Any) -> None:
        """Record an event whose kind is in `triggers`; the model may then be asked.

        A new order, or one that has lost units, is recorded only if a robot is resting.
        """
        kind = _ASKS[trigger]
        asks = kind in self.parameters.triggers
        self._changed |= asks and (kind != "new-order" or bool(self.view.resting))

    def next_event_s(self) -> float:
        """Return when a question may next be asked, in s; inf if an event has to occur first."""
        return self._buffer.next_event_s

    def decide(self, consult: Consult) -> Iterator[Decision]:
        """Carry out the plan, ask the optimiser if needed, and assign all other tasks by rules."""
        for robot in [r for r in self.view.asking.values() if r.pod >= 0]:
            yield from self._go_on(robot, consult)
        yield from self._replenish(self._most_at_bundles - self._at_bundles())
        yield from self._carry_out()
        yield from self._ask()
        for robot in [r for r in self.view.asking.values() if r.pod < 0]:
            yield self._to_rest(robot)

    def answered(self, call: Call) -> Iterator[Decision]:
        """Add the valid parts of an answer to the plan; carry out the plan as far as possible."""
        taken: snapshot.Snapshot = call.ask.memo
        if call.solution is not None:
            self._plan.extend(call.solution, taken.items, call, taken.robots)
        else:
            self._plan.extend(by_rule(call.ask.question), taken.items, None, taken.robots)
        yield from self._carry_out()

    # --- the model ------------------------------------------------------------------------------

    def _ask(self) -> Iterator[Decision]:
        if not self._buffer.is_over(self._changed and not self.in_flight and self._is_short()):
            return
        self._buffer.begin()
        self._changed = False
        taken = snapshot.take(self.view, self._plan, self.parameters, self._free_robots())
        if taken is not None:
            yield taken.ask(self.parameters)

    def _is_short(self) -> bool:
        """Whether there is a slot, or an open request, for which nothing is planned."""
        view, items = self.view, self._plan.items
        if any(s.free_slots > len(items[s.index]) for s in view.pick_stations):
            return True
        return bool((view.need > view.inventory.inbound[: len(view.pick_stations)]).any())

    # --- orders and pods ------------------------------------------------------------------------

    def _carry_out(self) -> Iterator[Decision]:
        """Assign planned orders to free slots, and send robots for the called pods."""
        for station in self.view.pick_stations:
            for planned in self._plan.due(station):
                yield By(planned.item.decision(station.index), planned.call)
            yield from self._fetch(station)

    def _fetch(self, station: PickStation) -> Iterator[Decision]:
        """Send a robot for each called pod: the one in the plan, or else the nearest free one."""
        called = self._plan.pods[station.index]
        for pod in [pod for pod in called if self._plan.useful(pod, station)]:
            free = {robot.index: robot for robot in self._free_robots()}
            if not free:
                return
            call, named = called.pop(pod)
            chosen = free[named] if named in free else self._nearest(list(free.values()), pod)
            fetch = BringForPicks(keeper_of(self.view, chosen, pod), pod, station.index)
            yield By(fetch, call)

    # --- what the model leaves open -------------------------------------------------------------

    def _go_on(self, robot: Robot, consult: Consult) -> Iterator[Decision]:
        """Keep a pod at its station, bring it to another pick station, or park it."""
        station = robot.station
        if station >= 0 and consult.serves(robot.pod, station):
            yield bring(self.view, robot, robot.pod, station)
            return
        elsewhere = self._elsewhere(robot, consult)
        if elsewhere >= 0:
            yield bring(self.view, robot, robot.pod, elsewhere)
            return
        place = consult.place_for(robot)
        if place >= 0:
            yield Park(robot, place)

    def _elsewhere(self, robot: Robot, consult: Consult) -> int:
        """Return the pick station nearby that PPS chooses for the robot's pod, or -1."""
        given = self.parameters
        if not given.other_stations:
            return -1
        among = [s.index for s in self.view.pick_stations]
        stations = near_by(self.view, robot, given.search_radius_m, among, consult)
        return consult.next_station(robot, stations) if stations else -1
