"""The columns of the pile-on program: what they cost, and how they become a decision.

Stations without free slots take no orders; only the others (`takers`) have order columns. In
`Variant.WHOLE` the columns z of lines *are* those of their orders, so that every row family is
written once for all variants.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solvers.models.pile_on.candidates import Candidates
from solvers.models.pile_on.data import Flags, Floats, Integers, PileOn
from solvers.models.pile_on.values import Assignment, complete, uncovered
from solvers.models.pile_on.variant import Variant
from solvers.models.program import ProgramBuilder

NONE = np.zeros(0, dtype=np.int64)


@dataclass(frozen=True)
class Columns:
    """Index of every column, by family.

    Parameters
    ----------
    takers
        Stations with free slots, shape (T,).
    pod, station
        The pod-station pairs of the calls, shape (N,).
    call
        Column x per pair, shape (N,).
    slot, prospect
        Columns y and g, shape (O, T); `prospect` is empty if prospects are not rewarded.
    line
        Columns z, shape (L, T); those of `slot` in `Variant.WHOLE`.
    complete, started
        Columns e and w, shape (O,), empty in variants that do without.
    short_station, short_sku, short
        Places of the shortages and their columns v.
    robot, fetched
        The robot-pod pairs, and `fetch`, their columns b.
    """

    takers: Integers
    pod: Integers
    station: Integers
    call: Integers
    slot: Integers
    prospect: Integers
    line: Integers
    complete: Integers
    started: Integers
    short_station: Integers
    short_sku: Integers
    short: Integers
    robot: Integers
    fetched: Integers
    fetch: Integers


def add_columns(builder: ProgramBuilder, data: PileOn, candidates: Candidates) -> Columns:
    """Add all columns to a program.

    Parameters
    ----------
    builder
        Where to add them.
    data
        The input.
    candidates
        The pairs to use.
    """
    weights, variant = data.weights, data.variant
    takers = np.flatnonzero(data.slots > 0)
    pod, station = np.nonzero(candidates.calls)
    call = builder.columns(pod.size, cost=data.call_cost[pod, station])
    line_possible = possible_lines(data, candidates)[:, takers]
    order_possible = every(line_possible, data)
    slot_possible = order_possible if variant is Variant.WHOLE else True
    slot = builder.columns(
        (data.orders, takers.size), cost=_slot_cost(data)[:, None], upper=slot_possible
    )
    line = slot[data.line_order]
    if variant is not Variant.WHOLE:
        gain = weights.line + (weights.open_line if variant is Variant.LATER else 0.0)
        line = builder.columns((data.lines, takers.size), cost=-gain, upper=line_possible)
    prospect = np.zeros((0, takers.size), dtype=np.int64)
    if weights.prospects:
        prospect = builder.columns(
            (data.orders, takers.size), cost=-weights.complete, upper=order_possible
        )
    partial = variant is Variant.LATER or variant.leaves_backlog
    short_station, short_sku = np.nonzero(data.shortage)
    robot, fetched = np.nonzero(candidates.fetches)
    fetch_cost: Floats | float = 0.0
    if data.fetch is not None:
        fetch_cost = weights.travel * data.fetch[robot, fetched]
    return Columns(
        takers=takers,
        pod=pod,
        station=station,
        call=call,
        slot=slot,
        prospect=prospect,
        line=line,
        complete=builder.columns(data.orders, cost=-weights.complete) if partial else NONE,
        started=(
            builder.columns(data.orders, cost=_start_cost(data)) if variant.many_stations else NONE
        ),
        short_station=short_station,
        short_sku=short_sku,
        short=builder.columns(
            short_sku.size, cost=weights.open_unit, upper=data.shortage[short_station, short_sku]
        ),
        robot=robot,
        fetched=fetched,
        fetch=builder.columns(robot.size, cost=fetch_cost),
    )


def decode(data: PileOn, columns: Columns, x: Floats) -> Assignment:
    """Make a decision of column values.

    Parameters
    ----------
    data
        The input.
    columns
        The columns of the program.
    x
        One whole value per column.
    """
    taken = x > 0.5
    slot = np.zeros((data.orders, data.stations), dtype=np.bool_)
    slot[:, columns.takers] = taken[columns.slot]
    pod_station = np.full(data.pods, -1)
    called = np.flatnonzero(taken[columns.call])
    pod_station[columns.pod[called]] = columns.station[called]
    pod_robot = np.full(data.pods, -1)
    going = np.flatnonzero(taken[columns.fetch])
    pod_robot[columns.fetched[going]] = columns.robot[going]
    prospect = np.full(data.orders, -1)
    if columns.prospect.size:
        prospect = _station(taken[columns.prospect], columns.takers)
    line_station = _station(taken[columns.line], columns.takers)
    return Assignment(slot, line_station, pod_station, pod_robot, prospect)


def encode(data: PileOn, columns: Columns, values: Assignment, size: int) -> Floats:
    """Make column values of a decision.

    Parameters
    ----------
    data
        The input.
    columns
        The columns of the program.
    values
        A feasible decision that uses candidate pairs only.
    size
        Number of columns of the program.
    """
    x = np.zeros(size)
    x[columns.call] = values.pod_station[columns.pod] == columns.station
    x[columns.slot] = values.slot[:, columns.takers]
    if columns.prospect.size:
        x[columns.prospect] = values.prospect[:, None] == columns.takers
    if data.variant is not Variant.WHOLE:
        x[columns.line] = values.line_station[:, None] == columns.takers
    if columns.complete.size:
        x[columns.complete] = complete(data, values)
    if columns.started.size:
        x[columns.started] = values.slot.any(axis=1)
    x[columns.short] = uncovered(data, values)[columns.short_station, columns.short_sku]
    x[columns.fetch] = values.pod_robot[columns.fetched] == columns.robot
    return x


def possible_lines(data: PileOn, candidates: Candidates) -> Flags:
    """Whether the pods that may come could cover a line at a station, shape (L, S).

    Parameters
    ----------
    data
        The input.
    candidates
        The pairs to use.
    """
    # Sums of units are exact in float64, and float products are much faster than integer ones.
    calls = candidates.calls.astype(np.float64)
    reach = data.surplus - data.shortage + calls.T @ data.stock.astype(np.float64)
    possible: Flags = (reach[:, data.line_sku] >= data.line_units).T
    return possible


def every(lines: Flags, data: PileOn) -> Flags:
    """Whether something holds for every line of an order: (L, ...) flags to (O, ...).

    Parameters
    ----------
    lines
        Flags with lines as first axis.
    data
        The input.
    """
    if not data.orders:
        return np.zeros((0, *lines.shape[1:]), dtype=np.bool_)
    return np.logical_and.reduceat(lines, data.first_line[:-1], axis=0)


def _slot_cost(data: PileOn) -> Floats:
    """Cost of a column y per order: the filled slot, and what goes with it in this variant."""
    weights, variant = data.weights, data.variant
    lines = np.diff(data.first_line)
    cost = np.full(data.orders, -weights.empty_slot)
    if variant.many_stations:
        return cost + weights.part
    cost -= data.order_worth
    if variant is Variant.WHOLE:
        cost -= weights.complete + weights.line * lines
    if variant is Variant.LATER:
        cost += weights.open_line * lines
    return cost


def _start_cost(data: PileOn) -> Floats:
    """Cost of a column w: the first part is free of the part's weight, and the worth counts."""
    cost = -data.order_worth - data.weights.part
    if data.variant is Variant.SPLIT_STATIONS:
        cost = cost - data.weights.complete
    return cost


def _station(taken: Flags, takers: Integers) -> Integers:
    """Station of the one true flag per row, or -1."""
    if not takers.size:
        return np.full(taken.shape[0], -1)
    return np.where(taken.any(axis=1), takers[taken.argmax(axis=1)], -1)
