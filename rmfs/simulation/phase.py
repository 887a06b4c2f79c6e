"""The decision phase: after the events of an instant controllers are asked until all is settled."""

from __future__ import annotations

from functools import partial
from math import inf
from time import perf_counter_ns
from typing import TYPE_CHECKING, Any

from rmfs.control import decisions as say
from rmfs.control.base import Controller
from rmfs.control.problems import Problem, Trigger
from rmfs.simulation.statistics import DecisionStatistics

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from rmfs.control.choices import Choice
    from rmfs.control.pps import PodSelection
    from rmfs.control.psa import PodStorageAssignment
    from rmfs.control.repositioning import Move, Repositioning
    from rmfs.control.settings import ControllerSettings
    from rmfs.simulation.simulation import Simulation
    from rmfs.world.orders import Bundle
    from rmfs.world.robots import Robot

# the steps of the phase in their order; the earliest one that is due comes next
_MANAGE = 0
_SUPPLY = 1
_ASKED = (Problem.SA, Problem.RPS, Problem.ROA, Problem.POA)
_LATE_BINDING = _SUPPLY + len(_ASKED) + 1
_TASKS = _LATE_BINDING + 1

_SUPPLY_AFTER = frozenset(
    {
        Trigger.START,
        Trigger.ORDER_ASSIGNED,
        Trigger.BUNDLE_ASSIGNED,
        Trigger.UNIT_PICKED,
        Trigger.BUNDLE_STORED,
    }
)
_LATE_BINDING_AFTER = frozenset(
    {Trigger.ORDER_ASSIGNED, Trigger.ORDER_QUEUED, Trigger.BUNDLE_ASSIGNED, Trigger.POD_LIFTED}
)


