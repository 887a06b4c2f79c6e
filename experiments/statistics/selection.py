"""Selection of the best arm with a stated probability of error.

Procedure KN: S.-H. Kim and B. L. Nelson (2001), A fully sequential procedure for indifference-zone
selection in simulation, ACM Transactions on Modeling and Computer Simulation 11(3), 251-273. If
the results of runs are normally distributed and the best arm is better than all others by at least
the indifference (the smallest difference worth detecting), the best arm is selected with a
probability of at least 1 - error. Results of different arms may be correlated: common random
numbers usually reduce the number of runs needed.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import floor
from typing import TYPE_CHECKING

import numpy as np

from rmfs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray


@dataclass(frozen=True)
class Selection:
    """State of the procedure after it has used the available observations.

    Attributes
    ----------
    left
        Arms that may still be the best.
    used
        Number of observations used, by arm.
    observations
        Number of observations used so far of each arm in `left` (the same for all).
    over
        Whether the procedure has ended; otherwise it needs more observations of arms in `left`.
    best
        The selected arm; if the procedure was stopped early, the arm in `left` with the best mean.
        None before the end.
    proven
        Whether `best` is selected with the stated probability of error. False before the end, and
        false if the procedure was stopped early because of the maximum number of observations.
    """

    left: tuple[str, ...]
    used: Mapping[str, int]
    observations: int
    over: bool
    best: str | None
    proven: bool

    def verdict(self) -> str:
        """Return the result as a sentence."""
        if not self.over:
            return f"{len(self.left)} arms may be the best one"
        if self.proven:
            return f"{self.best} selected after {self.observations} seeds"
        return (
            f"stopped after {self.observations} seeds with {len(self.left)} arms left; the "
            f"best mean is that of {self.best}"
        )


def kim_nelson(
    samples: Mapping[str, Sequence[float]],
    *,
    first: int,
    indifference: float,
    error: float = 0.05,
    goal: str = "max",
    most: int | None = None,
) -> Selection:
    """Run procedure KN (with c = 1) as far as the observations allow.

    Parameters
    ----------
    samples
        Observations of each arm, in the order of their seeds. The k-th observations of different
        arms may be correlated.
    first
        Number of observations of each arm in the first stage, from which variances are estimated;
        at least 2.
    indifference
        Smallest difference of means worth detecting.
    error
        Largest permitted probability of a wrong choice. Default 0.05.
    goal
        `max` if the best mean is the largest, `min` if it is the smallest. Default `max`.
    most
        Number of observations per arm at which the procedure is stopped. Default: no limit.

    Raises
    ------
    InputError
        If there is no arm, `first` is less than 2, or an arm has fewer than `first` observations.
    """
    names = list(samples)
    if not names or first < 2 or any(len(samples[name]) < first for name in names):
        raise InputError(f"selection: needs {max(first, 2)} observations of every arm to begin")
    sign = 1.0 if goal == "max" else -1.0
    values = {name: sign * np.asarray(samples[name], dtype=float) for name in names}
    used = dict.fromkeys(names, first)
    if len(names) == 1:
        return Selection((names[0],), used, first, True, names[0], True)
    scale = _h_squared(len(names), first, error) / indifference**2
    # h^2 S^2_il / delta^2 of each pair (i, l), from the first stage
    limit = scale * _variances(np.stack([values[name][:first] for name in names]))
    last = floor(limit.max())
    left = list(range(len(names)))
    count = first
    while True:
        means = np.array([values[names[i]][:count].mean() for i in left])
        if count > last:
            left = [left[int(means.argmax())]]
        else:
            left = _screened(left, means, limit, count, indifference)
        over, cut = len(left) == 1, most is not None and count >= most
        if over or cut:
            means = np.array([values[names[i]][:count].mean() for i in left])
            best = names[left[int(means.argmax())]]
            return Selection(_names(names, left), used, count, True, best, over)
        if any(len(values[names[i]]) <= count for i in left):
            return Selection(_names(names, left), used, count, False, None, False)
        count += 1
        used |= {names[i]: count for i in left}


def _h_squared(arms: int, first: int, error: float) -> float:
    """Constant h^2 of the procedure: 2 c eta (n0 - 1), with c = 1."""
    eta = 0.5 * ((2.0 * error / (arms - 1)) ** (-2.0 / (first - 1)) - 1.0)
    return float(2.0 * eta * (first - 1))


def _variances(first: NDArray[np.float64]) -> NDArray[np.float64]:
    """Sample variances of the differences of each pair of arms, (k, k)."""
    covariance = np.cov(first)
    own = np.diag(covariance)
    return np.asarray(own[:, None] + own[None, :] - 2.0 * covariance, dtype=np.float64)


def _screened(
    left: list[int],
    means: NDArray[np.float64],
    limit: NDArray[np.float64],
    count: int,
    indifference: float,
) -> list[int]:
    """Keep the arms that no other one beats by more than its slack W_il(r)."""
    pairs = limit[np.ix_(left, left)]
    slack = np.maximum(0.0, indifference / (2.0 * count) * (pairs - count))
    np.fill_diagonal(slack, 0.0)
    keeps: NDArray[np.bool_] = np.asarray((means[:, None] >= means[None, :] - slack).all(axis=1))
    return [arm for arm, kept in zip(left, keeps, strict=True) if kept]


def _names(names: list[str], chosen: list[int]) -> tuple[str, ...]:
    return tuple(names[i] for i in chosen)
