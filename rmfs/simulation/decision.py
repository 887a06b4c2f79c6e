"""A decision made outside the simulation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

from rmfs.control.asks import Ask, told_by
from rmfs.control.candidates import candidates_for
from rmfs.control.legality import why_not
from rmfs.simulation.outside import Awaits

if TYPE_CHECKING:
    from rmfs.control.candidates import Candidates
    from rmfs.control.questions import Question
    from rmfs.control.view import View
    from rmfs.simulation.advice import Advice
    from rmfs.simulation.controller_set import ControllerSet
    from rmfs.simulation.deciding import Deciding
    from rmfs.simulation.phase import DecisionPhase
    from rmfs.world.robots import Robot


class ImpossibleError(ValueError):
    """An answer is impossible, or its question has already been answered; the message says why."""


def is_same(answer: Any, other: Any) -> bool:
    """Return whether two answers have the same type and are equal."""
    return answer is other or (type(answer) is type(other) and bool(answer == other))


class Asking(Protocol):
    """The parts of a simulation that a `Decision` needs."""

    @property
    def view(self) -> View:
        """The world as controllers see it."""
        ...

    @property
    def phase(self) -> DecisionPhase:
        """The decision phase in which the question is pending."""
        ...

    @property
    def advice(self) -> Advice:
        """What the installed rules would decide."""
        ...

    @property
    def deciding(self) -> Deciding:
        """The part of the simulation that keeps statistics of decisions."""
        ...

    @property
    def controller_set(self) -> ControllerSet:
        """The installed controllers, whose rules can give advice."""
        ...


class Decision:
    """One decision to be made outside the simulation: a question, with methods to answer it.

    For POA, ROA, RPS, SA, MM, CA and TA, a question is a *turn*, in which any number of decisions
    (see `rmfs.control.decisions`) can be made: call `answer` for each of them, which applies it
    immediately, and then `decline` to end the turn. A question about PPS, PSA or repositioning
    comes up while TA decides, and has a single answer: a pod, a station, a storage location, or a
    `Move`.

    Attributes
    ----------
    problem
        The decision problem.
    kind
        `turn`, or what TA asks for: `pick pod`, `replenishment pod`, `next station`, `place` or
        `move`.
    view
        The world as controllers see it. It must not be changed.
    """

    def __init__(self, question: Question, simulation: Asking) -> None:
        self._question = question
        self._simulation = simulation
        self._candidates: Candidates | None = None
        self.problem = question.problem
        self.kind = question.kind
        self.view: View = simulation.view

    def __repr__(self) -> str:
        about = "" if self.robot is None else f", robot {self.robot.index}"
        return f"<{self.problem} {self.kind} at {self.now_s:.3f} s{about}>"

    @property
    def now_s(self) -> float:
        """Simulated time of the decision, in s."""
        return self.view.now_s

    @property
    def robot(self) -> Robot | None:
        """The robot for which TA asks; None in a turn."""
        number = self._question.robot
        return None if number < 0 else self.view.robots[number]

    @property
    def stations(self) -> tuple[int, ...]:
        """The station that needs a pod, or the possible next stations; empty in other cases."""
        return self._question.stations

    @property
    def is_open(self) -> bool:
        """Whether the question still needs an answer."""
        return self._simulation.phase.outside.pending is self._question

    @property
    def candidates(self) -> Candidates:
        """The options, with the attributes that rules compare."""
        if self._candidates is None:
            self._candidates = candidates_for(
                self.view, self._question, self._simulation.phase.outside.refused
            )
        return self._candidates

    def answer(self, given: Any) -> None:
        """Answer the question.

        Parameters
        ----------
        given
            In a turn, a decision of `rmfs.control.decisions`. Otherwise the number of a pod,
            station or waypoint, or a `Move`. A row of `candidates` is always valid:
            `decision.answer(decision.candidates[3])`.

        Raises
        ------
        ImpossibleError
            If the question has already been answered, or the answer is impossible; the message says
            why. An impossible answer changes nothing, and the question remains open.
        """
        self._refuse_answered()
        reason = why_not(given, self._question, self.view)
        if reason:
            raise ImpossibleError(f"{self!r}: {given!r} is impossible: {reason}")
        self._apply(given)

    def choose(self, row: int) -> None:
        """Answer with a row of `candidates`, given by its number, without the checks of `answer`.

        Rows are counted from 0. A negative number is refused, although Python would count it from
        the end: an agent may use -1 for no choice.

        Raises
        ------
        ImpossibleError
            If the question has already been answered.
        IndexError
            If there is no such row.
        """
        self._refuse_answered()
        if row < 0:
            raise IndexError(f"row {row}: must be 0 or more; to choose none, use decline()")
        self._apply(self.candidates[row])

    def decline(self) -> None:
        """Make no further decision: end a turn, or answer TA that no option is chosen.

        Raises
        ------
        ImpossibleError
            If the question has already been answered, or is of the kind `next station`, for which a
            station must be chosen.
        """
        self._refuse_answered()
        if self.kind == "next station":
            raise ImpossibleError(f"{self!r}: one of the stations {self.stations} must be chosen")
        if self.kind == "turn":
            self._simulation.phase.end_turn(self.problem)
        else:
            self._reply(None if self.kind == "move" else -1, decided=False)

    def advice(self) -> Any:
        """Return what the installed rule of the problem would answer; None if it would decline.

        Rules assume that their decisions are carried out. Therefore, either follow all advice of a
        rule in the run, or none. Advice uses up random numbers of the rule, as a decision does.

        Raises
        ------
        ImpossibleError
            If the question has already been answered.
        NotImplementedError
            If the rule would ask an optimiser.
        """
        self._refuse_answered()
        outside = self._simulation.phase.outside
        if outside.advised is None:
            outside.advised = (self._advised(),)
        return outside.advised[0]

    # --- inside ---------------------------------------------------------------------------------

    def _advised(self) -> Any:
        simulation = self._simulation
        outside, rule = simulation.phase.outside, simulation.controller_set[self.problem]
        if self.kind != "turn":
            found = simulation.advice.on(self._question)
            return None if isinstance(found, int) and found < 0 else found
        if outside.advisor is None:
            outside.advisor = simulation.advice.in_turn(self.problem)
        decision, _ = told_by(next(outside.advisor, None), None)
        if isinstance(decision, Ask):
            raise NotImplementedError(f"{self.problem} {type(rule).__name__} asks an optimiser")
        return decision

    def _apply(self, given: Any) -> None:
        """Carry out the answer."""
        self._candidates = None
        if self.kind == "turn":
            self._take(given)
        else:
            self._reply(given, decided=True)

    def _take(self, given: Any) -> None:
        """Apply a decision of a turn; the turn goes on."""
        simulation = self._simulation
        outside = simulation.phase.outside
        if outside.advised is None or not is_same(outside.advised[0], given):
            outside.advisor = None  # the rule goes on only if its decision was carried out
        outside.advised = None
        try:
            simulation.phase.take(given)
        except Awaits as awaits:
            outside.pending = awaits.question

    def _reply(self, given: Any, *, decided: bool) -> None:
        """Let TA go on with the answer."""
        simulation = self._simulation
        outside = simulation.phase.outside
        outside.given.append((self._question, given))
        outside.pending = outside.advised = None
        rule = simulation.controller_set[self.problem]
        simulation.deciding.consulted(self.problem, rule, 0, decided)

    def _refuse_answered(self) -> None:
        if not self.is_open:
            raise ImpossibleError(f"{self!r} has already been answered")
