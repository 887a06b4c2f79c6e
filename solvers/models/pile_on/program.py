r"""The pile-on models as an integer linear program, for every back end.

Columns (binary but for v): x_ps pod called, y_os slot taken, z_ls line covered, g_os prospect (could
be filled, gets no slot), e_o order complete, w_o order started, b_rp robot fetches, v_sk open units
left. In `Variant.WHOLE` an order is covered as a whole: z_ls = y_os and e_o = sum_s y_os, so that
only x, y, g, b, v remain. That is M1G with h = y + g substituted (y <= h holds by itself), with the
empty slots u_s = C_s - sum_o y_os, and without its link columns d: "2 d_ops <= y_os + x_ps, x_ps <=
sum_o d_ops" says just that a called pod shares a SKU with an order placed there, which is (5).

.. math::

    (1)\quad & \textstyle\sum_o y_{os} \le C_s \\
    (2)\quad & \textstyle\sum_l q_l (z_{ls} + g_{o(l)s}) \le surplus_{sk} - shortage_{sk}
               + v_{sk} + \sum_p a_{pk} x_{ps} \quad (l \text{ with SKU } k) \\
    (3)\quad & \textstyle\sum_s x_{ps} \le 1, \qquad
               \sum_r b_{rp} = \sum_s x_{ps}, \qquad \sum_p b_{rp} \le 1 \\
    (4)\quad & \textstyle\sum_s (y_{os} + g_{os}) \le 1 \\
    (5)\quad & x_{ps} \le \textstyle\sum_{l: a_{p k(l)} > 0} z_{ls} + [p \text{ eases a shortage}] \\
    (6)\quad & z_{ls} \le y_{os}, \qquad y_{os} \le \textstyle\sum_{l \in o} z_{ls}
               \;(\text{split}), \qquad e_o \le \textstyle\sum_s z_{ls} \\
    (7)\quad & y_{os} \le w_o \le \textstyle\sum_s y_{os}, \qquad
               w_o + \sum_s g_{os} \le 1, \qquad \sum_s z_{ls} \le 1 \text{ or} = w_o
               \quad (\text{split over stations, instead of (4)}) \\
    (8)\quad & q_l (z_{ls} + g_{os}) \le \min(q_l, surplus_{sk})
               + \textstyle\sum_p \min(q_l, a_{pk}) x_{ps}

(8) is ours: implied for whole numbers, it cuts off the fractions of a well-stocked pod that (2)
leaves to the relaxation, and is what makes the bound good.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solvers.models.pile_on.candidates import Candidates
from solvers.models.pile_on.columns import Columns, add_columns, decode, encode
from solvers.models.pile_on.data import Floats, Integers, PileOn
from solvers.models.pile_on.values import Assignment
from solvers.models.pile_on.variant import Variant
from solvers.models.program import LinearProgram, ProgramBuilder


@dataclass(frozen=True)
class Formulation:
    """The program of one input, and the way from its columns to a decision and back."""

    data: PileOn
    columns: Columns
    program: LinearProgram

    def decode(self, x: Floats) -> Assignment:
        """Make a decision of column values."""
        return decode(self.data, self.columns, x)

    def encode(self, values: Assignment) -> Floats:
        """Make column values of a feasible decision that uses candidate pairs only."""
        return encode(self.data, self.columns, values, self.program.columns)


def formulate(data: PileOn, candidates: Candidates, *, strengthen: bool = True) -> Formulation:
    """State the program of an input.

    Parameters
    ----------
    data
        The input.
    candidates
        The pairs to use.
    strengthen
        Whether to add (8). Default: yes.
    """
    builder = ProgramBuilder()
    columns = add_columns(builder, data, candidates)
    held = _held(data, columns)
    _slot_rows(builder, data, columns)
    _supply_rows(builder, data, columns, held, strengthen)
    _call_rows(builder, data, columns, held)
    _robot_rows(builder, data, columns)
    _order_rows(builder, data, columns)
    if strengthen:
        _strong_line_rows(builder, data, columns, held)
        _strong_shortage_rows(builder, data, columns, held)
    return Formulation(data, columns, builder.build(data.weights.empty_slot * int(data.slots.sum())))


@dataclass(frozen=True)
class _Held:
    """What the pods of the call columns hold of the wanted SKUs, one row per entry.

    `call` numbers the pair, `sku` and `units` say what it brings; sorted by (station, SKU), where
    `start[s * K + k]` is the first entry of a place.
    """

    call: Integers
    sku: Integers
    units: Integers
    start: Integers


def _held(data: PileOn, columns: Columns) -> _Held:
    """Collect the wanted stock behind each call column."""
    entry, column = np.nonzero(data.stock[np.ix_(columns.pod, data.wanted)])
    sku = data.wanted[column]
    place = columns.station[entry] * data.skus + sku
    order = np.argsort(place, kind="stable")
    entry, sku = entry[order], sku[order]
    start = np.searchsorted(place[order], np.arange(data.stations * data.skus + 1))
    return _Held(entry, sku, data.stock[columns.pod[entry], sku], start)


def _entries_of(held: _Held, place: Integers) -> tuple[Integers, Integers]:
    """Rows (position in `place`) and entries of `held` for a list of (station, SKU) places."""
    count = held.start[place + 1] - held.start[place]
    row = np.repeat(np.arange(place.size), count)
    first = np.repeat(held.start[place] - np.cumsum(count) + count, count)
    return row, first + np.arange(row.size)


def _slot_rows(builder: ProgramBuilder, data: PileOn, columns: Columns) -> None:
    """(1): no station takes more orders than it has slots."""
    takers = columns.takers
    row = np.arange(takers.size)
    builder.rows(takers.size, (row, columns.slot, 1), upper=data.slots[takers])


def _supply_rows(
    builder: ProgramBuilder, data: PileOn, columns: Columns, held: _Held, strengthen: bool
) -> None:
    """(2): per station and SKU, covered lines and prospects fit the stock that is there or comes."""
    asking = np.bincount(data.line_sku, minlength=data.skus)
    needed = np.zeros((data.stations, data.skus), dtype=np.bool_)
    # Where one line alone asks for a SKU, (8) says the same and more.
    needed[columns.takers] = asking > (1 if strengthen else 0)
    needed |= (data.shortage > 0)
    place = np.flatnonzero(needed)
    row_of = np.full(needed.size, -1)
    row_of[place] = np.arange(place.size)
    entry_row, entry = _entries_of(held, place)
    line_row = row_of[columns.takers * data.skus + data.line_sku[:, None]]
    line, taker = np.nonzero(line_row >= 0)
    row, units = line_row[line, taker], data.line_units[line]
    demand = [(row, columns.line[line, taker], units)]
    if columns.prospect.size:
        demand.append((row, columns.prospect[data.line_order[line], taker], units))
    short_row = row_of[columns.short_station * data.skus + columns.short_sku]
    builder.rows(
        place.size,
        *demand,
        (entry_row, columns.call[held.call[entry]], -held.units[entry]),
        (short_row, columns.short, -1),
        upper=(data.surplus - data.shortage).ravel()[place],
    )


def _call_rows(builder: ProgramBuilder, data: PileOn, columns: Columns, held: _Held) -> None:
    """(3) a pod goes to one station at most, and (5) it serves somebody there."""
    pods, row = np.unique(columns.pod, return_inverse=True)
    builder.rows(pods.size, (row, columns.call, 1), upper=1)
    eases = np.zeros(columns.call.size, dtype=np.bool_)
    eases[held.call[data.shortage[columns.station[held.call], held.sku] > 0]] = True
    serving = np.flatnonzero(~eases)
    row_of = np.full(columns.call.size, -1)
    row_of[serving] = np.arange(serving.size)
    taker_of = np.full(data.stations, -1)
    taker_of[columns.takers] = np.arange(columns.takers.size)
    kept = (row_of[held.call] >= 0) & (taker_of[columns.station[held.call]] >= 0)
    call, sku = held.call[kept], held.sku[kept]
    # All lines of each held SKU, laid out entry by entry.
    by_sku = np.argsort(data.line_sku, kind="stable")
    first = np.searchsorted(data.line_sku[by_sku], np.arange(data.skus + 1))
    count = first[sku + 1] - first[sku]
    entry = np.repeat(np.arange(sku.size), count)
    offset = np.arange(entry.size) - np.repeat(np.cumsum(count) - count, count)
    line = by_sku[first[sku][entry] + offset]
    served = columns.line[line, taker_of[columns.station[call[entry]]]]
    # Two lines of one order share a column in `Variant.WHOLE`; it counts once.
    pairs = np.unique(np.stack([row_of[call[entry]], served]), axis=1)
    builder.rows(
        serving.size,
        (np.arange(serving.size), columns.call[serving], 1),
        (pairs[0], pairs[1], -1),
        upper=0,
    )


def _robot_rows(builder: ProgramBuilder, data: PileOn, columns: Columns) -> None:
    """(3): a called pod that needs a robot has one, and a robot fetches one pod at most."""
    if data.fetch is None:
        return
    pods = np.unique(columns.pod[data.needs_robot[columns.pod]])
    row_of = np.full(data.pods, -1)
    row_of[pods] = np.arange(pods.size)
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
    """(4), (6) and (7): what the variant asks of the slots and lines of an order."""
    variant, takers = data.variant, columns.takers.size
    order, line = np.arange(data.orders)[:, None], np.arange(data.lines)[:, None]
    waiting = [(order, columns.prospect, 1)] if columns.prospect.size else []
    if variant.many_stations:
        started = columns.started[:, None]
        builder.rows(data.orders, (order, started, 1), *waiting, upper=1)
        builder.rows(data.orders, (order, started, 1), (order, columns.slot, -1), upper=0)
        pair = np.arange(data.orders * takers).reshape(data.orders, takers)
        builder.rows(pair.size, (pair, columns.slot, 1), (pair, started, -1), upper=0)
    else:
        builder.rows(data.orders, (order, columns.slot, 1), *waiting, upper=1)
    if variant is Variant.WHOLE:
        return
    pair = np.arange(data.lines * takers).reshape(data.lines, takers)
    slot = columns.slot[data.line_order]
    builder.rows(pair.size, (pair, columns.line, 1), (pair, slot, -1), upper=0)
    if variant is not Variant.LATER:
        pair = np.arange(data.orders * takers).reshape(data.orders, takers)
        builder.rows(
            pair.size,
            (pair, columns.slot, 1),
            (pair[data.line_order], columns.line, -1),
            upper=0,
        )
    if variant is Variant.SPLIT_STATIONS:
        started = columns.started[data.line_order][:, None]
        builder.rows(data.lines, (line, columns.line, 1), (line, started, -1), lower=0, upper=0)
        return
    if variant is Variant.SPLIT_BOTH:
        builder.rows(data.lines, (line, columns.line, 1), upper=1)
    finished = columns.complete[data.line_order][:, None]
    builder.rows(data.lines, (line, finished, 1), (line, columns.line, -1), upper=0)


def _strong_line_rows(
    builder: ProgramBuilder, data: PileOn, columns: Columns, held: _Held
) -> None:
    """(8): a covered line needs its own pods, counted no higher than the line is long."""
    surplus = data.surplus[columns.takers][:, data.line_sku].T
    line, taker = np.nonzero(surplus < data.line_units[:, None])
    units = data.line_units[line]
    place = columns.takers[taker] * data.skus + data.line_sku[line]
    row, entry = _entries_of(held, place)
    index = np.arange(line.size)
    waiting = []
    if columns.prospect.size:
        waiting = [(index, columns.prospect[data.line_order[line], taker], units)]
    builder.rows(
        line.size,
        (index, columns.line[line, taker], units),
        *waiting,
        (row, columns.call[held.call[entry]], -np.minimum(held.units[entry], units[row])),
        upper=surplus[line, taker],
    )


def _strong_shortage_rows(
    builder: ProgramBuilder, data: PileOn, columns: Columns, held: _Held
) -> None:
    """(8) for open demand: what is not left open is brought by pods, each counted up to the need."""
    units = data.shortage[columns.short_station, columns.short_sku]
    row, entry = _entries_of(held, columns.short_station * data.skus + columns.short_sku)
    builder.rows(
        units.size,
        (np.arange(units.size), columns.short, 1),
        (row, columns.call[held.call[entry]], np.minimum(held.units[entry], units[row])),
        lower=units,
    )
