r"""Find the level at which a noisy, monotone response has a given mean: estimate it, then test it.

1. *Search*: retrospective approximation (H. Chen and B. W. Schmeiser 2001, Stochastic root finding
   via retrospective approximation, IIE Transactions 33(3), 259-275). The mean over a few seeds,
   which are the same at every level, is a deterministic function of the level. The level at which
   this mean equals the target is found by the Illinois variant of regula falsi and is the first
   guess.
2. *Test*: the guess is simulated with new seeds. The two-stage rule of Stein (1945, A two-sample
   test for a linear hypothesis whose power is independent of the variance, Annals of Mathematical
   Statistics 16(3), 243-258) determines how many seeds are needed for a confidence interval whose
   half width is half the tolerance; the rule is exact if responses are normally distributed. The
   guess is accepted if the whole interval lies within the tolerance of the target. Otherwise, a
   monotone function is fitted to the means so far (isotonic regression). The level at which this
   function equals the target is the next guess, which is tested with further seeds.

The k-th test errs with probability at most :math:`\alpha / 2^k`, so all tests together err with
probability at most :math:`\alpha = 1 - confidence`. This bounds the probability that the mean at
the level found differs from the target by more than the tolerance, however many guesses were
tested.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import ceil, floor, inf, log10, nan, sqrt
from typing import TYPE_CHECKING, Literal

import numpy as np

from rmfs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    Respond = Callable[[float, Sequence[int]], NDArray[np.float64]]

DIGITS = 4
"""Significant digits of a level."""

MOST_LOOKS = 12
"""Maximum number of levels that the search evaluates, in addition to both ends of the range."""

DOUBLINGS = 3
"""Number of doublings of the number of seeds after which the target counts as out of range."""


@dataclass(frozen=True)
class Goal:
    """The goal of a calibration, and the required confidence.

    Parameters
    ----------
    target
        The desired mean.
    tolerance
        Maximum difference between the mean and the target.
    low, high
        Ends of the range in which the level is sought.
    confidence
        Required probability that the difference is within the tolerance. Default 0.95.
    search_seeds
        Number of seeds at each level of the search. If the target does not lie between the means
        at `low` and `high`, this number is doubled, up to three times. Default 4.
    test_seeds
        Number of seeds in the first stage of a test. Default 10.
    most_runs
        Maximum number of runs. Default 2000.
    first_seed
        The first seed; further seeds are consecutive. Default 0.

    Raises
    ------
    InputError
        If a number is out of its range.
    """

    target: float
    tolerance: float
    low: float
    high: float
    confidence: float = 0.95
    search_seeds: int = 4
    test_seeds: int = 10
    most_runs: int = 2000
    first_seed: int = 0

    def __post_init__(self) -> None:
        _require(np.isfinite(self.target), "target", self.target, "a number")
        _require(0 < self.tolerance < inf, "tolerance", self.tolerance, "above 0")
        _require(-inf < self.low < self.high < inf, "low", self.low, f"below high = {self.high:g}")
        _require(0.5 <= self.confidence <= 0.9999, "confidence", self.confidence, "0.5 to 0.9999")
        _require(self.search_seeds >= 1, "search_seeds", self.search_seeds, "1 or more")
        _require(self.test_seeds >= 3, "test_seeds", self.test_seeds, "3 or more")
        least = 2 * self.search_seeds + self.test_seeds
        _require(self.most_runs >= least, "most_runs", self.most_runs, f"{least} or more")
        _require(self.first_seed >= 0, "first_seed", self.first_seed, "0 or more")


@dataclass(frozen=True)
class Step:
    """A level that was evaluated.

    Attributes
    ----------
    phase
        Purpose of the evaluation: `end` (an end of the range), `search` or `test`.
    first_seed, seeds
        First seed and number of consecutive seeds.
    mean, half_width
        Mean of the response, and half width of its confidence interval. The half width is nan
        except in a test.
    verdict
        `stands` if the level passed its test; otherwise `above` or `below`, depending on whether
        the mean is above or below the target.
    """

    phase: Literal["end", "search", "test"]
    level: float
    first_seed: int
    seeds: int
    mean: float
    half_width: float
    verdict: str


@dataclass(frozen=True)
class Calibration:
    """The result of a calibration.

    Attributes
    ----------
    goal
        The goal.
    level
        Level at which the mean is within the tolerance of the target, with the required confidence;
        nan if the runs did not suffice.
    mean, half_width
        Mean of the response, and half width of its confidence interval, in the test that the
        level passed.
    slope
        Estimated slope of the mean as a function of the level, at `level`.
    steps
        Evaluations of levels, in order.
    runs
        Number of runs made.
    """

    goal: Goal
    level: float
    mean: float
    half_width: float
    slope: float
    steps: Sequence[Step]
    runs: int

    @property
    def found(self) -> bool:
        """Whether a level passed its test."""
        return bool(np.isfinite(self.level))


class _ExhaustedError(Exception):
    """The maximum number of runs does not suffice."""


@dataclass
class _Procedure:
    goal: Goal
    respond: Respond
    watch: Callable[[Step], None]
    steps: list[Step] = field(default_factory=list)
    asked: set[tuple[float, int]] = field(default_factory=set)
    search_seeds: int = 0
    next_seed: int = 0

    @property
    def runs(self) -> int:
        """Number of runs made so far."""
        return len(self.asked)

    def run(self) -> Calibration:
        goal, error = self.goal, 1.0 - self.goal.confidence
        slope = nan
        try:
            low, high = self._ends()
            self._search(low, high)
            self.next_seed = goal.first_seed + self.search_seeds
            while True:
                error /= 2
                guess, slope = _root(self.steps, goal, rising=high > low)
                mean, half = self._test(guess, error)
                if abs(mean - goal.target) <= goal.tolerance - half:
                    return Calibration(goal, guess, mean, half, slope, self.steps, self.runs)
        except _ExhaustedError:
            return Calibration(goal, nan, nan, nan, slope, self.steps, self.runs)

    # --- search ---------------------------------------------------------------------------------

    def _ends(self) -> tuple[float, float]:
        """Return the means at both ends of the range minus the target.

        If both differences have the same sign, they are computed again with more seeds.

        Raises
        ------
        InputError
            If they still have the same sign with the largest number of seeds.
        """
        goal = self.goal
        for doubled in range(DOUBLINGS + 1):
            self.search_seeds = goal.search_seeds << doubled
            low, high = (self._look(end, "end") for end in (goal.low, goal.high))
            if (low > 0) != (high > 0):
                return low, high
        raise InputError(
            f"between {goal.low:g} and {goal.high:g}: the mean goes from "
            f"{low + goal.target:.4g} to {high + goal.target:.4g} ({self.search_seeds} "
            f"seeds); the target must lie between these, and is {goal.target:g}"
        )

    def _search(self, low: float, high: float) -> None:
        """Look for the level at which the mean over the seeds of the search equals the target.

        Parameters
        ----------
        low, high
            Means at both ends of the range minus the target; their signs differ.
        """
        begin, end = self.goal.low, self.goal.high
        at_begin, at_end = low, high
        for _ in range(MOST_LOOKS):
            width = end - begin
            guess = (begin * at_end - end * at_begin) / (at_end - at_begin)
            guess = _rounded(min(max(guess, begin + 0.05 * width), end - 0.05 * width))
            if not begin < guess < end:
                return
            off = self._look(guess, "search")
            if abs(off) <= self.goal.tolerance / 2:
                return
            # an end that stays counts half, so that it moves, too, before long
            if (off > 0) == (low > 0):
                begin, at_begin, at_end = guess, off, at_end / 2
            else:
                end, at_end, at_begin = guess, off, at_begin / 2

    def _look(self, level: float, phase: Literal["end", "search"]) -> float:
        """Return the mean over the seeds of the search minus the target."""
        goal = self.goal
        values = self._values(level, goal.first_seed, self.search_seeds)
        mean = float(values.mean())
        off = mean - goal.target
        told = "above" if off > 0 else "below"
        self._add(Step(phase, level, goal.first_seed, len(values), mean, nan, told))
        return off

    # --- test -----------------------------------------------------------------------------------

    def _test(self, level: float, error: float) -> tuple[float, float]:
        """Return the mean at a level and the half width of its interval, computed with new seeds.

        The true mean is above the interval with probability at most `error`, and below it with
        probability at most `error`. An accepted guess can be wrong in one direction only.
        """
        from scipy import stats  # takes a second, which the other commands need not wait for

        goal = self.goal
        first = self.next_seed
        values = self._values(level, first, goal.test_seeds)
        quantile = float(stats.t.ppf(1.0 - error, len(values) - 1))
        spread = float(values.std(ddof=1))
        wanted = max(len(values), ceil((2.0 * quantile * spread / goal.tolerance) ** 2))
        more = wanted - len(values)
        if more:
            values = np.concatenate([values, self._values(level, first + len(values), more)])
        self.next_seed += wanted
        mean, half = float(values.mean()), quantile * spread / sqrt(wanted)
        stands = abs(mean - goal.target) <= goal.tolerance - half
        told = "stands" if stands else "above" if mean > goal.target else "below"
        self._add(Step("test", level, first, wanted, mean, half, told))
        return mean, half

    def _values(self, level: float, first: int, count: int) -> NDArray[np.float64]:
        seeds = range(first, first + count)
        asked = self.asked | {(level, seed) for seed in seeds}
        if len(asked) > self.goal.most_runs:
            raise _ExhaustedError
        self.asked = asked
        values = self.respond(level, seeds)
        if not np.isfinite(values).all():
            raise InputError(f"at {level:g}: a run has no value")
        return values

    def _add(self, step: Step) -> None:
        self.steps.append(step)
        self.watch(step)


def calibrate(goal: Goal, respond: Respond, watch: Callable[[Step], None] = print) -> Calibration:
    """Find the level at which a response has a given mean.

    Parameters
    ----------
    goal
        The goal.
    respond
        Function that takes a level and seeds, and returns the response for each seed, shape (N,).
        The expected response must be monotone in the level.
    watch
        Function called with every step as soon as it has been evaluated.

    Raises
    ------
    InputError
        If the target does not lie between the means at the ends of the range, or a response is nan.
    """
    return _Procedure(goal, respond, watch).run()


@dataclass(frozen=True)
class _Curve:
    """The mean minus the target, as a monotone function that is linear between N levels."""

    level: NDArray[np.float64]
    off: NDArray[np.float64]

    @classmethod
    def of(cls, steps: Sequence[Step], goal: Goal, *, rising: bool) -> _Curve:
        """Return the isotonic regression of the means, weighted by their numbers of seeds."""
        from scipy.optimize import isotonic_regression

        level, which = np.unique([step.level for step in steps], return_inverse=True)
        seeds = np.array([step.seeds for step in steps])
        weight = np.bincount(which, seeds)
        off = np.bincount(which, seeds * [step.mean - goal.target for step in steps]) / weight
        found = isotonic_regression(off, weights=weight, increasing=rising)
        first = found.blocks[:-1]
        pooled = np.add.reduceat(level * weight, first) / np.add.reduceat(weight, first)
        return cls(pooled, found.x[first])

    def root(self) -> tuple[float, float] | None:
        """Return the level at which the curve is 0, and its slope there; None if there is none."""
        after = int(np.argmax(np.sign(self.off) != np.sign(self.off[0])))
        if after == 0:
            return None
        (begin, end), (low, high) = (
            self.level[after - 1 : after + 1],
            self.off[after - 1 : after + 1],
        )
        slope = float((high - low) / (end - begin))
        return float(begin - low / slope), slope

    def through(self, other: _Curve) -> _Curve:
        """Return this curve, shifted to meet `other` where `other` is nearest to 0."""
        nearest = int(np.abs(other.off).argmin())
        now = np.interp(other.level[nearest], self.level, self.off)
        return _Curve(self.level, self.off + other.off[nearest] - now)


def _root(steps: Sequence[Step], goal: Goal, *, rising: bool) -> tuple[float, float]:
    """Return the next guess, and the slope there.

    If the means of tests lie on both sides of the target, the guess is the root of their curve.
    Otherwise, it is the root of the curve of the search, shifted to meet the best test. A shift
    suffices, because the levels of the search share their seeds and so most of their error.
    """
    looks = [step for step in steps if step.phase != "test"]
    tests = [step for step in steps if step.phase == "test"]
    curve = _Curve.of(looks, goal, rising=rising)
    if tests:
        tested = _Curve.of(tests, goal, rising=rising)
        found = tested.root()
        if found is not None:
            return _rounded(found[0]), found[1]
        curve = curve.through(tested)
    found = curve.root()
    if found is None:
        return (goal.low if (curve.off[0] > 0) == rising else goal.high), nan
    return _rounded(found[0]), found[1]


def _rounded(level: float) -> float:
    """Round a level to a few significant digits, so that it is easy to read and type."""
    if level == 0:
        return 0.0
    return round(level, DIGITS - 1 - floor(log10(abs(level))))


def _require(holds: bool, key: str, value: float, valid: str) -> None:
    if not holds:
        raise InputError(f"{key} = {value:g}: must be {valid}")
