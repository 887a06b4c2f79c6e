"""Quantities that change in steps over time: backlogs, stock, robots with a task."""

from __future__ import annotations

from math import fsum
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]


class Steps:
    """A piecewise constant function of time.

    Parameters
    ----------
    time_s
        Times of changes, in any order; nan for a change that has not happened.
    change
        Size of the changes, one number for all or one for each time.
    initial
        Value of the function before the first change.
    """

    def __init__(self, time_s: ArrayLike, change: ArrayLike, initial: float = 0.0) -> None:
        times = np.asarray(time_s, np.float64)
        changes = np.broadcast_to(np.asarray(change, np.float64), times.shape)
        happened = ~np.isnan(times)
        order = np.argsort(times[happened], kind="stable")
        self._times = times[happened][order]
        self._values = initial + np.concatenate([[0.0], np.cumsum(changes[happened][order])])

    @classmethod
    def between(cls, begin_s: ArrayLike, end_s: ArrayLike) -> Steps:
        """Return the number of intervals in progress as a function of time.

        The intervals last from `begin_s` to `end_s`; an interval whose end is nan never ends.
        """
        begins, ends = np.asarray(begin_s, np.float64), np.asarray(end_s, np.float64)
        sign = np.concatenate([np.ones(len(begins)), -np.ones(len(ends))])
        return cls(np.concatenate([begins, ends]), sign)

    def positive(self) -> Steps:
        """Return a function that is 1 where this function is positive, and 0 elsewhere."""
        above = (self._values > 0).astype(np.float64)
        return Steps(self._times, np.diff(above), above[0])

    def at(self, time_s: ArrayLike) -> Floats:
        """Return the values just after the given times, as an array of the shape of `time_s`."""
        return self._values[np.searchsorted(self._times, time_s, side="right")]

    def mean(self, begin_s: float, end_s: float) -> float:
        """Return the time average over an interval; nan for an empty interval."""
        if end_s <= begin_s:
            return float("nan")
        inside = (self._times > begin_s) & (self._times < end_s)
        knots = np.concatenate([[begin_s], self._times[inside], [end_s]])
        # exact sum: a product of the linear algebra library is rounded differently on each
        # processor
        return fsum(self.at(knots[:-1]) * np.diff(knots)) / (end_s - begin_s)

    def most(self, begin_s: float, end_s: float) -> float:
        """Return the maximum within an interval; nan for an empty interval."""
        if end_s <= begin_s:
            return float("nan")
        inside = self._times[(self._times > begin_s) & (self._times < end_s)]
        return float(self.at(np.concatenate([[begin_s], inside])).max())


def covered(begin_s: Floats, end_s: Floats, at_s: Floats) -> Floats:
    """Return, for each time in `at_s`, the total length of the intervals up to then, in s.

    The intervals last from `begin_s` to `end_s`; they must be disjoint and sorted by start.
    """
    if not len(begin_s):
        return np.zeros(len(at_s))
    done = np.cumsum(end_s - begin_s)
    knots = np.stack([begin_s, end_s], axis=1).ravel()
    values = np.stack([done - (end_s - begin_s), done], axis=1).ravel()
    return np.interp(at_s, knots, values)


def counts(time_s: ArrayLike, edges_s: Floats) -> NDArray[np.int64]:
    """Return the number of events at `time_s` in each interval (edges_s[k], edges_s[k + 1]].

    The first interval also includes edges_s[0].
    """
    times = np.sort(np.asarray(time_s, np.float64))
    below = np.searchsorted(times, edges_s, side="right")
    below[0] = np.searchsorted(times, edges_s[0], side="left")
    return np.diff(below)
