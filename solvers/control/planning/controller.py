"""TA planning: plans which pods visit each station, in which sequence, and for which orders."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from rmfs.control.asks import By
from rmfs.control.decisions import (
    BringForBundles,
    BringForPicks,
    Park,
)
from rmfs.control.problems import Trigger
from rmfs.control.ta.stations import bring, keeper_of
from rmfs.solvers.control.joint import JointAllocation
from rmfs.solvers.control.planning import snapshot
from rmfs.solvers.control.planning.expected import ExpectedOrders
from rmfs.solvers.control.planning.parameters import PlanningParameters
from rmfs.solvers.control.planning.plan import Plan
from rmfs.solvers.control.planning.question import by_rule
from rmfs.world.stations import PickStation

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.control.asks import Ask, Call
    from rmfs.control.decisions import TaskDecision
    from rmfs.control.ta import Consult
    from rmfs.control.view import View
    from rmfs.solvers.control.planning.question import Question
    from rmfs.world.robots import Robot

    Decision = Ask[Question] | TaskDecision | By[Any]

_WORTH_A_PLAN = 2
"""Number of free slots of a station above which a new order alone justifies a new plan."""


class PlanningControl(JointAllocation[PlanningParameters]):
    """Plans the next visits of pods to every pick station, but carries out only what is due.

    The model is used, at most once in `buffer_s` seconds, after one of three events: a pod has
    reached a pick station; a robot without a pod needs a task; or an order has arrived while a
    robot rests or a station has more than two free slots. The model plans several visits to each
    station, and the orders that these visits serve. Orders are planned whole, and each keeps its
    slot until its last line has been picked; with `split`, single lines are planned instead. The
    search for a plan starts from the previous plan. Only two kinds of steps of the plan are carried
    out. An order gets its slot once its first pod is under way. The next pod of a station is
    fetched, by the free robot nearest to the pod, if the pods under way to the station bring less
    than `horizon_s` seconds of work.

    All other decisions are made by rules. A robot keeps its pod at the station while there is work
    for the pod. Then it takes the pod to a replenishment station where bundles for the pod wait or,
    if there is no such station, parks it where PSA chooses. While the stock (the share of the space
    on pods that is used) is below `stock_floor`, some robots (`bundle_share`) bring pods to
    replenishment stations. While it is below `stock_ceiling`, robots that no pick station needs do
    so as well. If the optimiser fails, its start rule makes the plan.
    """

    parameters_model = PlanningParameters
    optimisers: ClassVar[tuple[str, ...]] = ("rmfs.solvers.control.planning.question",)

    def __init__(
        self, parameters: PlanningParameters, view: View, rng: np.random.Generator
    ) -> None:
        super().__init__(parameters, view, rng, parameters.rest)
        self._plan = Plan(view, parameters.split_orders)
        self._asked_s = -inf
        self._asked = 0
        self._changed = True
        self._wants_to_ask = False
        self._expected = ExpectedOrders(view, rng) if parameters.expected_s else None

    # --- when the model is asked ----------------------------------------------------------------

    def hear(self, trigger: Trigger, subject: Any) -> None:
        """Record an event after which the model may be asked for a better plan."""
        view = self.view
        if self._expected is not None and trigger is Trigger.NEW_ORDER:
            self._expected.hear(subject)
        if trigger is Trigger.ROBOT_FREE:
            self._changed |= view.robots[subject].pod < 0
        elif trigger is Trigger.POD_AT_STATION:
            self._changed |= isinstance(view.all_stations[subject], PickStation)
        else:
            free = max(station.free_slots for station in view.pick_stations)
            self._changed |= bool(view.resting) or free > _WORTH_A_PLAN

    def next_event_s(self) -> float:
        """Return when a question may next be asked, in s; inf if an event has to occur first."""
        return self._asked_s + self.parameters.buffer_s if self._wants_to_ask else inf

    def decide(self, consult: Consult) -> Iterator[Decision]:
        """Ask for a plan if needed, carry out what is due, and assign all other tasks by rules."""
        yield from self._give_slots()
        yield from self._ask()
        yield from self._give_slots()
        for robot in [r for r in self.view.asking.values() if r.pod >= 0]:
            yield from self._go_on(robot, consult)
        yield from self._send()
        for robot in [r for r in self.view.asking.values() if r.pod < 0]:
            yield self._to_rest(robot)

    def answered(self, call: Call) -> Iterator[Decision]:
        """Store the plan and carry out what is due; no robot is sent to rest yet."""
        memo: snapshot.Memo = call.ask.memo
        if call.solution is not None:
            self._plan.take(call.solution, memo, call)
        else:
            self._plan.take(by_rule(call.ask.question), memo, None)
        yield from self._give_slots()
        yield from self._send()

    def _ask(self) -> Iterator[Decision]:
        given, now_s = self.parameters, self.view.now_s
        self._wants_to_ask = self._changed and not self.in_flight
        if not self._wants_to_ask or now_s < self._asked_s + given.buffer_s:
            return
        self._asked_s, self._changed, self._wants_to_ask = now_s, False, False
        self._asked += 1
        expected = self._expected.draw(given.expected_s, given.scenarios) if self._expected else ()
        question = snapshot.ask(
            self.view, given, self._neediest(), self._plan, self._asked, expected
        )
        if question is not None:
            yield question

    def _neediest(self) -> list[PickStation]:
        """Return the stations to plan for: those with the least work under way, by index."""
        stations = self.view.pick_stations
        most = self.parameters.stations
        if len(stations) <= most:
            return list(stations)
        work = [self._plan.units(station) for station in stations]
        chosen = sorted(range(len(stations)), key=lambda s: (work[s], s))[:most]
        return [stations[number] for number in sorted(chosen)]

    # --- what is due of the plan ----------------------------------------------------------------

    def _give_slots(self) -> Iterator[Decision]:
        """Assign slots to orders whose first pod is under way."""
        for station in self.view.pick_stations:
            for decision in self._plan.due(station):
                yield By(decision, self._plan.call(station.index))

    def _send(self) -> Iterator[Decision]:
        """Send free robots: for bundles if stock is low, for picks, then for bundles again."""
        view = self.view
        stored = view.inventory.stored_space / view.inventory.total_capacity
        if stored < self.parameters.stock_floor:
            needed = max(1, round(self.parameters.bundle_share * len(view.robots)))
            yield from self._replenish(needed - self._at_bundles())
        while (free := self._free_robots()) and (station := self._short()) is not None:
            pod = self._plan.pods[station.index].pop(0)
            near = self._nearest(free, pod)
            fetch = BringForPicks(keeper_of(view, near, pod), pod, station.index)
            yield By(fetch, self._plan.call(station.index))
            yield from self._give_slots()
        if stored < self.parameters.stock_ceiling:
            yield from self._replenish(len(view.robots))

    def _short(self) -> PickStation | None:
        """Return the station with the least work among those that need a pod."""
        given, found = self.parameters, []
        for station in self.view.pick_stations:
            room = len(station.tasks) < given.robots_per_station
            if room and self._plan.next_pod(station.index) >= 0:
                unit_s = self.view.unit_s(station.index)
                work_s = self._plan.units(station) * unit_s
                if work_s < given.horizon_s:
                    found.append((work_s, station.index))
        return self.view.pick_stations[min(found)[1]] if found else None

    # --- what is left to rules ------------------------------------------------------------------

    def _go_on(self, robot: Robot, consult: Consult) -> Iterator[Decision]:
        """Keep a pod at its station, take it to bundles that wait for it, or park it."""
        view, here = self.view, robot.station
        if here >= 0 and consult.serves(robot.pod, here):
            yield bring(view, robot, robot.pod, here)
            return
        station = view.all_stations[here] if here >= 0 else None
        if isinstance(station, PickStation) and self._waits(robot, station):
            return
        for other in view.replenishment_stations:
            if other.index != here and consult.serves(robot.pod, other.index):
                yield BringForBundles(robot, robot.pod, other.index)
                return
        place = consult.place_for(robot)
        if place >= 0:
            yield Park(robot, place)

    def _waits(self, robot: Robot, station: PickStation) -> bool:
        """Whether a slot is about to be free, and a waiting order needs only this robot's pod."""
        soon = any(order.unpicked_units == 0 for order in station.orders.values())
        return soon and self._plan.streams(robot.pod, station.index)
