"""The decision phase at the end of each instant, in which controllers are asked for decisions."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from rmfs.control import decisions as say
from rmfs.control import errands
from rmfs.control.asks import Outcome
from rmfs.control.problems import Problem
from rmfs.control.questions import Question
from rmfs.simulation import steps
from rmfs.simulation.consult import OutsideConsult, PhaseConsult
from rmfs.simulation.outside import ASKED_BY_TA, Awaits, Outside
from rmfs.simulation.rule_state import RuleState

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from rmfs.control.asks import Call
    from rmfs.control.base import Controller
    from rmfs.control.choices import Choice
    from rmfs.control.view import View
    from rmfs.simulation.agenda import Agenda
    from rmfs.simulation.alarms import Alarms
    from rmfs.simulation.applying import Applying
    from rmfs.simulation.arrivals import ArrivalProcess
    from rmfs.simulation.charging.guard import EnergyGuard
    from rmfs.simulation.controller_set import ControllerSet
    from rmfs.simulation.deciding import Deciding
    from rmfs.simulation.dispatch import Dispatch
    from rmfs.simulation.events import Events
    from rmfs.simulation.late_binding import LateBinding
    from rmfs.simulation.steps import Due
    from rmfs.simulation.visits import Visits
    from rmfs.world import World
    from rmfs.world.robots import Robot


class DecisionPhase:
    """Processes the steps that are due at the present instant; in most steps, a controller decides.

    The order of the steps is: answers of optimisers, MM, arrivals, SA, RPS, ROA, POA, late binding,
    PPS, PSA, CA, TA. After each step, the first due step in this order comes next. The controllers
    of PPS, PSA and repositioning decide only when TA asks them. In the steps PPS and PSA, these
    controllers take no decisions, but may put questions to optimisers. The step TA is also due at
    the times that the controller of repositioning specifies.

    Attributes
    ----------
    outside
        The problems decided outside the simulation, and the pending question.
    choices
        The currently installed controllers, by decision problem.
    """

    def __init__(
        self,
        choices: Mapping[Problem, Choice],
        outside: Outside,
        *,
        agenda: Agenda,
        world: World,
        view: View,
        events: Events,
        controllers: ControllerSet,
        due: Due,
        alarms: Alarms,
        deciding: Deciding,
        dispatch: Dispatch,
        late_binding: LateBinding,
        visits: Visits,
        guard: EnergyGuard | None = None,
    ) -> None:
        self._agenda, self._world, self._events = agenda, world, events
        self._controllers, self._due, self._alarms = controllers, due, alarms
        self._view = view
        self._deciding, self._dispatch, self._late_binding = deciding, dispatch, late_binding
        self._visits = visits
        self._guard = guard
        self._answers: list[Call] = []
        self._half_told: list[Call] = []
        self._starting: Robot | None = None
        self._interrupted = 0
        # whether this step TA, if the outside interrupts it, has done what comes before TA is asked
        self._is_secured = False
        self._applying: Applying
        self._arrivals: ArrivalProcess
        self._steps: dict[int, Callable[[], Question | None]]
        self.choices = dict(choices)
        self.outside = outside
        self._rule_state = RuleState()
        self._consult = PhaseConsult(world, controllers, deciding)
        if outside.problems & ASKED_BY_TA:
            self._consult = OutsideConsult(world, controllers, deciding, outside)
        self._alarms.connect(steps.STEP_OF)

    def connect(self, applying: Applying, arrivals: ArrivalProcess) -> None:
        """Set the objects that apply decisions (`applying`) and create arrivals (`arrivals`)."""
        self._applying, self._arrivals = applying, arrivals
        self._steps = self._what_is_done()

    def exchange(self, choice: Choice) -> None:
        """Install another controller for a problem; it is asked for decisions at this instant.

        Decisions that have been applied remain: bundles keep their pods and stations, orders their
        stations, and robots their tasks. If the class of the controller changes, pools are emptied
        (for POA), or prepared tasks are dropped (for TA). If the new controller of RPS is a dummy,
        which would never release bundles, all unreleased bundles are released.
        """
        problem, new = choice.problem, choice.controller
        if type(self._controllers[problem]) is not new:
            if problem is Problem.POA:
                self._world.unqueue_all()
                for station in self._world.pick_stations:
                    for task in station.tasks.values():
                        self._events.picks_changed(self._world.now_s, task.robot)
            elif problem is Problem.TA:
                for robot in self._world.robots:
                    self._dispatch.forget_prepared(robot)
            elif problem is Problem.RPS and new.is_dummy:
                for pod in list(self._world.bundles.unreleased):
                    self._applying.release_pod(say.ReleasePod(pod))
        self._controllers.install(choice)
        self.choices[problem] = choice
        self._events.controller_exchanged(self._world.now_s, problem.value, choice.name)
        self._alarms.cancel(problem)
        self._due.connect()
        self._alarms.connect(steps.STEP_OF)
        statistics = self._deciding.statistics
        if problem in statistics:
            statistics[problem].name = choice.name
        if problem in steps.STEP_OF:
            self._alarms.overdue.add(problem)
            self._due.want(problem)

    def require_possible(self, choice: Choice) -> None:
        """Check that a controller could be installed now, without changing anything.

        Raises
        ------
        InputError
            If it is incompatible with the layout or the scenario.
        """
        self._controllers.made(choice)

    def take_over(self, problem: Problem, controller: Controller[Any]) -> None:
        """Install a given controller; from now on, no problem is decided outside the simulation."""
        self.outside.problems, self.outside.pending = frozenset(), None
        self._is_secured = False
        self._controllers.put(problem, controller)
        self._alarms.cancel(problem)
        self._due.connect()
        self._alarms.connect(steps.STEP_OF)
        self._due.want(problem)

    def exchange_controller(self, decision: say.Exchange) -> None:
        """Install the controller that MM chose."""
        self.exchange(decision.choice)

    # --- the steps --------------------------------------------------------------------------------

    def settle(self) -> bool:
        """Process the due steps; return False if a decision must be made outside the simulation."""
        outside, due, storage, what = self.outside, self._due, self._world.storage, self._steps
        if outside.pending is not None or (self._interrupted and not self._go_on()):
            return False
        while True:
            if storage.version != due.storage_version:
                due.storage_changed()
            bits = due.bits
            if not bits:
                return True
            first = bits & -bits
            due.bits = bits ^ first
            try:
                question = what[first]()
            except Awaits as awaits:
                question = awaits.question
            if question is not None:
                outside.pending, self._interrupted = question, first
                return False

    def _go_on(self) -> bool:
        """Resume the step that waited for the outside; return False if it asks again."""
        step, self._interrupted = self._interrupted, 0
        try:
            if self._starting is not None or self._half_told:
                self._finish()
            question = self._steps[step]()
        except Awaits as awaits:
            question = awaits.question
        if question is not None:
            self.outside.pending, self._interrupted = question, step
        return self.outside.pending is None

    def _what_is_done(self) -> dict[int, Callable[[], Question | None]]:
        """Return the action of each step, by its bit."""
        asked = {step: partial(self._ask, problem) for step, problem in steps.PROBLEM_OF.items()}
        done: dict[int, Callable[[], Question | None]] = {
            **asked,
            steps.ANSWERS: self._take_answers,
            steps.MANAGE: partial(self._ask, Problem.MM),
            steps.ARRIVALS: self._arrivals.top_up,
            steps.LATE_BINDING: self._late_binding.bind,
            steps.TASKS: self._give_tasks,
        }
        return {1 << step: what for step, what in done.items()}

    def _ask(self, problem: Problem) -> Question | None:
        """Ask the controller of a problem; return a question if the outside decides."""
        if problem is Problem.CA and self._guard is None:
            return None  # robots have as much energy as they need
        if problem in self.outside.problems and problem not in ASKED_BY_TA:
            return Question(problem, "turn")
        self._deciding.ask(problem, self._controllers.installed[problem].decide())
        return None

    def _give_tasks(self) -> Question | None:
        """Start prepared tasks, then ask TA, with which repositioning is asked as well.

        If the outside decides TA, the question is returned.
        """
        world, outside = self._world, self.outside
        if outside.doing is not None:
            self.do_outside()
            return Question(Problem.TA, "turn")
        if not self._is_secured:
            if self._guard is not None:
                self._guard.secure(self._consult)
                outside.begin_attempt()
            if self._visits.controllers:
                self._visits.give()
            self._is_secured = bool(outside.problems)
        outside.taken = 0  # all that was answered in this attempt is asked again, in its order
        if world.asking or outside.problems:
            self._start_prepared()
        rule = self._controllers.installed[Problem.TA]
        orders_too = Problem.POA in rule.decides
        overdue = Problem.TA in self._alarms.overdue
        if world.asking or world.resting or orders_too or overdue:
            if Problem.TA in outside.problems:
                if outside.is_idle is None or not outside.is_idle(self._view):
                    return Question(Problem.TA, "turn")
                self.end_turn(Problem.TA)
                return None
            if outside.problems & ASKED_BY_TA:
                self._deciding.ask_between_answers(
                    Problem.TA, lambda: rule.decide(self._consult), outside, self._rule_state
                )
            else:
                self._deciding.ask(Problem.TA, rule.decide(self._consult))
        self._tasks_given()
        return None

    def _tasks_given(self) -> None:
        self._is_secured = False
        alarms = self._alarms
        if alarms.overdue or Problem.REPOSITIONING in alarms.punctual:
            alarms.asked(Problem.REPOSITIONING)

    def _start_prepared(self) -> None:
        world = self._world
        robots = [robot for robot in world.asking.values() if robot.prepared]
        if self.outside.problems:
            # one at rest has prepared tasks if somebody had to be asked about the first
            robots += [robot for robot in world.resting.values() if robot.prepared]
        for robot in robots:
            self._dispatch.start_prepared(robot, self._consult)
            self.outside.drop_taken()

    def prepare(self, decision: say.Prepare, call: Call | None) -> None:
        """Record tasks that a robot is to do later; if it is free, start the first possible one."""
        robot = decision.robot
        rule = self._controllers[Problem.TA]
        self._dispatch.prepare(decision, call)
        if rule.optimisers and call is None:
            self._deciding.decided(Problem.TA, call)
        if robot.task is None or robot.index in self._world.resting:
            self._starting = robot  # it may have to wait for the outside
            self._dispatch.start_prepared(robot, self._consult)
            self._starting = None

    # --- answers of optimisers ------------------------------------------------------------------

    def came(self, call: Call) -> None:
        """Record an answer; the decision phase of this instant passes it to the controller."""
        self._answers.append(call)
        self._due.want_answers()

    def _take_answers(self) -> None:
        self._answers.sort(key=lambda call: call.number)
        while self._answers:
            self.tell(self._answers.pop(0))

    def tell(self, call: Call) -> None:
        """Pass an answer to the controller that asked, and apply its decisions."""
        call.controller.in_flight -= 1
        call.take_effect(self._agenda.now_us)
        self._carry_out(call)

    def _carry_out(self, call: Call) -> None:
        """Apply the decisions based on an answer, or on the rest of it."""
        problem, controller = call.problem, call.controller
        if self._controllers[problem] is not controller:
            call.outcome = Outcome.ABANDONED
        elif problem is Problem.TA and self.outside.problems & ASKED_BY_TA:
            try:
                self._deciding.ask_between_answers(
                    problem, lambda: controller.answered(call), self.outside, self._rule_state, call
                )
            except Awaits:
                self._half_told.append(call)
                raise
        else:
            self._deciding.ask(problem, controller.answered(call), call)
        self._events.optimiser_answered(call)
        call.forget()

    def _finish(self) -> None:
        """Finish what waited for the outside, before the interrupted step is resumed."""
        outside = self.outside
        if self._starting is not None:
            outside.taken = 0
            self._dispatch.start_prepared(self._starting, self._consult)
            self._starting = None
            outside.drop_taken()
        # an answer may have come while another was carried out: the innermost is the first
        waiting, self._half_told = self._half_told, []
        for number, call in enumerate(waiting):
            try:
                self._carry_out(call)
            except Awaits:
                self._half_told += waiting[number + 1 :]
                raise

    # --- turns of the outside ---------------------------------------------------------------------

    def take(self, decision: Any) -> None:
        """Apply a decision made outside the simulation.

        If the decision leaves choices open, PPS, PSA or repositioning makes them.

        Raises
        ------
        Awaits
            If such a choice must be made outside the simulation as well; `do_outside` applies the
            decision once the choice has been made.
        """
        self.outside.doing = decision
        self.outside.begin_attempt()
        self.do_outside()

    def do_outside(self) -> None:
        """Apply the decision `outside.doing`, or add it to `outside.refused` if it fails."""
        outside, decision = self.outside, self.outside.doing
        outside.taken = 0
        match decision:
            case say.WorkFor():
                whole: Any = errands.work(decision, self._view, self._consult)
            case say.Store():
                whole = errands.store(decision, self._consult)
            case say.MovePod():
                whole = errands.move_pod(decision, self._view, self._consult)
            case _:
                whole = decision
        if whole is None:
            outside.refused.append(decision)
        else:
            self._applying(whole, None)
            outside.decided += 1
        outside.doing = None
        outside.begin_attempt()

    def end_turn(self, problem: Problem) -> None:
        """End a turn of decisions made outside the simulation; the phase can then continue."""
        outside = self.outside
        outside.pending = outside.advisor = outside.advised = None
        decided, outside.decided = outside.decided, 0
        self._deciding.record(problem, 0, decided, decided)
        self._interrupted = 0
        outside.refused.clear()
        self._alarms.asked(problem)
        if problem is Problem.TA:
            self._tasks_given()
