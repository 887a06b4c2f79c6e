r"""Rack sequencing at one pick station: the problem, and the conditions that a plan must meet.

Orders are processed with at most C of them open at a time, pods visit the station one after the
other, and an open order takes from a visiting pod all SKUs that the order misses and the pod holds.
The number of visits is minimised (the mobile robot order picking problem of Boysen, Briskorn, Emde
2017). Consecutive visits of the same pod count once. A pod that holds a SKU has enough units of it
for all orders.

A visit has three steps. First, open orders are served, and those now complete leave (set B). Then
orders that this pod completes alone come and go one after the other, each occupying a slot for a
moment (set Z). Last, new orders are opened and stay (set N). If A is the set of orders that are
open before and after the visit, the slots require

.. math::

    |A| + |B| \le C, \quad |A| + |N| \le C, \quad
    |A| + 1 \le C \text{ if } Z \text{ is not empty}
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.checks import flags, integers, require

Flags = NDArray[np.bool_]
Integers = NDArray[np.int64]
NEVER = np.iinfo(np.int64).max


@dataclass(frozen=True)
class Sequencing:
    """Orders, pods and slots of one station.

    Parameters
    ----------
    needs
        Whether an order (still) needs a SKU, shape (O, K); every order needs at least one.
    holds
        Whether a pod holds a SKU, shape (P, K).
    capacity
        Maximum number C of open orders.
    opened
        Whether an order is already open before the first visit, shape (O,). Default: none is.

    Raises
    ------
    ModelError
        If a shape or value is wrong, or more orders are open than there are slots.
    """

    needs: Flags
    holds: Flags
    capacity: int
    opened: Flags | None = None

    def __post_init__(self) -> None:
        needs = flags("needs", self.needs, (None, None))
        orders, skus = needs.shape
        opened = np.zeros(orders) if self.opened is None else self.opened
        object.__setattr__(self, "needs", needs)
        object.__setattr__(self, "holds", flags("holds", self.holds, (None, skus)))
        object.__setattr__(self, "capacity", int(integers("capacity", self.capacity, (), low=1)))
        object.__setattr__(self, "opened", flags("opened", opened, (orders,)))
        require(bool(needs.any(axis=1).all()), "needs", "every order needs a SKU")
        require(int(self.open.sum()) <= self.capacity, "opened", "more orders than slots")

    @property
    def open(self) -> Flags:
        """`opened`, or all false if it was not given, shape (O,)."""
        assert self.opened is not None
        return self.opened

    @property
    def orders(self) -> int:
        """Number of orders O."""
        return int(self.needs.shape[0])

    @property
    def pods(self) -> int:
        """Number of pods P."""
        return int(self.holds.shape[0])

    @property
    def feasible(self) -> bool:
        """Whether every needed SKU is on some pod, so that a plan exists."""
        return bool((self.holds.any(axis=0) | ~self.needs.any(axis=0)).all())


@dataclass(frozen=True)
class VisitSequence:
    """A plan: the sequence of visits, and the visit at which each order is opened.

    Parameters
    ----------
    pods
        The visiting pods in sequence, shape (T,).
    start
        Visit during which each order is opened, shape (O,); -1 if open before the first visit.
    """

    pods: Integers
    start: Integers


def objective(data: Sequencing, plan: VisitSequence) -> float:
    """Return the number of visits; consecutive visits of the same pod count once.

    Parameters
    ----------
    data
        The input.
    plan
        The plan.
    """
    return float(1 + np.count_nonzero(np.diff(plan.pods))) if plan.pods.size else 0.0


def finish(data: Sequencing, plan: VisitSequence) -> Integers:
    """Return the visit that completes each order, shape (O,); `NEVER` if none does.

    Parameters
    ----------
    data
        The input.
    plan
        The plan.
    """
    visits = plan.pods.size
    present = data.holds[plan.pods]
    seen = np.arange(visits)[:, None] >= plan.start[None, :]
    end = np.full(data.orders, NEVER)
    for order in range(data.orders):
        had = np.logical_or.accumulate(present & seen[:, order, None], axis=0)
        done = np.flatnonzero((had | ~data.needs[order]).all(axis=1))
        if done.size:
            end[order] = done[0]
    return end


def violations(data: Sequencing, plan: VisitSequence) -> list[str]:
    """Return which conditions a plan violates.

    Parameters
    ----------
    data
        The input.
    plan
        The plan.

    Returns
    -------
    One line per kind of violation; empty if the plan is feasible.
    """
    visits, end = plan.pods.size, finish(data, plan)
    problems = []
    if bool(((plan.start < 0) != data.open).any()):
        problems.append("start must be -1 for the orders open at the start, and only for these")
    if bool((plan.start >= visits).any()) and data.orders:
        problems.append("an order is never opened")
    if bool((end == NEVER).any()):
        problems.append(f"order is never complete: {np.flatnonzero(end == NEVER)[0]}")
    for visit in range(visits):
        staying = (plan.start < visit) & (end > visit)
        leaving = (plan.start < visit) & (end == visit)
        coming = (plan.start == visit) & (end > visit)
        passing = (plan.start == visit) & (end == visit)
        here = max(leaving.sum(), coming.sum(), int(passing.any()))
        if staying.sum() + here > data.capacity:
            problems.append(f"more open orders than slots at visit {visit}")
            break
    return problems
