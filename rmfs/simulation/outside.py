"""Decisions made outside the simulation: pending questions, and how a run waits for answers.

While a run waits for an answer, no generator of a controller is suspended: everything that the run
needs to continue is data, so the run can be copied and saved.

A question asked by the decision phase itself is a *turn*: the program outside the simulation makes
one decision after another, and finally declines to make a further one. A question that a TA rule
asks while it decides interrupts the rule (`Awaits`). When the program has answered, the rule is
restored to its state after its last decision and is asked for decisions again; the answers to its
questions since that decision are stored, and it receives them as it repeats the questions. If a
rule was interrupted while it carried out the answer of an optimiser, it continues with the rest of
that answer.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from rmfs.control.problems import Problem
from rmfs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from rmfs.control.choices import Choice
    from rmfs.control.questions import Question
    from rmfs.control.view import View

ASKED_BY_TA = frozenset({Problem.PPS, Problem.PSA, Problem.REPOSITIONING})
"""Problems that are decided when TA asks."""


def problems_outside(names: Iterable[str], choices: Mapping[Problem, Choice]) -> frozenset[Problem]:
    """Return the named problems, after checking that they can be decided outside the simulation.

    Raises
    ------
    InputError
        If one of them does not exist, or cannot be decided outside the simulation with these
        controllers.
    """
    valid = [str(problem) for problem in Problem if problem is not Problem.PP]
    for name in names:
        if name not in valid:
            raise InputError(
                f"outside {name}: this problem cannot be decided outside; valid: "
                f"{', '.join(valid)} (for path planners see docs/write-a-planner.md)"
            )
    problems = frozenset(Problem(name) for name in names)
    for problem in sorted(problems):
        choice = choices[problem]
        if choice.controller.is_dummy:
            taker = next(c for c in choices.values() if problem in c.controller.decides)
            raise InputError(
                f"outside {problem}: {taker.problem} {taker.name} also decides {problem}; choose "
                f"another rule for {taker.problem}, or decide {taker.problem} outside"
            )
    task_rule = choices[Problem.TA]
    rule = task_rule.controller
    if problems & ASKED_BY_TA and rule.optimisers and not rule.goes_on:
        raise InputError(
            f"outside {', '.join(sorted(problems & ASKED_BY_TA))}: ta {task_rule.name} needs these "
            "decisions while it carries out the answer of an optimiser, but does not declare that "
            "it can continue after an interruption (goes_on); choose another rule for TA, or "
            "decide TA outside"
        )
    return problems


class Awaits(BaseException):
    """A question must be answered outside the simulation before the decision phase can go on."""

    @property
    def question(self) -> Question:
        """The question."""
        question: Question = self.args[0]
        return question


@dataclass
class Outside:
    """The problems decided outside the simulation, and the pending question.

    Attributes
    ----------
    problems
        The problems decided outside.
    pending
        The question waiting for an answer.
    given
        Questions of TA that have been answered since its last decision, each with the answer.
    taken
        Number of these answers that TA has received since it was last asked for decisions.
    decided
        Number of decisions in the current turn so far.
    doing
        A decision of TA, made outside, that leaves a choice to PPS, PSA or repositioning; it is
        applied when that choice has been made.
    refused
        Decisions of the current turn that failed because no pod, place or move was found.
    is_idle
        Whether a turn of TA is to be ended without asking, because there would be nothing to
        decide; by default, TA is always asked.
    advisor
        Iterator over the decisions that the installed rule would make in the current turn.
    advised
        The installed rule's advice on the pending question, in a tuple; None if it has not been
        asked for.
    """

    problems: frozenset[Problem] = frozenset()
    pending: Question | None = None
    given: list[tuple[Question, Any]] = field(default_factory=list)
    taken: int = 0
    decided: int = 0
    doing: Any = None
    refused: list[Any] = field(default_factory=list)
    is_idle: Callable[[View], bool] | None = None
    advisor: Iterator[Any] | None = None
    advised: Any = None

    def __getstate__(self) -> dict[str, Any]:
        """Omit the advising rule, whose generator cannot be copied."""
        return self.__dict__ | {"advisor": None, "advised": None}

    def knows(self, question: Question) -> bool:
        """Whether the next answer in `given` belongs to this question of TA."""
        return self.taken < len(self.given) and self.given[self.taken][0] == question

    def drop_taken(self) -> None:
        """Drop the answers received so far: they concern prepared tasks, which do not ask again."""
        del self.given[: self.taken]
        self.taken = 0

    def begin_attempt(self) -> None:
        """Forget all answers, since they do not apply to the next decision of TA."""
        if self.given:
            self.given.clear()
        self.taken = 0

    def answer_to(self, question: Question, otherwise: Callable[[], Any]) -> Any:
        """Return the answer to a question of TA.

        Parameters
        ----------
        otherwise
            Function that asks the installed controller; called if the question's problem is not
            decided outside. The controller's answer is stored like an answer from outside, so that
            the controller is not asked again when the TA rule repeats the question.

        Raises
        ------
        Awaits
            If the question must first be answered outside the simulation.
        """
        if self.knows(question):
            answer = self.given[self.taken][1]
            self.taken += 1
            return answer
        # the rule was at another place when it asked: after a decision of its own it had gone on
        # with what it knew before, and now looks at all robots again
        del self.given[self.taken :]
        if question.problem in self.problems:
            raise Awaits(question)
        answer = otherwise()
        self.given.append((question, answer))
        self.taken += 1
        return answer
