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
"""Amount by which a bound may exceed the objective due to rounding, relative to the objective."""

Plain = NDArray[Any] | int | float | str | bool | Sequence["Plain"]
"""Values allowed in a solution, which is sent between processes, recorded and replayed."""


@dataclass(frozen=True, eq=False)
class Answer:
    """What an optimiser found.

    Attributes
    ----------
    solution
        Arrays and numbers by name; None if there is no solution or none was found in time.
    objective, bound
        Cost of the solution, and proven lower bound; inf or nan if there is none.
    status
        Final status, as the solver names it.
    backend
        Name of the back end.
    work
        Deterministic work, in the unit of the back end.
    wall_s, build_s
        Total wall time, and the part spent building the solver's model.
    built
        Size of the model that was built (nonzeros), which is charged in addition to the work.
    scale
        Reference for the relative gap, in the unit of the objective, such as the cost of the pods
        called. Default: the objective, which is unsuitable if gains and costs cancel out.
    found
        The optimiser's complete values, for saving questions and answers; `solution` is the part
        that the controller needs. Not recorded.

    Raises
    ------
    TypeError
        If the solution is not a mapping, or a value is not a number.
    ValueError
        If work is negative or not finite, or a bound is beyond the objective.
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
            raise TypeError(f"solution must be values by name, or None; it is a {kind}")
        for name in ("work", "built", "wall_s", "build_s"):
            value = getattr(self, name)
            if not (isfinite(value) and value >= 0.0):
                raise ValueError(f"{name} must be a finite number, 0 or more; it is {value}")
        slack = BOUND_TOLERANCE * max(1.0, abs(self.objective))
        if self.solution is not None and self.bound - self.objective > slack:
            raise ValueError(
                f"bound {self.bound} exceeds the objective {self.objective}: costs are "
                "minimised, so a bound must not be larger"
            )

    @property
    def gap_abs(self) -> float:
        """Absolute gap between objective and bound; nan if either is missing."""
        if self.solution is None or not isfinite(self.objective - self.bound):
            return nan
        return abs(self.objective - self.bound)

    @property
    def gap(self) -> float:
        """`gap_abs` relative to `scale`; 0 if `gap_abs` is 0, else nan if `scale` is 0."""
        scale = abs(self.objective) if isnan(self.scale) else self.scale
        if self.gap_abs == 0.0:
            return 0.0
        return self.gap_abs / scale if scale > 0.0 else nan


def checked(answer: Any) -> Answer:
    """Return an optimiser's return value if it is an `Answer`.

    Raises
    ------
    TypeError
        If it is not an `Answer`.
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
        Function of a module that another process can import. It must always give the same answer
        to the same question.
    question
        The relevant state of the world: a frozen dataclass of arrays and numbers copied from the
        view.
    sizes
        Dimensions of the question, such as `{"orders": 80}`, for the table of decisions.
    memo
        Data that the controller gets back with the answer, such as the orders behind the indices.
    """

    solve: Callable[[Q], Answer]
    question: Q
    sizes: Mapping[str, int] = field(default_factory=dict)
    memo: Any = None


class Outcome(StrEnum):
    """How a call ended."""

    WAITING = "waiting"
    """The answer has not arrived yet, or not before the run ended."""
    SOLUTION = "solution"
    NOTHING = "nothing"
    """The optimiser ended without a solution."""
    FAILED = "failed"
    """The optimiser raised an error, crashed, or exceeded its time limit."""
    ABANDONED = "abandoned"
    """The controller was exchanged before the answer arrived."""


class Asker(Protocol):
    """A controller that asks questions (`rmfs.control.base.Controller`)."""

    in_flight: int

    def answered(self, call: Call) -> Iterator[Any]:
        """Yield the decisions of an answer."""
        ...


@dataclass(eq=False)
class Call:
    """One question in a run, and what became of it.

    Attributes
    ----------
    number
        Number of the question in the run, from 0.
    controller
        The controller that asked.
    requested_us, completed_us
        Simulated times, in microseconds, of the question and of the effect of its answer; -1 if not
        yet.
    state
        Hash of the question and of the state of the world when it was asked.
    failure
        Reason for a failure, in one line.
    applied, stale
        Number of the solution's decisions that were applied, and number that had become invalid.
    fallback
        Number of decisions made by the controller's own rule because the call failed or found
        nothing.
    done
        Number of parts of the answer already handled, by name of the group of parts (`left`).
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
        """The solution, if there is one."""
        return None if self.answer is None else self.answer.solution

    @property
    def paced_s(self) -> float:
        """Simulated time from the question to its effect; nan while waiting."""
        if self.completed_us < 0:
            return float("nan")
        return (self.completed_us - self.requested_us) / 1e6

    def left(self, name: str, parts: Sequence[D]) -> Iterator[D]:
        """Yield the parts of an answer that have not been handled yet.

        A TA rule that iterates over its answer this way can be resumed in the middle. When PPS, PSA
        or repositioning are decided outside, `answered` stops at the first question to them and is
        called again once that question is answered (`Controller.goes_on`).

        Parameters
        ----------
        name
            Name of this group of parts within the answer.
        parts
            All parts of the group, the same on each call.
        """
        while (number := self.done.get(name, 0)) < len(parts):
            self.done[name] = number + 1
            yield parts[number]

    def count(self) -> None:
        """Count a decision based on this answer."""
        if self.solution is None:
            self.fallback += 1
        else:
            self.applied += 1

    def forget(self) -> None:
        """Release the question and its values, which may be large; sizes and solution are kept."""
        self.ask = replace(self.ask, question=None, memo=None)
        if self.answer is not None:
            self.answer = replace(self.answer, found=None)


class By(NamedTuple, Generic[D]):
    """A decision and the call whose solution it is based on.

    The call is None if the controller's own rule decided.

    A decision without `By` is attributed to the controller's own rule if it comes from `decide`,
    and to the answer if it comes from `answered`.
    """

    decision: D
    call: Call | None


def told_by(decision: Any, otherwise: Call | None) -> tuple[Any, Call | None]:
    """Separate a decision from the call on which it is based."""
    return decision if type(decision) is By else (decision, otherwise)


def own(decisions: Iterable[D]) -> Iterator[D | By[D]]:
    """Yield decisions attributed to the controller's own rule, even from within `answered`."""
    for decision in decisions:
        yield decision if type(decision) is Ask else By(decision, None)
