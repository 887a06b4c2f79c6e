"""POA pile-on: a model assigns orders and chooses pods jointly; PPS must be `dummy`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

from rmfs.control.asks import By
from rmfs.control.poa import PickOrderAssignment
from rmfs.control.pps.lexicographic import Lexicographic
from rmfs.control.problems import Problem, Trigger
from rmfs.solvers.control.buffer import Buffer
from rmfs.solvers.control.pile_on import snapshot
from rmfs.solvers.control.pile_on.parameters import PileOnParameters
from rmfs.solvers.control.pile_on.plan import Plan
from rmfs.solvers.control.pile_on.question import by_rule

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import numpy as np

    from rmfs.control.asks import Ask, Call
    from rmfs.control.decisions import AssignLines, AssignOrder
    from rmfs.control.view import View
    from rmfs.solvers.control.pile_on.question import Question
    from rmfs.world.robots import Robot
    from rmfs.world.stations import PickStation, ReplenishmentStation

    Decision = Ask[Question] | By[AssignOrder | AssignLines]


class PileOnControl(PickOrderAssignment[PileOnParameters]):
    """Assigns orders and calls pods for them jointly, by an optimisation model, for a high pile-on.

    The controller maintains a plan: orders that wait for slots, and pods that have been called to
    stations and wait for robots. The model extends the plan. It is asked, at most once in
    `buffer_s` seconds, after the events selected by `triggers`: a station for which no pod is
    called runs out of work within `horizon_s`, a pod reaches a station, or a station with a free
    slot has no planned orders. The model determines which orders go to which station, and which
    pods are called for them. It also returns *prospects*: orders that the same pods can serve as
    soon as slots are free. Planned orders are assigned to free slots, and free robots fetch the
    called pods. Parts of the plan that have become invalid are dropped.

    A robot that is to bring a pod to a station fetches the nearest pod called for this station. If
    the optimiser fails, its method `greedy` decides. Pods for
    replenishment are chosen by the rule `lexicographic` of PPS with its default parameters. This
    rule also chooses a pod for a pick station if no pod is called for the station and the pods
    under way do not bring all units needed there.
    """

    parameters_model = PileOnParameters
    decides: ClassVar[frozenset[Problem]] = frozenset({Problem.PPS})
    subscriptions = frozenset({Trigger.POD_AT_STATION, Trigger.ROBOT_FREE})
    hears = frozenset({Trigger.POD_AT_STATION})
    optimisers: ClassVar[tuple[str, ...]] = ("rmfs.solvers.control.pile_on.question",)

    def __init__(self, parameters: PileOnParameters, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._heuristic = Lexicographic(Lexicographic.parameters_model(), view, rng)
        self._plan = Plan(
            view,
            parameters.kept_slots,
            later=parameters.later,
            split_orders=parameters.split_orders,
        )
        self._buffer = Buffer(view, parameters.buffer_s)
        self._arrived = True

    # --- orders ---------------------------------------------------------------------------------

    def hear(self, trigger: Trigger, subject: Any) -> None:
        """Record that a pod has reached a station, as further orders may use the pod's stock."""
        self._arrived = True

    def next_event_s(self) -> float:
        """Return when a question may next be asked, in s; inf if an event has to occur first."""
        return self._buffer.next_event_s

    def decide(self) -> Iterator[Decision]:
        """Assign planned orders to free slots; ask the optimiser if the plan has to be extended."""
        yield from self._carry_out()
        if not self._buffer.is_over(not self.in_flight and self._is_short()):
            return
        self._buffer.begin()
        taken = snapshot.take(self.view, self._plan, self.parameters)
        self._arrived = False
        if taken is not None:
            yield taken.ask(self.parameters)

    def answered(self, call: Call) -> Iterator[Decision]:
        """Add the valid parts of an answer to the plan, and carry it out as far as possible."""
        taken: snapshot.Snapshot = call.ask.memo
        if call.solution is not None:
            self._plan.extend(call.solution, taken.items, call)
        else:
            found = by_rule(call.ask.question)
            self._plan.extend(found, taken.items, None)
        yield from self._carry_out()

    def _is_short(self) -> bool:
        """Whether the plan should be extended."""
        given = self.parameters
        if self._arrived and "pod-at-station" in given.triggers:
            return True
        if "free-slot" in given.triggers and any(
            station.free_slots > 0 and not self._plan.items[station.index]
            for station in self.view.pick_stations
        ):
            return True
        if not given.when_needed or "short-of-work" not in given.triggers:
            return False
        for station in self.view.pick_stations:
            if not self._plan.pods[station.index]:
                units = sum(len(task.picks) for task in station.tasks.values())
                seconds = self.view.unit_s(station.index)
                if units * seconds < given.horizon_s:
                    return True
        return False

    def _carry_out(self) -> Iterator[Decision]:
        """Assign planned orders to free slots."""
        for station in self.view.pick_stations:
            for planned in self._plan.due(station):
                yield By(planned.item.decision(station.index), planned.call)

    # --- pods -----------------------------------------------------------------------------------

    def pick_pod(self, robot: Robot, station: PickStation) -> int | By[int]:
        """Return the nearest pod that is called for a station and can serve an open request there.

        If no pod at all is called for the station, and pods under way do not bring all units that
        its orders need, PPS lexicographic chooses a pod. In all other cases, the result is -1.
        """
        called = self._plan.pods[station.index]
        pods = [pod for pod in called if self._plan.useful(pod, station)]
        if pods:
            at = self.view.storage.pod_waypoint[pods]
            pod = pods[int(self.view.travel.estimate_s(robot.waypoint, at).argmin())]
            return By(pod, called.pop(pod).call)
        missing = self.view.need[station.index] > self.view.inventory.inbound[station.index]
        return self._heuristic.pick_pod(robot, station) if missing.any() and not called else -1

    def replenishment_pod(self, robot: Robot, station: ReplenishmentStation) -> int:
        """Choose the pod by PPS lexicographic."""
        return self._heuristic.replenishment_pod(robot, station)

    def next_station(self, robot: Robot, stations: Sequence[int]) -> int:
        """Choose the next station of a carried pod by PPS lexicographic."""
        return self._heuristic.next_station(robot, stations)
