r"""Rack sequencing as an integer program with at most T visits, as many as in a heuristic plan.

C is the number of order slots. The columns are binary; each is 1 if its statement is true:

- :math:`v_{tp}`: pod p makes visit t;
- :math:`s_{ot}`: order o has been started by the end of visit t;
- :math:`f_{ot}`: order o has been finished by the end of visit t;
- :math:`d_{okt}`: order o takes SKU k at visit t;
- :math:`c_{ot}`: order o passes at visit t, that is, it is started and finished during the visit;
- :math:`r_t`: some order passes at visit t.

.. math::

    \min \sum_{t,p} v_{tp}, \quad
    & \textstyle\sum_p v_{tp} \le \sum_p v_{t-1,p} \le 1, \qquad v_{tp} + v_{t+1,p} \le 1 \\
    & d_{okt} \le \textstyle\sum_{p \ni k} v_{tp}, \qquad d_{okt} \le s_{ot}, \qquad
      f_{ot} \le \sum_{t' \le t} d_{okt'} \\
    & s_{o,t-1} \le s_{ot}, \qquad f_{o,t-1} \le f_{ot} \le s_{ot}, \qquad f_{oT} = 1 \\
    & \textstyle\sum_o (s_{ot} - f_{ot}) \le C, \qquad f_{ot} - s_{o,t-1} \le c_{ot} \le r_t \\
    & \textstyle\sum_o (s_{o,t-1} - f_{ot} + c_{ot}) + r_t \le C

The last row leaves a slot for the orders that pass: its sum over the orders is the number of orders
that are open both before and after the visit.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.backends.backend import Formulation
from rmfs.solvers.models.names import Names
from rmfs.solvers.models.program import ProgramBuilder
from rmfs.solvers.models.sequencing.data import (
    Flags,
    Integers,
    Sequencing,
    VisitSequence,
    finish,
    objective,
    violations,
)
from rmfs.solvers.models.sequencing.local_search import merged
from rmfs.solvers.models.sequencing.sets import useful_pods


@dataclass(frozen=True)
class Columns:
    """The columns for at most T visits, and their conversion to and from plans.

    Parameters
    ----------
    data
        The input.
    pods
        Indices of the pods considered, shape (pods,).
    visit
        Indices of the columns v, shape (T, pods).
    started, finished
        Indices of the columns s and f, shape (T + 1, O); row 0 is the time before the first visit.
    passing
        Indices of the columns c, shape (T, O).
    room
        Indices of the columns r, shape (T,).
    order, sku
        The order and the SKU of each pair of an order and a SKU that it needs, shape (pairs,).
    take
        Indices of the columns d, shape (T, pairs).
    """

    data: Sequencing
    pods: Integers
    visit: Integers
    started: Integers
    finished: Integers
    passing: Integers
    room: Integers
    order: Integers
    sku: Integers
    take: Integers

    def decode(self, x: NDArray[np.float64]) -> VisitSequence:
        """Turn column values into a plan."""
        taken = x > 0.5
        visits = taken[self.visit]
        used = int(visits.any(axis=1).sum())
        if not used:
            return VisitSequence(np.zeros(0, np.int64), np.full(self.data.orders, -1))
        started = taken[self.started]
        start = np.where(self.data.open, -1, started.argmax(axis=0) - 1)
        # Orders start with what they take first; the columns may say earlier.
        takes = taken[self.take]
        first = np.where(takes.any(axis=0), takes.argmax(axis=0), used)
        earliest = np.full(self.data.orders, used)
        np.minimum.at(earliest, self.order, first)
        start = np.where(self.data.open, -1, np.maximum(start, earliest))
        return merged(VisitSequence(self.pods[visits[:used].argmax(axis=1)], start))

    def name(self, names: Names) -> None:
        """Name the columns."""
        visits, orders = self.visit.shape[0], np.arange(self.data.orders)
        time_, later = np.arange(visits)[:, None], np.arange(-1, visits)[:, None]
        names.block("visit", self.visit, "pods[{t}] = {p}", t=time_, p=self.pods)
        names.block("started", self.started, t=later + 1, o=orders)
        names.block("finished", self.finished, t=later + 1, o=orders)
        names.block("passing", self.passing, t=time_, o=orders)
        names.block("room", self.room, t=time_[:, 0])
        names.block("take", self.take, t=time_, o=self.order, k=self.sku)

    def encode(self, plan: VisitSequence) -> NDArray[np.float64]:
        """Turn a feasible plan of at most T visits into column values."""
        visits, end = self.visit.shape[0], finish(self.data, plan)
        blocks = (self.visit, self.started, self.finished, self.passing, self.room, self.take)
        x = np.zeros(sum(block.size for block in blocks))
        stand_in = _stand_ins(self.data, self.pods)[plan.pods]
        x[self.visit[np.arange(plan.pods.size), stand_in]] = 1
        time_ = np.arange(-1, visits)[:, None]
        started: Flags = plan.start <= time_
        finished: Flags = end <= time_
        x[self.started], x[self.finished] = started, finished
        passing = finished[1:] & ~started[:-1]
        x[self.passing], x[self.room] = passing, passing.any(axis=1)
        present = np.zeros((visits, self.data.needs.shape[1]), dtype=np.bool_)
        present[: plan.pods.size] = self.data.holds[plan.pods]
        x[self.take] = present[:, self.sku] & started[1:, self.order]
        return x


def formulate(data: Sequencing, visits: int, least: int) -> Formulation[VisitSequence]:
    """Formulate rack sequencing with at most `visits` visits as an integer program.

    Parameters
    ----------
    data
        The input, which must be feasible.
    visits
        Maximum number T of visits.
    least
        A proven lower bound on the number of visits; the program requires at least this number.
    """
    builder = ProgramBuilder()
    pods = useful_pods(data)
    order, sku = np.nonzero(data.needs)
    times = np.arange(visits)[:, None]
    visit = builder.columns((visits, pods.size), cost=1.0)
    fixed = np.broadcast_to(data.open, (visits + 1, data.orders)).copy()
    may_start = np.broadcast_to(np.arange(visits + 1)[:, None] > 0, fixed.shape) | fixed
    started = builder.columns(fixed.shape, lower=fixed, upper=may_start)
    done = np.broadcast_to(np.arange(visits + 1)[:, None] == visits, fixed.shape)
    may_end = np.broadcast_to(np.arange(visits + 1)[:, None] > 0, fixed.shape)
    finished = builder.columns(fixed.shape, lower=done, upper=may_end)
    passing = builder.columns((visits, data.orders))
    room = builder.columns(visits)
    take = builder.columns((visits, order.size))
    made = (times < least).astype(np.float64).ravel()
    builder.rows(visits, (times, visit, 1), lower=made, upper=1)
    later = max(visits - 1, 0)
    index = np.arange(later)[:, None]
    builder.rows(later, (index, visit[1:], 1), (index, visit[:-1], -1), upper=0)
    _twice(builder, visit)
    _takes(builder, data, pods, visit, started, finished, take, order, sku)
    _slots(builder, data, started, finished, passing, room)
    columns = Columns(data, pods, visit, started, finished, passing, room, order, sku, take)
    return Formulation(
        builder.build(),
        columns.encode,
        columns.decode,
        lambda plan: objective(data, plan),
        lambda plan: violations(data, plan),
        columns.name,
    )


def _twice(builder: ProgramBuilder, visit: Integers) -> None:
    """The same pod twice in a row is one visit."""
    pair = np.arange(visit[1:].size).reshape(visit[1:].shape)
    builder.rows(pair.size, (pair, visit[1:], 1), (pair, visit[:-1], 1), upper=1)


def _takes(
    builder: ProgramBuilder,
    data: Sequencing,
    pods: Integers,
    visit: Integers,
    started: Integers,
    finished: Integers,
    take: Integers,
    order: Integers,
    sku: Integers,
) -> None:
    """An order takes a SKU from a pod that has it while open, and ends when it has all."""
    visits = take.shape[0]
    cell = np.arange(take.size).reshape(take.shape)
    need, pod = np.nonzero(data.holds[pods][:, sku].T)
    builder.rows(take.size, (cell, take, 1), (cell[:, need], visit[:, pod], -1), upper=0)
    builder.rows(take.size, (cell, take, 1), (cell, started[1:, order], -1), upper=0)
    late, early = np.nonzero(np.tri(visits, dtype=np.bool_))
    builder.rows(take.size, (cell, finished[1:, order], 1), (cell[late], take[early], -1), upper=0)
    step = np.arange(visits * data.orders).reshape(visits, data.orders)
    builder.rows(step.size, (step, started[:-1], 1), (step, started[1:], -1), upper=0)
    builder.rows(step.size, (step, finished[:-1], 1), (step, finished[1:], -1), upper=0)
    builder.rows(step.size, (step, finished[1:], 1), (step, started[1:], -1), upper=0)


def _slots(
    builder: ProgramBuilder,
    data: Sequencing,
    started: Integers,
    finished: Integers,
    passing: Integers,
    room: Integers,
) -> None:
    """No more orders are open than there are slots, also while orders come and go."""
    visits = passing.shape[0]
    time_ = np.arange(visits)[:, None]
    builder.rows(visits, (time_, started[1:], 1), (time_, finished[1:], -1), upper=data.capacity)
    cell = np.arange(passing.size).reshape(passing.shape)
    builder.rows(
        cell.size,
        (cell, finished[1:], 1),
        (cell, started[:-1], -1),
        (cell, passing, -1),
        upper=0,
    )
    builder.rows(cell.size, (cell, passing, 1), (cell, room[:, None], -1), upper=0)
    builder.rows(
        visits,
        (time_, started[:-1], 1),
        (time_, finished[1:], -1),
        (time_, passing, 1),
        (time_, room[:, None], 1),
        upper=data.capacity,
    )


def _stand_ins(data: Sequencing, pods: Integers) -> Integers:
    """For each pod, return the position of a listed pod that holds all its needed SKUs."""
    holds = data.holds[:, data.needs.any(axis=0)].astype(np.float32)
    covers = holds @ holds[pods].T == holds.sum(axis=1, keepdims=True)
    stand_in: Integers = covers.argmax(axis=1)
    return stand_in