class DecisionPhase:
    """Knows what is due, asks the controllers, and applies what they say.

    The order is MM, supply, SA, RPS, ROA, POA, late binding, TA; whatever a step makes due is done
    before anything later in this order. PPS, PSA and repositioning are asked by TA; it is also
    asked when repositioning wants to be.

    Attributes
    ----------
    statistics
        Per problem whose controllers are asked.
    """

    def __init__(self, simulation: Simulation, settings: ControllerSettings) -> None:
        self._simulation = simulation
        self._world = simulation.world
        self._panel = simulation.panel
        self._due = 0
        self._storage_version = simulation.world.storage.version
        self._alarms: dict[Problem, tuple[float, int]] = {}
        self._overdue: set[Problem] = set()
        self._punctual: set[Problem] = set()
        self._nested_ns = 0
        self.statistics: dict[Problem, DecisionStatistics] = {
            problem: DecisionStatistics(str(problem), choice.name)
            for problem, choice in settings.choices.items()
            if problem is not Problem.PP
        }
        self._consult = _Consult(self, simulation)
        self._step_of = {problem: step for step, problem in enumerate(_ASKED, start=_SUPPLY + 1)}
        self._step_of[Problem.MM] = _MANAGE
        self._step_of[Problem.TA] = self._step_of[Problem.REPOSITIONING] = _TASKS
        self._masks: list[int] = []
        dispatch = simulation.dispatch
        self._apply: dict[type, Callable[[Any], None]] = {
            say.SwitchStation: self._switch_station,
            say.PromiseBundle: self._promise_bundle,
            say.ReleasePod: self._release_pod,
            say.SendBundle: self._send_bundle,
            say.AssignOrder: self._assign_order,
            say.QueueOrder: self._queue_order,
            say.BringForPicks: dispatch.bring_for_picks,
            say.BringForBundles: dispatch.bring_for_bundles,
            say.Park: dispatch.park,
            say.Reposition: dispatch.reposition,
            say.Rest: dispatch.rest,
            say.Prepare: self._prepare,
            say.Exchange: self._exchange,
        }
        self._connect()

    def exchange(self, choice: Choice) -> None:
        """Install another controller for a problem; it is asked in the phase of this instant.

        What the former one has promised lives in the world and is carried on with: bundles on pods
        and at stations, orders and robots at work. Given back is what only the former one knew
        what to do with: pools of queued orders, tasks prepared ahead, and bundles held back, if
        nobody is left who would release them.
        """
        problem, new = choice.problem, choice.controller
        if type(self._panel[problem]) is not new:
            if problem is Problem.POA:
                self._world.unqueue_all()
            elif problem is Problem.TA:
                for robot in self._world.robots:
                    robot.prepared.clear()
            elif problem is Problem.RPS and new.is_dummy:
                for pod in list(self._world.bundles.unreleased):
                    self._release_pod(say.ReleasePod(pod))
        self._panel.install(choice)
        self._simulation.observers.controller_exchanged(
            self._world.now_s, problem.value, choice.name
        )
        self._cancel_alarm(problem)
        self._connect()
        if problem in self.statistics:
            self.statistics[problem].name = choice.name
        if problem in self._step_of:
            self._overdue.add(problem)
            self._due |= 1 << self._step_of[problem]

    def _connect(self) -> None:
        """Take note of who is asked after which trigger."""
        step_of = self._step_of
        self._masks = []
        for trigger in Trigger:
            mask = 0
            for problem in self._panel.calls[trigger] & step_of.keys():
                mask |= 1 << step_of[problem]
            mask |= (trigger in _SUPPLY_AFTER) << _SUPPLY
            mask |= (trigger in _LATE_BINDING_AFTER) << _LATE_BINDING
            self._masks.append(mask)
        self._punctual = {
            problem
            for problem in step_of
            if type(self._panel[problem]).next_event_s is not Controller.next_event_s
        }

    # --- what is due ----------------------------------------------------------------------------

    def signal(self, trigger: Trigger, subject: Any = None) -> None:
        """Take note of an event: whom it concerns is asked in the phase of this instant."""
        self._due |= self._masks[trigger]
        for listener in self._panel.listeners[trigger]:
            listener(trigger, subject)

    def supply_wanted(self) -> None:
        """Take note that orders or bundles may be made now."""
        self._due |= 1 << _SUPPLY

    def place_left(self) -> None:
        """Take note that a storage place was left: a robot may wait for an empty one."""
        if self._world.asking:
            self._due |= 1 << _TASKS

    # --- asking ---------------------------------------------------------------------------------

    def settle(self) -> None:
        """Go through the steps that are due until none is."""
        storage = self._world.storage
        while True:
            if storage.version != self._storage_version:
                self._storage_version = storage.version
                self.signal(Trigger.POD_AT_HAND)
            due = self._due
            if not due:
                return
            lowest = due & -due
            self._due = due & ~lowest
            self._do(lowest.bit_length() - 1)

    def _do(self, step: int) -> None:
        if step == _SUPPLY:
            self._simulation.supply.top_up()
        elif step == _MANAGE:
            self._ask(Problem.MM, self._panel[Problem.MM].decide())
        elif step == _LATE_BINDING:
            self._simulation.late_binding.bind()
        elif step == _TASKS:
            self._give_tasks()
        else:
            problem = _ASKED[step - _SUPPLY - 1]
            self._ask(problem, self._panel[problem].decide())

    def _give_tasks(self) -> None:
        """Start tasks prepared ahead, then ask TA, with whom repositioning is asked as well."""
        world = self._world
        for robot in list(world.asking.values()):
            if robot.prepared:
                self._simulation.dispatch.start_prepared(robot, self._consult)
        if world.asking or world.resting or Problem.TA in self._overdue:
            self._ask(Problem.TA, self._panel[Problem.TA].decide(self._consult))
        self._overdue.discard(Problem.REPOSITIONING)
        if Problem.REPOSITIONING in self._punctual:
            self._set_alarm(Problem.REPOSITIONING)

    def _ask(self, problem: Problem, given: Iterable[Any]) -> None:
        """Apply decisions one by one, and measure the time it takes to come to them."""
        apply = self._apply
        count = spent_ns = 0
        self._nested_ns = 0
        start = perf_counter_ns()
        for decision in given:
            spent_ns += perf_counter_ns() - start
            apply[type(decision)](decision)
            count += 1
            start = perf_counter_ns()
        spent_ns += perf_counter_ns() - start - self._nested_ns
        self._record(problem, spent_ns, count)
        if self._overdue:
            self._overdue.discard(problem)
        if problem in self._punctual:
            self._set_alarm(problem)

    def consulted(self, problem: Problem, wall_ns: int, decided: bool) -> None:
        """Take note that TA asked another controller."""
        self._nested_ns += wall_ns
        self._record(problem, wall_ns, int(decided))

    def _record(self, problem: Problem, wall_ns: int, count: int) -> None:
        self.statistics[problem].record(wall_ns, count)
        self._simulation.observers.decision(problem.value, self._world.now_s, wall_ns / 1e9, count)

    # --- times at which controllers want to be asked ------------------------------------------

    def _set_alarm(self, problem: Problem) -> None:
        """Enter, or change, the time at which a controller wants to be asked."""
        time_s = self._panel[problem].next_event_s()
        simulation = self._simulation
        if problem in self._alarms and self._alarms[problem][0] == time_s:
            return
        self._cancel_alarm(problem)
        if time_s < inf:
            # never at the present instant, or a controller could keep it from ending
            time_us = max(simulation.us_at(time_s), simulation.now_us + 1)
            entry = simulation.agenda.at(time_us, partial(self._alarm, problem))
            self._alarms[problem] = (time_s, entry)

    def _cancel_alarm(self, problem: Problem) -> None:
        if problem in self._alarms:
            self._simulation.agenda.cancel(self._alarms.pop(problem)[1])

    def _alarm(self, problem: Problem) -> None:
        """Let a controller be asked because its time has come."""
        del self._alarms[problem]
        self._overdue.add(problem)
        self._due |= 1 << self._step_of[problem]

    # --- applying -------------------------------------------------------------------------------

    def _exchange(self, decision: say.Exchange) -> None:
        self.exchange(decision.choice)

    def _prepare(self, decision: say.Prepare) -> None:
        """Remember tasks for later, or start the first if the robot has nothing better to do."""
        dispatch, robot = self._simulation.dispatch, decision.robot
        dispatch.prepare(decision)
        if robot.task is None or robot.index in self._world.resting:
            dispatch.start_prepared(robot, self._consult)

    def _switch_station(self, decision: say.SwitchStation) -> None:
        station = self._world.stations[decision.station]
        if station.active != decision.active:
            station.active = decision.active
            self._simulation.observers.station_activated(
                self._world.now_s, station.index, decision.active
            )
            self.signal(Trigger.STATION_SWITCHED, station.index)

    def _promise_bundle(self, decision: say.PromiseBundle) -> None:
        self._world.promise(decision.bundle, decision.pod)
        self.signal(Trigger.BUNDLE_PROMISED, decision.bundle)

    def _release_pod(self, decision: say.ReleasePod) -> None:
        assigned = self._world.release_bundles(decision.pod)
        self.signal(Trigger.BUNDLE_RELEASED, decision.pod)
        for bundle in assigned:
            self._bundle_assigned(bundle)

    def _send_bundle(self, decision: say.SendBundle) -> None:
        bundle = decision.bundle
        assigned = self._world.choose_station(bundle, decision.station)
        self.signal(Trigger.BUNDLE_SENT, bundle)
        if assigned:
            self._bundle_assigned(bundle)

    def _bundle_assigned(self, bundle: Bundle) -> None:
        self._simulation.late_binding.bundle_assigned(bundle)
        self._simulation.observers.bundle_assigned(bundle)
        self.signal(Trigger.BUNDLE_ASSIGNED, bundle)

    def _assign_order(self, decision: say.AssignOrder) -> None:
        order = decision.order
        self._world.assign_order(order, decision.station)
        self._simulation.late_binding.order_assigned(order)
        self._simulation.observers.order_assigned(order)
        self.signal(Trigger.ORDER_ASSIGNED, order)

    def _queue_order(self, decision: say.QueueOrder) -> None:
        order = decision.order
        if decision.station < 0:
            self._world.unqueue_order(order)
            return
        self._world.queue_order(order, decision.station)
        self._simulation.late_binding.order_queued(order)
        self.signal(Trigger.ORDER_QUEUED, order)


