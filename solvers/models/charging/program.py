r"""The integer program, with a binary column for every possible stay of a robot.

.. math::

    \min \sum_c cost_c x_c + (1 - idle) \frac{slot}{Q} \sum_{qt} m_{qt}, \quad
    \sum_{c \in C_r} x_c = 1, \quad
    m_{qt} \ge wanted_{qt} - R + \sum_{c \text{ away in } t} x_c, \quad
    \sum_{c \text{ at } g \text{ in } t} x_c \le places_{gt}

where :math:`x_c` is 1 if stay c is made, :math:`cost_c` is its cost, excluding the cost of missing
robots, :math:`C_r` are the stays of robot r, including "no stay", and :math:`m_{qt}` is the number
of robots missing in time slot t of case q. The other symbols are those of the module `data`.
"""

from __future__ import annotations

import numpy as np

from rmfs.solvers.models.backends.backend import Formulation
from rmfs.solvers.models.charging.columns import Columns, columns
from rmfs.solvers.models.charging.data import (
    AWAY,
    ChargePlan,
    Charging,
    Floats,
    away,
    objective,
    violations,
)
from rmfs.solvers.models.names import Names
from rmfs.solvers.models.program import ProgramBuilder


def formulate(data: Charging) -> Formulation[ChargePlan]:
    """Formulate the problem as an integer program.

    Parameters
    ----------
    data
        The problem.
    """
    table = columns(data)
    cases, slots = data.wanted.shape
    builder = ProgramBuilder()
    x = builder.columns(len(table.robot), cost=table.cost_s)
    missed = builder.columns((cases, slots), cost=data.missed_s / cases, upper=data.wanted)
    builder.rows(data.robots, (table.robot, x, 1.0), lower=1.0, upper=1.0)
    stay, slot = np.nonzero(table.away)
    row = np.arange(cases * slots).reshape(cases, slots)
    builder.rows(
        cases * slots,
        (row, missed, 1.0),
        (row[:, slot], x[stay], -1.0),
        lower=(data.wanted - data.robots).ravel(),
    )
    stay, slot = np.nonzero(table.used)
    groups = len(data.gain)
    builder.rows(
        groups * slots, (table.group[stay] * slots + slot, x[stay], 1.0), upper=data.places.ravel()
    )
    return Formulation(
        builder.build(),
        lambda plan: _encode(data, table, plan),
        lambda values: _decode(table, values),
        lambda plan: objective(data, plan),
        lambda plan: violations(data, plan),
        lambda names: _name(data, table, names),
    )


def _encode(data: Charging, table: Columns, plan: ChargePlan) -> Floats:
    chosen = np.zeros(len(table.robot))
    chosen[table.rows(plan)] = 1.0
    gone = away(data, np.arange(data.robots), plan).sum(axis=0)
    missed = np.maximum(data.wanted - (data.robots - gone), 0)
    return np.concatenate([chosen, missed.ravel().astype(np.float64)])


def _decode(table: Columns, values: Floats) -> ChargePlan:
    chosen = values[: len(table.robot)]
    rows = [
        low + int(chosen[low:high].argmax())
        for low, high in zip(table.first[:-1].tolist(), table.first[1:].tolist(), strict=True)
    ]
    return table.plan(np.array(rows, np.int64))


def _name(data: Charging, table: Columns, names: Names) -> None:
    x, missed = np.split(np.arange(len(names.name)), [len(table.robot)])
    stays = table.group != AWAY
    nowhere = "group[{r}] = -1, begin[{r}] = 0, length[{r}] = 0"
    names.block("nowhere", x[~stays], nowhere, r=table.robot[~stays])
    at = {"r": table.robot, "g": table.group, "b": table.begin, "n": table.length}
    means = "group[{r}] = {g}, begin[{r}] = {b}, length[{r}] = {n}"
    names.block("stay", x[stays], means, **{letter: one[stays] for letter, one in at.items()})
    case, slot = np.divmod(np.arange(len(missed)), data.slots)
    names.block("missed", missed, q=case, t=slot)
