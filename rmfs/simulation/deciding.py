"""Calls of controllers: decisions are applied one by one, counted and timed."""

from __future__ import annotations

from time import perf_counter_ns
from typing import TYPE_CHECKING, Any

from rmfs.control.asks import Ask, By, told_by
from rmfs.control.legality import reason, why_not
from rmfs.control.problems import Problem
from rmfs.errors import RuleError
from rmfs.simulation.outside import Awaits
from rmfs.simulation.statistics import DecisionStatistics

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from rmfs.control.asks import Call
    from rmfs.control.base import Controller
    from rmfs.control.choices import Choice
    from rmfs.control.questions import Question
    from rmfs.simulation.alarms import Alarms
    from rmfs.simulation.controller_set import ControllerSet
    from rmfs.simulation.events import Events
    from rmfs.simulation.optimisers import OptimiserGateway
    from rmfs.simulation.outside import Outside
    from rmfs.simulation.rule_state import RuleState
    from rmfs.world import World

_WRONG = (AttributeError, LookupError, TypeError, ValueError)
"""Errors caused by decisions that the world cannot carry out."""

LONGEST = 200
"""Maximum number of characters of a decision shown in an error message."""


class Deciding:
    """Asks controllers for decisions, applies the decisions, and keeps statistics of them.

    Attributes
    ----------
    statistics
        Statistics by decision problem; path planning (PP) has none.
    """

    def __init__(
        self,
        world: World,
        events: Events,
        controllers: ControllerSet,
        alarms: Alarms,
        choices: Mapping[Problem, Choice],
    ) -> None:
        self._world = world
        self._events = events
        self._controllers = controllers.installed
        self._alarms = alarms
        self._apply: Callable[[Any, Call | None], None]
        self._optimisers: OptimiserGateway
        self._nested_ns = 0
        self._unfinished: dict[int, tuple[int, int, int]] = {}
        self.statistics: dict[Problem, DecisionStatistics] = {
            problem: DecisionStatistics(str(problem), choice.name)
            for problem, choice in choices.items()
            if problem is not Problem.PP
        }

    def connect(
        self, apply: Callable[[Any, Call | None], None], optimisers: OptimiserGateway
    ) -> None:
        """Set the function that applies decisions, and the gateway to optimisers."""
        self._apply, self._optimisers = apply, optimisers

    def ask(self, problem: Problem, given: Iterable[Any], answer: Call | None = None) -> None:
        """Apply decisions one by one, and measure the time spent on making them.

        Calls of this method can be nested: an optimiser may answer while the controller that asked
        it is still deciding.

        Parameters
        ----------
        given
            Iterable of decisions; the controller makes each decision when the next element is taken
            from the iterable.
        answer
            The call to an optimiser on whose answer the decisions are based; None if there is none.

        Raises
        ------
        RuleError
            If a user's rule makes an impossible decision, or any rule returns None instead of an
            iterable.
        """
        apply, controller = self._apply, self._controllers[problem]
        asks_optimisers = bool(controller.optimisers)
        if given is None:
            raise RuleError(
                f"{self._whose(problem, controller)}: decide must return decisions, not None"
            )
        nested_ns, self._nested_ns = self._nested_ns, 0
        count = by_rule = spent_ns = 0
        decision = None
        start = perf_counter_ns()
        try:
            for told in given:
                spent_ns += perf_counter_ns() - start
                if type(told) is By:
                    decision, call = told
                else:
                    decision, call = told, answer
                if type(decision) is Ask:
                    self._optimisers.ask(problem, controller, decision)
                else:
                    try:
                        apply(decision, call)
                    except _WRONG as error:
                        self._refuse(problem, controller, decision, error)
                        raise
                    count += 1
                    if asks_optimisers and controller.is_modelled(decision):
                        self.decided(problem, call)
                    by_rule += call is None
                start = perf_counter_ns()
        except (Awaits, RuleError):
            raise
        except Exception as error:
            self._blame(error, problem, decision)
            raise
        spent_ns += perf_counter_ns() - start - self._nested_ns
        self._nested_ns = nested_ns
        self.record(problem, spent_ns, count, by_rule)
        alarms = self._alarms
        if alarms.overdue or problem in alarms.punctual:
            alarms.asked(problem)

    def _blame(self, error: Exception, problem: Problem, last: Any) -> None:
        """Add a note to an error: which controller was deciding (the innermost if nested)."""
        if not getattr(error, "__notes__", ()):
            controller = self._controllers[problem]
            error.add_note(
                f"{problem} {self.statistics[problem].name} ({type(controller).__name__}) at "
                f"{self._world.now_s:.3f} s; its last decision there: {last!r:.200}"
            )

    def ask_between_answers(
        self,
        problem: Problem,
        decide: Callable[[], Iterable[Any]],
        outside: Outside,
        state: RuleState,
        answer: Call | None = None,
    ) -> None:
        """Apply decisions one by one, like `ask`, for a rule that may have to wait for an answer.

        While it decides, the rule may ask about a problem that is decided outside the simulation.
        Until this question is answered, the rule cannot continue.

        Parameters
        ----------
        decide
            Function that asks the rule for decisions, or passes the answer of an optimiser to the
            rule.
        outside
            Contains the answers to the rule's earlier questions.
        state
            Saves and restores the state of the rule.
        answer
            The call whose answer is passed to the rule; None if the rule is asked for decisions.

        Raises
        ------
        Awaits
            If a question must first be answered outside the simulation. The rule is then in the
            state that it had after its last decision; once the question is answered, this method
            must be called again.
        """
        controller = self._controllers[problem]
        which = -1 if answer is None else answer.number
        count, by_rule, spent_ns = self._unfinished.pop(which, (0, 0, 0))
        nested_ns, self._nested_ns = self._nested_ns, 0
        start = perf_counter_ns()
        kept = state.keep(controller, answer)
        follows = False
        outside.taken = 0
        try:
            for told in decide():
                decision, call = told_by(told, answer)
                outside.begin_attempt()
                follows = True
                if type(decision) is Ask:
                    self._optimisers.ask(problem, controller, decision)
                else:
                    count += 1
                    by_rule += call is None
                    self._apply(decision, call)
                    if controller.optimisers and controller.is_modelled(decision):
                        self.decided(problem, call)
                outside.begin_attempt()
                kept, follows = state.keep(controller, answer), False
        except Awaits:
            # who asks may be what follows from a decision: an answer that is carried out at once,
            # or the start of what was prepared; the decision is taken then
            if not follows:
                state.restore(controller, kept)
            self._unfinished[which] = count, by_rule, spent_ns
            self._nested_ns = nested_ns
            raise
        spent_ns += perf_counter_ns() - start - self._nested_ns
        self._nested_ns = nested_ns
        outside.begin_attempt()
        self.record(problem, spent_ns, count, by_rule)
        self._alarms.asked(problem)

    def _refuse(
        self, problem: Problem, controller: Controller[Any], decision: Any, error: Exception
    ) -> None:
        """Raise an error that describes an impossible decision, if a user's rule made it.

        If a rule of rmfs made it, which is a defect, the caller raises the original error.

        Raises
        ------
        RuleError
            If the rule is not part of rmfs.
        """
        if not is_foreign(controller):
            return
        try:
            why = reason(decision, controller.view)
        except Exception:  # so wrong that nobody can say why
            why = ""
        raise RuleError(
            f"{self._whose(problem, controller)}: {_short(decision)} is impossible: {why or error}"
        ) from error

    def require_possible(self, controller: Controller[Any], given: Any, question: Question) -> None:
        """Raise an error if a user's rule gives an impossible answer to TA.

        Raises
        ------
        RuleError
            If the answer is impossible; the message states the decision problem, rule, simulated
            time, answer, and why it is impossible.
        """
        why = why_not(given, question, controller.view)
        if why:
            problem = question.problem
            raise RuleError(
                f"{self._whose(problem, controller)}: {question.kind} {_short(given)} is "
                f"impossible: {why}"
            )

    def _whose(self, problem: Problem, controller: Controller[Any]) -> str:
        return f"{problem} {type(controller).__qualname__} at {self._world.now_s:.3f} s"

    def consulted(
        self,
        problem: Problem,
        controller: Controller[Any],
        wall_ns: int,
        decided: bool,
        call: Call | None = None,
        modelled: bool = True,
    ) -> None:
        """Record that TA asked another controller.

        Parameters
        ----------
        wall_ns
            Wall time that this controller took, in nanoseconds; it is not counted as time of TA.
        decided
            Whether the controller decided anything.
        call
            The call to an optimiser on whose answer the decision is based; None if the controller's
            own rule decided.
        modelled
            Whether optimisers can make this kind of decision. If so, a decision of the controller's
            own rule is counted as one that the rule made in place of an optimiser.
        """
        self._nested_ns += wall_ns
        self.record(problem, wall_ns, int(decided), int(decided and call is None))
        if decided and controller.optimisers and (modelled or call is not None):
            self.decided(problem, call)

    def decided(self, problem: Problem, call: Call | None) -> None:
        """Count a decision of a controller that uses optimisers.

        The decision is counted for `call` or, if `call` is None, for the controller's own rule.
        """
        if call is None:
            self._events.rule_decided(problem.value, self._world.now_s)
        else:
            call.count()

    def record(self, problem: Problem, wall_ns: int, count: int, by_rule: int) -> None:
        """Record a call of a controller.

        Parameters
        ----------
        wall_ns
            Wall time of the call in nanoseconds.
        count
            Number of decisions made in the call.
        by_rule
            Number of these decisions that are not based on an optimiser's answer. The others are
            counted elsewhere, in the `Call` to the optimiser.
        """
        now_s, statistics = self._world.now_s, self.statistics[problem]
        statistics.wall_ns.append(wall_ns)
        if count:
            statistics.count(count, now_s)
        self._events.decision(statistics.problem, now_s, wall_ns / 1e9, by_rule)


def is_foreign(controller: Controller[Any]) -> bool:
    """Return whether a controller is a user's own, that is, not part of rmfs."""
    return type(controller).__module__.partition(".")[0] != "rmfs"


def _short(decision: Any) -> str:
    """Return a decision in one line: orders, bundles and the like by their index."""
    fields = getattr(decision, "_fields", None)
    if fields is None:
        text = " ".join(repr(decision).split())
    else:
        told = (f"{name}={_named(value)}" for name, value in zip(fields, decision, strict=True))
        text = f"{type(decision).__name__}({', '.join(told)})"
    return text if len(text) <= LONGEST else f"{text[:LONGEST]}..."


def _named(value: Any) -> str:
    index = getattr(value, "index", None)
    return str(index) if isinstance(index, int) else repr(value)