class _Consult:
    """Passes TA's questions on to the controllers installed now, and measures them."""

    def __init__(self, phase: DecisionPhase, simulation: Simulation) -> None:
        self._phase = phase
        self._world = simulation.world
        self._panel = simulation.panel

    def serves(self, pod: int, station: int) -> bool:
        """Ask PPS whether there is work for a pod."""
        pps: PodSelection[Any] = self._panel[Problem.PPS]
        return pps.serves(pod, station)

    def pod_for(self, robot: Robot, station: int) -> int:
        """Ask PPS for a pod."""
        start = perf_counter_ns()
        pps: PodSelection[Any] = self._panel.consulted(Problem.PPS)
        if self._world.is_pick_station(station):
            pod = pps.pick_pod(robot, self._world.pick_stations[station])
        else:
            pod = pps.replenishment_pod(robot, self._world.replenishment_station(station))
        self._phase.consulted(Problem.PPS, perf_counter_ns() - start, pod >= 0)
        return pod

    def next_station(self, robot: Robot, stations: Sequence[int]) -> int:
        """Ask PPS for the next station of a carried pod."""
        start = perf_counter_ns()
        pps: PodSelection[Any] = self._panel.consulted(Problem.PPS)
        station = pps.next_station(robot, stations)
        self._phase.consulted(Problem.PPS, perf_counter_ns() - start, decided=True)
        return station

    def place_for(self, robot: Robot) -> int:
        """Ask PSA for a place."""
        start = perf_counter_ns()
        psa: PodStorageAssignment[Any] = self._panel.consulted(Problem.PSA)
        place = psa.place(robot)
        self._phase.consulted(Problem.PSA, perf_counter_ns() - start, place >= 0)
        return place

    def move_for(self, robot: Robot) -> Move | None:
        """Ask repositioning for a pod to move, unless it would not answer now."""
        rule: Repositioning[Any] = self._panel.consulted(Problem.REPOSITIONING)
        if not rule.is_ready(robot):
            return None
        start = perf_counter_ns()
        move = rule.move(robot)
        self._phase.consulted(Problem.REPOSITIONING, perf_counter_ns() - start, move is not None)
        return move
