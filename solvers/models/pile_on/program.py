r"""The pile-on models as an integer linear program, for every back end.

The columns, all binary except v, are

- x_ps: pod p is called to station s;
- y_os: order o takes a slot at station s;
- z_ls: line l is covered at station s;
- g_os: order o is a prospect at station s (it could be filled there, but gets no slot);
- e_o: order o is complete;
- w_o: order o is started (it has a slot);
- b_rp: robot r fetches pod p;
- v_sk: number of units of open demand for SKU k at station s that no pod covers.

C_s is the number of free slots of station s; the other symbols are those of the module `data`.

In `Variant.WHOLE`, orders are covered only in full: z_ls = y_os and e_o = sum_s y_os, so that only
the columns x, y, g, b and v remain. This is the model M1G of Jiao et al. 2025 in another form:

- y + g replaces the columns h of M1G (order could be filled), so that the constraint y <= h always
  holds;
- C_s - sum_o y_os replaces the columns u_s of M1G (empty slots);
- the columns d of M1G are left out. Their constraints, 2 d_ops <= y_os + x_ps and
  x_ps <= sum_o d_ops, only say that a called pod shares a SKU with an order placed at its station;
  (5) says the same.

One difference remains: M1G also rewards prospects at stations without free slots, which only
the leftover stock of inbound pods can serve. Here, columns g exist only if C_s > 0.

.. math::

    (1)\quad & \textstyle\sum_o y_{os} \le C_s \\
    (2)\quad & \textstyle\sum_l q_l (z_{ls} + g_{o(l)s}) \le surplus_{sk} - shortage_{sk}
               + v_{sk} + \sum_p a_{pk} x_{ps} \quad (l \text{ with SKU } k) \\
    (3)\quad & \textstyle\sum_s x_{ps} \le 1, \qquad
               \sum_r b_{rp} = \sum_s x_{ps}, \qquad \sum_p b_{rp} \le 1 \\
    (4)\quad & \textstyle\sum_s (y_{os} + g_{os}) \le 1 \\
    (5)\quad & x_{ps} \le \textstyle\sum_{l: a_{p k(l)} > 0} z_{ls} + [p \text{ eases shortage}] \\
    (6)\quad & z_{ls} \le y_{os}, \qquad y_{os} \le \textstyle\sum_{l \in o} z_{ls}
               \;(\text{split}), \qquad e_o \le \textstyle\sum_s z_{ls} \\
    (7)\quad & y_{os} \le w_o \le \textstyle\sum_s y_{os}, \qquad
               w_o + \sum_s g_{os} \le 1, \qquad \sum_s z_{ls} \le 1 \text{ or} = w_o
               \quad (\text{split over stations, instead of (4)}) \\
    (8)\quad & q_l (z_{ls} + g_{os}) \le \min(q_l, surplus_{sk})
               + \textstyle\sum_p \min(q_l, a_{pk}) x_{ps}

In (7), the last sum is at most 1 in `Variant.SPLIT_BOTH` and equal to w_o in
`Variant.SPLIT_STATIONS`. Constraint (8), with a similar constraint on v, is our addition. Every
integer solution satisfies it. In the relaxation, (2) lets a small fraction of a well-stocked pod
cover a whole line; (8) forbids this and so tightens the bound.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from rmfs.solvers.models.backends.backend import Backend, Formulation, solve_by
from rmfs.solvers.models.pile_on.candidates import Candidates, everything
from rmfs.solvers.models.pile_on.columns import Columns, add_columns, decode, encode, name_columns
from rmfs.solvers.models.pile_on.data import Integers, PileOn
from rmfs.solvers.models.pile_on.values import Assignment, nothing, objective, violations
from rmfs.solvers.models.pile_on.variant import Variant
from rmfs.solvers.models.program import ProgramBuilder
from rmfs.solvers.models.solution import Limits, Solution, Status


def formulate(
    data: PileOn, candidates: Candidates, *, strengthen: bool = True
) -> Formulation[Assignment]:
    """Formulate a pile-on model as an integer program.

    Parameters
    ----------
    data
        The input.
    candidates
        The pairs of pod and station, order and station, and robot and pod that may be used.
    strengthen
        Whether to add constraint (8) of this module, which tightens the relaxation. Default: yes.
    """
    builder = ProgramBuilder()
    columns = add_columns(builder, data, candidates)
    held = _held(data, columns)
    _slot_rows(builder, data, columns)
    _supply_rows(builder, data, columns, held, strengthen)
    _call_rows(builder, columns)
    _serving_rows(builder, data, columns, held)
    _robot_rows(builder, data, columns)
    _order_rows(builder, data, columns)
    _cover_rows(builder, data, columns)
    if strengthen:
        _strong_line_rows(builder, data, columns, held)
        _strong_shortage_rows(builder, data, columns, held)
    program = builder.build(data.weights.empty_slot * float(data.slots.sum()))
    return Formulation(
        program,
        lambda values: encode(data, columns, values, program.columns),
        lambda x: decode(data, columns, x),
        lambda values: objective(data, values),
        lambda values: violations(data, values),
        partial(name_columns, data, columns),
    )


def solve_program(
    backend: Backend,
    data: PileOn,
    limits: Limits,
    seed: int,
    start: Assignment | None,
    candidates: Candidates | None,
    strengthen: bool,
) -> Solution[Assignment]:
    """Formulate and solve the program; return the start if nothing better is found.

    Parameters
    ----------
    backend
        The solver.
    data
        The input.
    limits, seed
        Passed to the back end.
    start
        A feasible decision to start from; None: the empty decision.
    candidates
        The pairs of pod and station, order and station, and robot and pod that may be used; None:
        all. If candidates are given, the bound is -inf.
    strengthen
        Whether to add constraint (8) of this module, which tightens the relaxation.

    Returns
    -------
    The solution. It always has values, at worst those of the start.
    """
    first = nothing(data) if start is None else start

    def stated() -> Formulation[Assignment]:
        pairs = everything(data) if candidates is None else candidates.including(first)
        return formulate(data, pairs, strengthen=strengthen)

    found = solve_by(backend, stated, limits, seed=seed, start=first)
    if candidates is None:
        return found
    # the best of the pruned pairs proves nothing about the others
    return replace(found, bound=-math.inf, status=Status.FEASIBLE)


@dataclass(frozen=True)
class _Places:
    """Entries sorted by (station, SKU): those of place i are ``start[i]:start[i + 1]``."""

    entry: Integers
    start: Integers

    @classmethod
    def group(cls, data: PileOn, station: Integers, sku: Integers) -> _Places:
        """Group entries by their place, number station * K + SKU."""
        place = station * data.skus + sku
        entry = np.argsort(place, kind="stable")
        bounds = np.arange(data.stations * data.skus + 1)
        return cls(entry, np.searchsorted(place[entry], bounds))

    def of(self, place: Integers) -> tuple[Integers, Integers]:
        """Return the entries of each listed place: its position in the list, and the entry."""
        count = self.start[place + 1] - self.start[place]
        position = np.repeat(np.arange(place.size), count)
        first = np.repeat(self.start[place] - np.cumsum(count) + count, count)
        return position, self.entry[first + np.arange(position.size)]


@dataclass(frozen=True)
class _Held:
    """Stock of wanted SKUs that called pods would bring: call, SKU and units per entry."""

    call: Integers
    sku: Integers
    units: Integers
    places: _Places


def _held(data: PileOn, columns: Columns) -> _Held:
    """Collect the wanted stock behind each call."""
    call, column = np.nonzero(data.stock[np.ix_(columns.pod, data.wanted)])
    sku = data.wanted[column]
    units = data.stock[columns.pod[call], sku]
    return _Held(call, sku, units, _Places.group(data, columns.station[call], sku))


def _slot_rows(builder: ProgramBuilder, data: PileOn, columns: Columns) -> None:
    """(1): no station takes more orders than it has slots."""
    builder.rows(data.stations, (columns.at, columns.slot, 1), upper=data.slots)


def _supply_rows(
    builder: ProgramBuilder, data: PileOn, columns: Columns, held: _Held, strengthen: bool
) -> None:
    """(2): per station and SKU, covered lines and prospects need stock that is there or comes."""
    line_place = columns.at[columns.place] * data.skus + data.line_sku[columns.line]
    asking = np.bincount(line_place, minlength=data.stations * data.skus)
    # Where one line alone asks for a SKU, (8) says the same and more.
    needed = (asking > (1 if strengthen else 0)) | (data.shortage.ravel() > 0)
    place = np.flatnonzero(needed)
    row_of = _numbering(place, needed.size)
    row, entry = held.places.of(place)
    lines = np.flatnonzero(row_of[line_place] >= 0)
    units, at = data.line_units[columns.line[lines]], row_of[line_place[lines]]
    demand = [(at, columns.cover[lines], units)]
    if columns.prospect.size:
        demand.append((at, columns.prospect[columns.place[lines]], units))
    short = row_of[columns.short_station * data.skus + columns.short_sku]
    builder.rows(
        place.size,
        *demand,
        (row, columns.call[held.call[entry]], -held.units[entry]),
        (short, columns.short, -1),
        upper=(data.surplus - data.shortage).ravel()[place],
    )


def _call_rows(builder: ProgramBuilder, columns: Columns) -> None:
    """(3): a pod is called to one station at most."""
    pods, row = np.unique(columns.pod, return_inverse=True)
    builder.rows(pods.size, (row, columns.call, 1), upper=1)


def _serving_rows(builder: ProgramBuilder, data: PileOn, columns: Columns, held: _Held) -> None:
    """(5): a called pod serves a placed order, unless it eases a shortage."""
    eases = np.zeros(columns.call.size, dtype=np.bool_)
    eases[held.call[data.shortage[columns.station[held.call], held.sku] > 0]] = True
    calls = np.flatnonzero(~eases)
    row_of = _numbering(calls, columns.call.size)
    lines = _Places.group(data, columns.at[columns.place], data.line_sku[columns.line])
    serving = np.flatnonzero(~eases[held.call])
    place = columns.station[held.call[serving]] * data.skus + held.sku[serving]
    position, line = lines.of(place)
    row = row_of[held.call[serving[position]]]
    # Two lines of one order share a column in `Variant.WHOLE`; it counts once.
    row, cover = np.unique(np.stack([row, columns.cover[line]]), axis=1)
    builder.rows(
        calls.size,
        (np.arange(calls.size), columns.call[calls], 1),
        (row, cover, -1),
        upper=0,
    )


def _robot_rows(builder: ProgramBuilder, data: PileOn, columns: Columns) -> None:
    """(3): a called pod that needs a robot has one, and a robot fetches one pod at most."""
    if data.fetch is None:
        return
    pods = np.unique(columns.pod[data.needs_robot[columns.pod]])
    row_of = _numbering(pods, data.pods)
    calls = np.flatnonzero(row_of[columns.pod] >= 0)
    builder.rows(
        pods.size,
        (row_of[columns.fetched], columns.fetch, 1),
        (row_of[columns.pod[calls]], columns.call[calls], -1),
        lower=0,
        upper=0,
    )
    robots, row = np.unique(columns.robot, return_inverse=True)
    builder.rows(robots.size, (row, columns.fetch, 1), upper=1)


def _order_rows(builder: ProgramBuilder, data: PileOn, columns: Columns) -> None:
    """(4) and (7): how many stations an order may go to, and when it counts as started."""
    order, index = np.arange(data.orders), np.arange(columns.order.size)
    waiting = [(columns.order, columns.prospect, 1)] if columns.prospect.size else []
    if not data.variant.many_stations:
        builder.rows(data.orders, (columns.order, columns.slot, 1), *waiting, upper=1)
        return
    builder.rows(data.orders, (order, columns.started, 1), *waiting, upper=1)
    builder.rows(
        data.orders, (order, columns.started, 1), (columns.order, columns.slot, -1), upper=0
    )
    started = columns.started[columns.order]
    builder.rows(index.size, (index, columns.slot, 1), (index, started, -1), upper=0)


def _cover_rows(builder: ProgramBuilder, data: PileOn, columns: Columns) -> None:
    """(6) and (7): how the covered lines of an order depend on its slots."""
    variant = data.variant
    if variant is Variant.WHOLE:
        return
    index = np.arange(columns.line.size)
    slot = columns.slot[columns.place]
    builder.rows(index.size, (index, columns.cover, 1), (index, slot, -1), upper=0)
    if variant is not Variant.LATER:
        places = np.arange(columns.order.size)
        builder.rows(
            places.size, (places, columns.slot, 1), (columns.place, columns.cover, -1), upper=0
        )
    line = np.arange(data.lines)
    if variant is Variant.SPLIT_STATIONS:
        started = columns.started[data.line_order]
        builder.rows(
            data.lines, (columns.line, columns.cover, 1), (line, started, -1), lower=0, upper=0
        )
        return
    if variant is Variant.SPLIT_BOTH:
        builder.rows(data.lines, (columns.line, columns.cover, 1), upper=1)
    finished = columns.complete[data.line_order]
    builder.rows(data.lines, (line, finished, 1), (columns.line, columns.cover, -1), upper=0)


def _strong_line_rows(builder: ProgramBuilder, data: PileOn, columns: Columns, held: _Held) -> None:
    """(8): a covered line needs pods with its SKU, each counted up to the units of the line."""
    place = columns.at[columns.place] * data.skus + data.line_sku[columns.line]
    surplus, units = data.surplus.ravel()[place], data.line_units[columns.line]
    lines = np.flatnonzero(surplus < units)
    row, entry = held.places.of(place[lines])
    index, units = np.arange(lines.size), units[lines]
    waiting = []
    if columns.prospect.size:
        waiting = [(index, columns.prospect[columns.place[lines]], units)]
    builder.rows(
        lines.size,
        (index, columns.cover[lines], units),
        *waiting,
        (row, columns.call[held.call[entry]], -np.minimum(held.units[entry], units[row])),
        upper=surplus[lines],
    )


def _strong_shortage_rows(
    builder: ProgramBuilder, data: PileOn, columns: Columns, held: _Held
) -> None:
    """(8) for shortages: an eased shortage needs pods, each counted up to the shortage."""
    units = data.shortage[columns.short_station, columns.short_sku]
    row, entry = held.places.of(columns.short_station * data.skus + columns.short_sku)
    builder.rows(
        units.size,
        (np.arange(units.size), columns.short, 1),
        (row, columns.call[held.call[entry]], np.minimum(held.units[entry], units[row])),
        lower=units,
    )


def _numbering(members: Integers, size: int) -> Integers:
    """Position of each member, -1 for all others."""
    position = np.full(size, -1)
    position[members] = np.arange(members.size)
    return position
