"""Questions for optimisers: what a controller asks, what comes back, and how a call went."""

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
"""How far, relative to the objective, a bound may pass it by rounding."""

Plain = NDArray[Any] | int | float | str | bool | Sequence["Plain"]
"""What a solution may consist of: it is sent between processes, recorded and replayed."""


@dataclass(frozen=True, eq=False)
class Answer:
    """What an optimiser found.

    Attributes
    ----------
    solution
        Arrays and numbers by name; None if there is no solution, or none was found in time.
    objective, bound
        Cost of the solution and what is proven about the least one; inf or nan where nothing is.
    status
        How the solver ended, in its words.
    backend
        Who solved it.
    work
        Deterministic work in the unit of the back end.
    wall_s, build_s
        Wall time in all, and the part in which the solver's model was built.
    built
        Entries built or gone through besides the work: the nonzeros of the solver's model.
    scale
        What a gap is large or small against, in the unit of the objective, such as the cost of the
        pods called. Default: the objective, which means little where gains and costs cancel out.
    found
        The optimiser's own values, of which `solution` is what the controller needs: for who keeps
        questions and answers. It is not recorded.

    Raises
    ------
    TypeError
        If the solution is no mapping, or a number is none.
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
                f"bound {self.bound} is beyond the objective {self.objective}: of a cost, less is "
                "better"
            )

    @property
    def gap_abs(self) -> float:
        """Distance of objective and bound in their own unit; nan without one of them."""
        if self.solution is None or not isfinite(self.objective - self.bound):
            return nan
        return abs(self.objective - self.bound)

    @property
    def gap(self) -> float:
        """`gap_abs` relative to `scale`; nan without it, or where only the scale is 0."""
        scale = abs(self.objective) if isnan(self.scale) else self.scale
        if self.gap_abs == 0.0:
            return 0.0
        return self.gap_abs / scale if scale > 0.0 else nan


def checked(answer: Any) -> Answer:
    """Return what an optimiser returned, if it is an answer.

    Raises
    ------
    TypeError
        If it is not.
    """
    if not isinstance(answer, Answer):
        raise TypeError(f"an optimiser must return an Answer; it returned {type(answer).__name__}")
    return answer


@dataclass(frozen=True, eq=False)
class Ask(Generic[Q]):
    """A question for an optimiser; `decide` yields it like a decision.

    Attributes
    ----------
    solve
        A function of a module, which another process can import. The same question must always
        get the same answer.
    question
        What the world looks like: a frozen dataclass of arrays and numbers, copied from the view.
    sizes
        How large the question is, such as `{"orders": 80}`, for the table of decisions.
    memo
        What the controller wants back with the answer, such as the orders behind the indices.
    """

    solve: Callable[[Q], Answer]
    question: Q
    sizes: Mapping[str, int] = field(default_factory=dict)
    memo: Any = None


class Outcome(StrEnum):
    """How a call ended."""

    WAITING = "waiting"
    """The answer has not come (also: when the run ended)."""
    SOLUTION = "solution"
    NOTHING = "nothing"
    """The optimiser ended without a solution."""
    FAILED = "failed"
    """The optimiser raised an error, died, or took longer than it may."""
    ABANDONED = "abandoned"
    """The controller was exchanged before the answer came."""


class Asker(Protocol):
    """Who asks: a controller (`rmfs.control.base.Controller`)."""

    in_flight: int

    def answered(self, call: Call) -> Iterator[Any]:
        """Yield the decisions of an answer."""
        ...


@dataclass(eq=False)
class Call:
    """One question in the course of a run.

    Attributes
    ----------
    number
        Of all questions of the run, from 0.
    controller
        Who asked.
    requested_us, completed_us
        When it was asked and when the answer took effect, in simulated microseconds; -1 for not
        yet.
    state
        Hash of the question and of the state of the world it was asked in.
    failure
        Why it failed, in one line.
    applied, stale
        Decisions of the solution that were applied, and that no longer held.
    fallback
        Decisions that the heuristic took in its place when it had failed or found nothing.
    done
        How many of its parts have been dealt with (`left`).
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
        """Simulated time from question to effect; nan while it waits."""
        if self.completed_us < 0:
            return float("nan")
        return (self.completed_us - self.requested_us) / 1e6

    def left(self, name: str, parts: Sequence[D]) -> Iterator[D]:
        """Yield the parts of an answer that have not been dealt with.

        A rule for TA that goes through its answer by this can be asked again in the middle of it:
        when PPS, PSA or repositioning are decided outside, `answered` ends with the first question
        to them, and is called anew once that is answered (`Controller.goes_on`).

        Parameters
        ----------
        name
            Of these parts among all of the answer's.
        parts
            All of them; the same ones each time.
        """
        while (number := self.done.get(name, 0)) < len(parts):
            self.done[name] = number + 1
            yield parts[number]

    def count(self) -> None:
        """Count a decision that was based on it."""
        if self.solution is None:
            self.fallback += 1
        else:
            self.applied += 1

    def forget(self) -> None:
        """Let go of question and values, which may be large; sizes and solution stay."""
        self.ask = replace(self.ask, question=None, memo=None)
        if self.answer is not None:
            self.answer = replace(self.answer, found=None)


class By(NamedTuple, Generic[D]):
    """A decision, and the call whose solution it comes from; None: the controller's own rule.

    Without it a decision is the controller's own when it was asked for one, and the answer's when
    it was told an answer (`answered`).
    """

    decision: D
    call: Call | None


def told_by(decision: Any, otherwise: Call | None) -> tuple[Any, Call | None]:
    """Part a decision from the call it comes from."""
    return decision if type(decision) is By else (decision, otherwise)


def own(decisions: Iterable[D]) -> Iterator[D | By[D]]:
    """Yield decisions as the controller's own, whatever it was asked or told."""
    for decision in decisions:
        yield decision if type(decision) is Ask else By(decision, None)
