"""Decisions that somebody outside takes: what is asked, and how a run waits for the answer.

A run that waits holds no frame of a controller: all it needs to go on is data, so that it can be
copied and stored while it waits. A problem that the phase itself asks about is a *turn*: one
decision after the other, until the outside declines. A question that a rule for TA asks in the
middle of its own work ends that work (`Awaits`); when the answer is there, the rule is set back to
where it was after its last decision, asked again, and given the answers since then in their order.
So is a rule that is carrying out the answer of an optimiser: it goes on with what is left of it.
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

ASKED_BY_TA = frozenset({Problem.PPS, Problem.PSA, Problem.REPOSITIONING})
"""Problems that are decided when TA asks."""


def problems_outside(names: Iterable[str], choices: Mapping[Problem, Choice]) -> frozenset[Problem]:
    """Return the problems of these names, if they can be decided outside.

    Raises
    ------
    InputError
        If there is no such problem, or it cannot be decided outside with these controllers.
    """
    valid = [str(problem) for problem in Problem if problem is not Problem.PP]
    for name in names:
        if name not in valid:
            raise InputError(
                f"outside {name}: no problem that can be decided outside; valid: "
                f"{', '.join(valid)} (a path planner is written as docs/write-a-planner.md says)"
            )
    problems = frozenset(Problem(name) for name in names)
    for problem in sorted(problems):
        choice = choices[problem]
        if choice.controller.is_dummy:
            taker = next(c for c in choices.values() if problem in c.controller.decides)
            raise InputError(
                f"outside {problem}: {taker.problem} {taker.name} decides {problem} as well; "
                f"choose another rule for {taker.problem}, or decide that outside"
            )
    task_rule = choices[Problem.TA]
    rule = task_rule.controller
    if problems & ASKED_BY_TA and rule.optimisers and not rule.goes_on:
        raise InputError(
            f"outside {', '.join(sorted(problems & ASKED_BY_TA))}: ta {task_rule.name} asks these "
            "questions while it carries out the answer of an optimiser, and does not say that it "
            "can go on after one (goes_on); choose another rule for TA, or decide TA outside"
        )
    return problems


class Awaits(BaseException):
    """A question for the outside came up in the middle of a controller's work."""

    def __init__(self, question: Question) -> None:
        super().__init__(question)
        self.question = question


@dataclass
class Outside:
    """Which problems are decided outside, and what is pending.

    Attributes
    ----------
    problems
        Decided outside.
    pending
        The question that waits for an answer.
    given
        Answers to the questions of the present attempt of TA's rule, with the questions.
    taken
        How many of them the attempt has used.
    decided
        Decisions so far in the present turn.
    doing
        A decision of TA that is applied when PPS, PSA or repositioning have been answered.
    refused
        Decisions of the present turn that came to nothing: no pod, or no place, was found.
    advisor, advised
        The rule at work as an adviser, and its last advice.
    """

    problems: frozenset[Problem] = frozenset()
    pending: Question | None = None
    given: list[tuple[Question, Any]] = field(default_factory=list)
    taken: int = 0
    decided: int = 0
    doing: Any = None
    refused: list[Any] = field(default_factory=list)
    advisor: Iterator[Any] | None = None
    advised: Any = None

    def __getstate__(self) -> dict[str, Any]:
        """Leave out a rule at work as an adviser: its frames cannot be copied."""
        return self.__dict__ | {"advisor": None, "advised": None}

    def knows(self, question: Question) -> bool:
        """Whether the next answer that was given is the one to this question of TA's rule."""
        return self.taken < len(self.given) and self.given[self.taken][0] == question

    def drop_taken(self) -> None:
        """What was asked about tasks prepared ahead is not asked again by TA's rule."""
        del self.given[: self.taken]
        self.taken = 0

    def begin_attempt(self) -> None:
        """A rule for TA begins, or goes on after a decision of its own was applied."""
        if self.given:
            self.given.clear()
        self.taken = 0

    def answer_to(self, question: Question, otherwise: Callable[[], Any]) -> Any:
        """Return the answer to a question of TA's rule.

        Parameters
        ----------
        otherwise
            Asks the controller inside; its answer is kept as well, so that it is not asked twice.

        Raises
        ------
        Awaits
            If the outside has to answer first.
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
