"""Which pods are worth looking at: pruning of pod-station and robot-pod pairs.

Of the pods that hold a wanted SKU, only the best few per SKU and station are kept, by their *price*:
the cost of the call, shared by the order lines the pod could serve alone. Versatile pods are cheap
and appear for many SKUs, so that the union stays small. What pruning loses is measured in
`tests/benchmarks/test_models_pile_on.py`; a bound of the pruned model is not one of the full model
(`relaxation.bound` repairs that).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solvers.models.checks import flags, require
from solvers.models.pile_on.data import Flags, Floats, Integers, PileOn
from solvers.models.pile_on.values import Assignment


@dataclass(frozen=True)
class Candidates:
    """The pairs a model may use.

    Parameters
    ----------
    calls
        Whether a pod may be called to a station, shape (P, S).
    fetches
        Whether a robot may fetch a pod, shape (R, P).

    Raises
    ------
    ModelError
        If a shape is wrong.
    """

    calls: Flags
    fetches: Flags

    def __post_init__(self) -> None:
        object.__setattr__(self, "calls", flags("calls", self.calls, (None, None)))
        object.__setattr__(self, "fetches", flags("fetches", self.fetches, (None, None)))


    def including(self, values: Assignment) -> Candidates:
        """Add the pairs that a decision uses, so that it can start a solver.

        Parameters
        ----------
        values
            The decision.
        """
        calls, fetches = self.calls.copy(), self.fetches.copy()
        called = np.flatnonzero(values.pod_station >= 0)
        calls[called, values.pod_station[called]] = True
        fetched = np.flatnonzero(values.pod_robot >= 0)
        fetches[values.pod_robot[fetched], fetched] = True
        return Candidates(calls, fetches)


def everything(data: PileOn) -> Candidates:
    """All pairs that can be of use: no loss.

    Parameters
    ----------
    data
        The input.

    Returns
    -------
    Available pods that hold a SKU wanted at the station, and free robots for those pods.
    """
    holds = data.stock > 0
    on_order = np.zeros(data.skus, dtype=np.bool_)
    on_order[data.line_sku] = True
    takes_orders = data.slots > 0
    wanted = (takes_orders[:, None] & on_order) | (data.shortage > 0)
    calls = (holds.astype(np.float32) @ wanted.T.astype(np.float32)) > 0
    calls &= data.available[:, None]
    return Candidates(calls, _fetches(data, calls))


def prune(
    data: PileOn,
    per_sku: int = 4,
    robots_per_pod: int = 4,
) -> Candidates:
    """Keep the best few pods per SKU and station, and the nearest few robots per pod.

    Parameters
    ----------
    data
        The input.
    per_sku
        Pods kept per wanted SKU and station, at least 1. Default 4.
    robots_per_pod
        Robots kept per pod, at least 1. Default 4.

    Returns
    -------
    The pairs kept.

    Raises
    ------
    ModelError
        If a number is below 1.
    """
    require(per_sku >= 1, "per_sku", "must be at least 1")
    require(robots_per_pod >= 1, "robots_per_pod", "must be at least 1")
    useful = everything(data)
    pod, column = np.nonzero((data.stock[:, data.wanted] > 0) & data.available[:, None])
    price = call_price(data)
    calls = np.zeros_like(useful.calls)
    for station in np.flatnonzero(useful.calls.any(axis=0)):
        order = np.lexsort((pod, price[pod, station], column))
        rank = _rank_in_group(column[order])
        best = pod[order[rank < per_sku]]
        calls[best, station] = True
    calls &= useful.calls
    fetches = np.array(_fetches(data, calls))
    if data.fetch is not None and data.free_robots.size > robots_per_pod:
        rank = np.argsort(np.argsort(data.fetch[data.free_robots], axis=0, kind="stable"), axis=0)
        fetches[data.free_robots] &= rank < robots_per_pod
    return Candidates(calls, fetches)


def call_price(data: PileOn) -> Floats:
    """Cost of calling a pod, nearest robot included, per line it could serve alone, shape (P, S).

    Parameters
    ----------
    data
        The input.
    """
    return (data.call_cost + fetch_estimate(data)[:, None]) / np.maximum(_lines(data), 1)[:, None]


def fetch_estimate(data: PileOn) -> Floats:
    """Weighted cost of the nearest free robot per pod; 0 where none is needed, shape (P,).

    Parameters
    ----------
    data
        The input.
    """
    if data.fetch is None or not data.free_robots.size:
        return np.zeros(data.pods)
    nearest = data.fetch[data.free_robots].min(axis=0)
    return np.where(data.needs_robot, data.weights.travel * nearest, 0.0)


def _lines(data: PileOn) -> Integers:
    """Order lines that a pod could serve alone, shape (P,)."""
    # Lines of the same SKU and units are counted together.
    kinds, count = np.unique(
        np.stack([data.line_sku, data.line_units]), axis=1, return_counts=True
    )
    enough = data.stock[:, kinds[0]] >= kinds[1]
    return enough @ count


def _fetches(data: PileOn, calls: Flags) -> Flags:
    """Which free robots may fetch the pods that may be called, shape (R, P)."""
    fetches = np.zeros((data.robots, data.pods), dtype=np.bool_)
    fetches[data.free_robots] = calls.any(axis=1) & data.needs_robot
    return fetches


def _rank_in_group(group: Integers) -> Integers:
    """Position of each element within its run of equal values."""
    index = np.arange(group.size)
    starts = np.flatnonzero(np.diff(group, prepend=-1))
    return index - np.repeat(starts, np.diff(np.append(starts, group.size)))
