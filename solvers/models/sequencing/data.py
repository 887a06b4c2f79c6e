r"""Rack sequencing at one pick station: the problem, and the conditions that a plan must meet.

At most C orders are open at a time, and pods visit the station one after the other. Each open order
takes from a visiting pod all SKUs that the order still needs and the pod holds. The number of
visits is minimised (the mobile robot order picking problem of Boysen, Briskorn, Emde 2017).
Consecutive visits of the same pod count as one. A pod that holds a SKU has enough units of it for
all orders.

A visit has three steps. First, open orders are served, and those that are now complete leave (set
B). Then orders for which this pod holds all SKUs are opened and completed one after the other, so
each occupies a slot for only a moment (set Z). Last, new orders are opened that are not completed
in this visit (set N). Let A be the set of orders that are open both before and after the visit. As
there are C slots, the sets must satisfy

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
        Whether each order needs each SKU, shape (O, K); every order needs at least one. For an
        order that is already open, only the SKUs that it still lacks are needed.
    holds
        Whether each pod holds each SKU, shape (P, K).
    capacity
        Maximum number C of open orders.
    opened
        Whether each order is already open before the first visit, shape (O,). Default: none is.

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
        """Whether each order is already open before the first visit, shape (O,)."""
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
        Index of the visiting pod at each visit, shape (T,).
    start
        Index of the visit at which each order is opened, shape (O,); -1 if the order is open before
        the first visit.
    """

    pods: Integers
    start: Integers


def objective(data: Sequencing, plan: VisitSequence) -> float:
    """Return the number of visits; consecutive visits of the same pod count as one.

    Parameters
    ----------
    data
        The input.
    plan
        The plan.
    """
    return float(1 + np.count_nonzero(np.diff(plan.pods))) if plan.pods.size else 0.0


def finish(data: Sequencing, plan: VisitSequence) -> Integers:
    """Return the index of the visit that completes each order, shape (O,); `NEVER` if none does.

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
    """List the conditions that a plan violates.

    Parameters
    ----------
    data
        The input.
    plan
        The plan.

    Returns
    -------
    One message per kind of violation; empty if the plan is feasible.
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
