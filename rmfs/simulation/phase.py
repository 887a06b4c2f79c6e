"""The decision phase: after the events of an instant controllers are asked until all is settled."""

from __future__ import annotations

from functools import partial
from math import inf
from time import perf_counter_ns
from typing import TYPE_CHECKING, Any

from rmfs.control import decisions as say
from rmfs.control.asks import Ask, Outcome
from rmfs.control.base import Controller
from rmfs.control.problems import Problem, Trigger
from rmfs.simulation.consult import PhaseConsult
from rmfs.simulation.statistics import DecisionStatistics

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from rmfs.control.asks import Call
    from rmfs.control.choices import Choice
    from rmfs.control.settings import ControllerSettings
    from rmfs.simulation.simulation import Simulation
    from rmfs.world.orders import Bundle, Order

# the steps of the phase in their order; the earliest one that is due comes next
_ANSWERS = 0
_MANAGE = 1
_SUPPLY = 2
_ASKED = (Problem.SA, Problem.RPS, Problem.ROA, Problem.POA)
_LATE_BINDING = _SUPPLY + len(_ASKED) + 1
# these may ask optimisers; what they decide, TA asks
_PLAN = (Problem.PPS, Problem.PSA)
_TASKS = _LATE_BINDING + len(_PLAN) + 1

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

    The order is answers of optimisers, MM, supply, SA, RPS, ROA, POA, late binding, PPS, PSA, TA;
    whatever a step makes due is done before anything later in this order. PPS, PSA and
    repositioning decide when TA asks them; in steps of their own PPS and PSA may only ask
    optimisers. TA is also asked when repositioning wants to be.

    Attributes
    ----------
    statistics
        Per problem whose controllers are asked.
    choices
        The controllers installed at present.
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
        self.choices = dict(settings.choices)
        self._consult = PhaseConsult(self, simulation)
        self._answers: list[Call] = []
        self._problem_of = dict(enumerate(_ASKED, start=_SUPPLY + 1))
        self._problem_of |= dict(enumerate(_PLAN, start=_LATE_BINDING + 1))
        self._step_of = {problem: step for step, problem in self._problem_of.items()}
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
            say.AssignLines: self._assign_lines,
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
                    self._simulation.dispatch.forget_prepared(robot)
            elif problem is Problem.RPS and new.is_dummy:
                for pod in list(self._world.bundles.unreleased):
                    self._release_pod(say.ReleasePod(pod))
        self._panel.install(choice)
        self.choices[problem] = choice
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
        elif step == _ANSWERS:
            self._take_answers()
        else:
            problem = self._problem_of[step]
            self._ask(problem, self._panel[problem].decide())

    def _give_tasks(self) -> None:
        """Start tasks prepared ahead, then ask TA, with whom repositioning is asked as well."""
        world = self._world
        for robot in list(world.asking.values()):
            if robot.prepared:
                self._simulation.dispatch.start_prepared(robot, self._consult)
        rule = self._panel[Problem.TA]
        orders_too = Problem.POA in rule.decides
        if world.asking or world.resting or orders_too or Problem.TA in self._overdue:
            self._ask(Problem.TA, rule.decide(self._consult))
        self._overdue.discard(Problem.REPOSITIONING)
        if Problem.REPOSITIONING in self._punctual:
            self._set_alarm(Problem.REPOSITIONING)

    def _ask(self, problem: Problem, given: Iterable[Any], basis: Call | None = None) -> None:
        """Apply decisions one by one, and measure the time it takes to come to them.

        An answer may come while the controller that asked is still deciding: then this is nested.
        """
        apply, controller = self._apply, self._panel[problem]
        nested_ns, self._nested_ns = self._nested_ns, 0
        former, controller.basis = controller.basis, basis
        count = by_rule = spent_ns = 0
        start = perf_counter_ns()
        for decision in given:
            spent_ns += perf_counter_ns() - start
            if type(decision) is Ask:
                self._simulation.thinking.ask(problem, controller, decision)
            else:
                apply[type(decision)](decision)
                count += 1
                if controller.optimisers and controller.is_modelled(decision):
                    self.decided(problem, controller)
                by_rule += controller.basis is None
            start = perf_counter_ns()
        spent_ns += perf_counter_ns() - start - self._nested_ns
        self._nested_ns, controller.basis = nested_ns, former
        self._record(problem, spent_ns, count, by_rule)
        if self._overdue:
            self._overdue.discard(problem)
        if problem in self._punctual:
            self._set_alarm(problem)

    def consulted(
        self,
        problem: Problem,
        controller: Controller[Any],
        wall_ns: int,
        decided: bool,
        modelled: bool = True,
    ) -> None:
        """Take note that TA asked another controller; `modelled`: a choice that models take."""
        self._nested_ns += wall_ns
        self._record(problem, wall_ns, int(decided), int(decided and controller.basis is None))
        if decided and controller.optimisers and (modelled or controller.basis is not None):
            self.decided(problem, controller)

    def decided(self, problem: Problem, controller: Controller[Any]) -> None:
        """Count a decision of a controller that asks optimisers: by a solution or by its rule."""
        if controller.basis is None:
            self._simulation.observers.rule_decided(problem.value, self._world.now_s)
        else:
            controller.basis.count()

    def _record(self, problem: Problem, wall_ns: int, count: int, by_rule: int) -> None:
        """Take note of a call; decisions by a solution are told with the question."""
        self.statistics[problem].record(wall_ns, count)
        now_s, wall_s = self._world.now_s, wall_ns / 1e9
        self._simulation.observers.decision(problem.value, now_s, wall_s, by_rule)

    # --- answers of optimisers ----------------------------------------------------------------

    def answer_came(self, call: Call) -> None:
        """Take note of an answer: the controller is told in the phase of this instant."""
        self._answers.append(call)
        self._due |= 1 << _ANSWERS

    def _take_answers(self) -> None:
        answers, self._answers = sorted(self._answers, key=lambda call: call.number), []
        for call in answers:
            self.tell(call)

    def tell(self, call: Call) -> None:
        """Tell the controller that asked what came back, and apply what it makes of it."""
        controller = call.controller
        controller.in_flight -= 1
        call.completed_us = self._simulation.now_us
        if self._panel[call.problem] is not controller:
            call.outcome = Outcome.ABANDONED
        else:
            self._ask(call.problem, controller.answered(call), call)
        self._simulation.observers.optimiser_answered(call)
        call.forget()

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
        ta = self._panel[Problem.TA]
        dispatch.prepare(decision, ta.basis)
        if ta.optimisers and ta.basis is None:
            self.decided(Problem.TA, ta)
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
        self._order_assigned(self._world.assign_order(*decision))

    def _assign_lines(self, decision: say.AssignLines) -> None:
        self._order_assigned(self._world.assign_lines(*decision))

    def _order_assigned(self, order: Order) -> None:
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
