"""Decisions made outside the simulation: pending questions, and how a run waits for answers.

The answers come from a program outside the simulation. While a run waits for an answer, none of its
controllers has a suspended generator. The run is therefore plain data, which can be copied and
saved.

A question asked by the decision phase itself is a *turn*: the program makes one decision after
another, and finally declines to make a further one.

A question that a TA rule asks while it decides interrupts the rule (`Awaits`). The program's answer
is stored. The rule is then reset to its state after its last decision, and asked for decisions
again. It repeats the questions that it has asked since that decision, and receives the stored
answers. A rule that was interrupted while it carried out the answer of an optimiser continues with
the rest of that answer.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from rmfs.control.problems import Problem
from rmfs.control.turns import Turn
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
        If a problem does not exist, or cannot be decided outside the simulation with these
        controllers.
    """
    valid = [str(problem) for problem in Problem if problem is not Problem.PP]
    if isinstance(names, str):
        raise InputError(f'outside {names}: must be a list of problems, such as ["{names}"]')
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
    """A question must be answered outside the simulation before the decision phase can continue."""

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
        Questions that TA has asked since its last decision and that have been answered, each with
        the answer.
    taken
        Number of answers in `given` that TA has received since it was last asked for decisions.
    decided
        Number of decisions in the current turn so far.
    doing
        A TA decision, made outside, that leaves a choice to PPS, PSA or repositioning; the decision
        is applied when this choice has been made.
    refused
        Decisions of the current turn that failed because no pod, storage location or move was
        found.
    is_idle
        Function of the view that returns whether TA has nothing to decide; if so, the turn of TA is
        ended without a question. Default: none, so that a question is asked in every turn of TA.
    advisor
        Iterator over the decisions that the installed rule would make in the current turn. In a
        copy of the run, the rule is asked anew unless the iterator is a `rmfs.control.turns.Turn`.
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
        """Omit the advisor if it is a generator, which cannot be copied."""
        return self.__dict__ | {"advisor": self.advisor if isinstance(self.advisor, Turn) else None}

    def knows(self, question: Question) -> bool:
        """Whether the next answer in `given` is the answer to this question of TA."""
        return self.taken < len(self.given) and self.given[self.taken][0] == question

    def drop_taken(self) -> None:
        """Remove from `given` the answers that were used to start prepared tasks."""
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
