"""Questions to optimisers, their answers, and a record of each call."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from math import isfinite, isnan, nan
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, Protocol, TypeVar

from numpy.typing import NDArray

if TYPE_CHECKING:
    from rmfs.control.problems import Problem

Q = TypeVar("Q")
D = TypeVar("D")

BOUND_TOLERANCE = 1e-6
"""Largest accepted excess of a bound over the objective z, relative to ``max(1, |z|)``.

Rounding can cause such an excess.
"""

Plain = NDArray[Any] | int | float | str | bool | Sequence["Plain"]
"""A value in a solution. Solutions are sent between processes, recorded and replayed."""


@dataclass(frozen=True, eq=False)
class Answer:
    """The answer of an optimiser to a question.

    Attributes
    ----------
    solution
        Values by name; None if there is no solution or none was found in time.
    objective
        Cost of the solution; inf if it is unknown. Without a solution, inf or nan.
    bound
        Proven lower bound on the cost of any solution; nan or -inf if it is unknown.
    status
        Final status, as the solver names it.
    backend
        Name of the back end.
    work
        Effort of the solver, in a unit of the back end; always the same for the same question.
    wall_s, build_s
        Total wall time, and the part of it that was spent building the solver's model.
    built
        Size of the solver's model (nonzeros). With the pacing `work`, the simulated time that the
        answer takes is computed from `work` and `built`.
    scale
        The amount by which `gap_abs` is divided to give the relative gap `gap`, for example the
        cost of the pods called; in the unit of the objective. Default (nan): the absolute value of
        the objective, which is unsuitable if gains and costs cancel out.
    found
        All values that the optimiser found, for users who export questions and answers. The run
        folder contains only `solution`, the part that the controller needs.

    Raises
    ------
    TypeError
        If the solution is neither a mapping nor None, or a cost, time or size is not a number.
    ValueError
        If `work`, `built`, `wall_s` or `build_s` is negative or not finite, if the objective of a
        solution is nan, or if the bound exceeds the objective by more than `BOUND_TOLERANCE`.
    """

    solution: Mapping[str, Plain] | None
    objective: float
    bound: float
    status: str
    backend: str
    work: float = 0.0
    wall_s: float = 0.0
    build_s: float = 0.0
    built: float = 0.0
    scale: float = nan
    found: Any = None

    def __post_init__(self) -> None:
        if self.solution is not None and not isinstance(self.solution, Mapping):
            kind = type(self.solution).__name__
            raise TypeError(f"solution must map names to values, or be None; it is a {kind}")
        for name in ("work", "built", "wall_s", "build_s"):
            value = getattr(self, name)
            if not (isfinite(value) and value >= 0.0):
                raise ValueError(f"{name} must be a finite number, 0 or more; it is {value}")
        if self.solution is not None and isnan(self.objective):
            raise ValueError("objective must be a number, or inf if it is unknown; it is nan")
        slack = BOUND_TOLERANCE * max(1.0, abs(self.objective))
        if self.solution is not None and self.bound - self.objective > slack:
            raise ValueError(
                f"bound {self.bound} exceeds the objective {self.objective}: costs are "
                "minimised, so a bound must not be larger"
            )

    @property
    def gap_abs(self) -> float:
        """Absolute difference of objective and bound; nan without a solution or a finite bound."""
        if self.solution is None or not isfinite(self.objective - self.bound):
            return nan
        return abs(self.objective - self.bound)

    @property
    def gap(self) -> float:
        """`gap_abs` as a share of `scale`; 0 if `gap_abs` is 0, else nan if `scale` is 0."""
        scale = abs(self.objective) if isnan(self.scale) else self.scale
        if self.gap_abs == 0.0:
            return 0.0
        return self.gap_abs / scale if scale > 0.0 else nan


def checked(answer: Any) -> Answer:
    """Return the value that an optimiser returned, after checking that it is an `Answer`.

    Raises
    ------
    TypeError
        If the value is something else.
    """
    if not isinstance(answer, Answer):
        raise TypeError(f"an optimiser must return an Answer; it returned {type(answer).__name__}")
    return answer


@dataclass(frozen=True, eq=False)
class Ask(Generic[Q]):
    """A question to an optimiser; `decide` yields it like a decision.

    Attributes
    ----------
    solve
        The optimiser: a function at the top level of a module, so that another process can import
        it. It must always give the same answer to the same question.
    question
        The relevant state of the world: a frozen dataclass of arrays and numbers copied from the
        view.
    sizes
        Dimensions of the question, such as `{"orders": 80}`, for the table of decisions.
    memo
        Data that the controller needs when the answer arrives, such as the orders to which indices
        in the question refer.
    """

    solve: Callable[[Q], Answer]
    question: Q
    sizes: Mapping[str, int] = field(default_factory=dict)
    memo: Any = None


class Outcome(StrEnum):
    """Whether and how a call to an optimiser ended."""

    WAITING = "waiting"
    """No answer has taken effect, so far or by the end of the run."""
    SOLUTION = "solution"
    NOTHING = "nothing"
    """The optimiser ended without a solution."""
    FAILED = "failed"
    """The optimiser raised an error, crashed, or exceeded its time limit."""
    ABANDONED = "abandoned"
    """The controller was exchanged before the answer arrived."""


class Asker(Protocol):
    """The part of `rmfs.control.base.Controller` by which a controller gets its answers."""

    in_flight: int

    def answered(self, call: Call) -> Iterator[Any]:
        """Yield the decisions that follow from the answer to a question."""
        ...


@dataclass(eq=False)
class Call:
    """One question to an optimiser in a run, with its answer and outcome.

    Attributes
    ----------
    number
        Number of the question in the run, from 0.
    controller
        The controller that asked.
    requested_us, completed_us
        Simulated times, in microseconds, at which the question was asked and at which its answer
        took effect; the latter is -1 while the call is waiting.
    state
        Hash of the question and of the state of the world when it was asked.
    failure
        Reason for a failure, in one line.
    applied, stale
        Number of decisions of the solution that were applied, and number of those that were left
        out because they had become invalid.
    fallback
        Number of decisions made by the controller's own rule because the call failed or found
        nothing.
    done
        Number of parts of the answer that have been handled, by name of their group (see `left`).
    """

    number: int
    problem: Problem
    controller: Asker
    ask: Ask[Any]
    requested_us: int
    state: str
    completed_us: int = -1
    answer: Answer | None = None
    outcome: Outcome = Outcome.WAITING
    failure: str = ""
    applied: int = 0
    stale: int = 0
    fallback: int = 0
    done: dict[str, int] = field(default_factory=dict)

    @property
    def solution(self) -> Mapping[str, Any] | None:
        """The solution; None if there is none (yet)."""
        return None if self.answer is None else self.answer.solution

    @property
    def paced_s(self) -> float:
        """Simulated time in s from the question until its answer took effect; nan while waiting."""
        if self.completed_us < 0:
            return float("nan")
        return (self.completed_us - self.requested_us) / 1e6

    def take_effect(self, at_us: int) -> None:
        """Record that the answer, or the failure, takes effect at a simulated time, in us."""
        self.completed_us = at_us
        if self.answer is None:
            self.outcome = Outcome.FAILED
        else:
            self.outcome = Outcome.NOTHING if self.solution is None else Outcome.SOLUTION

    def left(self, name: str, parts: Sequence[D]) -> Iterator[D]:
        """Yield the parts of an answer that have not been handled yet.

        A TA rule that iterates over its answer in this way can be resumed in the middle (see
        `Controller.goes_on`). This is needed if a program outside the simulation decides PPS, PSA
        or repositioning: a question to this program interrupts `Controller.answered`, which is
        called again when the program has answered.

        Parameters
        ----------
        name
            Name of this group of parts within the answer.
        parts
            All parts of the group, the same each time the method is called for this group.
        """
        while (number := self.done.get(name, 0)) < len(parts):
            self.done[name] = number + 1
            yield parts[number]

    def count(self) -> None:
        """Count a decision of this call: as `applied`, or as `fallback` if there is no solution."""
        if self.solution is None:
            self.fallback += 1
        else:
            self.applied += 1

    def forget(self) -> None:
        """Release the question, memo and `Answer.found`, which may be large; the rest is kept."""
        self.ask = replace(self.ask, question=None, memo=None)
        if self.answer is not None:
            self.answer = replace(self.answer, found=None)


class By(NamedTuple, Generic[D]):
    """A decision, with the call whose solution it is based on.

    The call is None if the controller's own rule made the decision. A decision without `By` is
    attributed to the controller's own rule if it comes from `decide`, and to the answer if it comes
    from `answered`.
    """

    decision: D
    call: Call | None


def told_by(decision: Any, otherwise: Call | None) -> tuple[Any, Call | None]:
    """Return a decision without its wrapper `By`, and the call on which it is based.

    Parameters
    ----------
    decision
        A decision, which may be wrapped in `By`.
    otherwise
        The call on which the decision is based if it is not wrapped.
    """
    return decision if type(decision) is By else (decision, otherwise)


def own(decisions: Iterable[D]) -> Iterator[D | By[D]]:
    """Yield decisions and attribute them to the controller's own rule, even within `answered`.

    Questions (`Ask`) are passed on unchanged.
    """
    for decision in decisions:
        yield decision if type(decision) is Ask else By(decision, None)
