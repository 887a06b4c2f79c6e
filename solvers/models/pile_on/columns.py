"""The columns of the pile-on program: their costs, and their conversion into a decision.

The columns have the same letters as in the module `program`. A pair has a column only if it is a
candidate, and a line has a column z at a station only if the pods that may come there could cover
the line. In `Variant.WHOLE`, an order has a column y only at stations where all its lines could be
covered, and this column also serves as the column z of each of these lines. The code that adds rows
is therefore the same for all variants.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rmfs.solvers.models.names import Names
from rmfs.solvers.models.pile_on.candidates import Candidates
from rmfs.solvers.models.pile_on.data import Flags, Floats, Integers, PileOn
from rmfs.solvers.models.pile_on.values import Assignment, complete, uncovered
from rmfs.solvers.models.pile_on.variant import Variant
from rmfs.solvers.models.program import ProgramBuilder

NONE = np.zeros(0, dtype=np.int64)


@dataclass(frozen=True)
class Columns:
    """The indices of the columns of each kind, with the entities that they refer to.

    Parameters
    ----------
    pod, station, call
        Pod, station and column x of each pair of pod and station.
    order, at, slot, prospect
        Order, station, column y and column g of each *place* (pair of an order and a station to
        which it may be assigned); `prospect` is empty if prospects (see `program`) are not
        rewarded.
    line, place, cover
        Line, index of the place, and column z of each pair of a line and a place of its order at
        which the line could be covered. In `Variant.WHOLE`, z is the column y of the place.
    complete, started
        Columns e and w of each order, empty in variants that do not need them.
    short_station, short_sku, short
        Station, SKU and column v of each shortage.
    robot, fetched, fetch
        Robot, pod and column b of each pair of robot and pod.
    """

    pod: Integers
    station: Integers
    call: Integers
    order: Integers
    at: Integers
    slot: Integers
    prospect: Integers
    line: Integers
    place: Integers
    cover: Integers
    complete: Integers
    started: Integers
    short_station: Integers
    short_sku: Integers
    short: Integers
    robot: Integers
    fetched: Integers
    fetch: Integers


def add_columns(builder: ProgramBuilder, data: PileOn, candidates: Candidates) -> Columns:
    """Add all columns to a program, and return their indices.

    Parameters
    ----------
    builder
        Builder of the program.
    data
        The input.
    candidates
        The pairs of pod and station, order and station, and robot and pod that may be used.
    """
    weights, variant = data.weights, data.variant
    whole = variant is Variant.WHOLE
    pod, station = np.nonzero(candidates.calls)
    call = builder.columns(pod.size, cost=data.call_cost[pod, station])
    coverable = coverable_lines(data, candidates)
    fillable = every(coverable, data)
    order, at = np.nonzero(candidates.places & fillable if whole else candidates.places)
    slot = builder.columns(order.size, cost=_slot_cost(data)[order])
    prospect = NONE
    if weights.prospects:
        prospect = builder.columns(order.size, cost=-data.reward[order], upper=fillable[order, at])
    line, place = _lines_of(data, order)
    kept = coverable[line, at[place]]
    line, place = line[kept], place[kept]
    gain = weights.line + (weights.open_line if variant is Variant.LATER else 0.0)
    cover = slot[place] if whole else builder.columns(line.size, cost=-gain)
    partial = variant is Variant.LATER or variant.leaves_backlog
    short_station, short_sku = np.nonzero(data.shortage)
    short = builder.columns(
        short_sku.size, cost=weights.open_unit, upper=data.shortage[short_station, short_sku]
    )
    robot, fetched = np.nonzero(candidates.fetches)
    fetch_cost: Floats | float = 0.0
    if data.fetch is not None:
        fetch_cost = weights.travel * data.fetch[robot, fetched]
    return Columns(
        pod=pod,
        station=station,
        call=call,
        order=order,
        at=at,
        slot=slot,
        prospect=prospect,
        line=line,
        place=place,
        cover=cover,
        complete=builder.columns(data.orders, cost=-data.reward) if partial else NONE,
        started=(
            builder.columns(data.orders, cost=_start_cost(data)) if variant.many_stations else NONE
        ),
        short_station=short_station,
        short_sku=short_sku,
        short=short,
        robot=robot,
        fetched=fetched,
        fetch=builder.columns(robot.size, cost=fetch_cost),
    )


def decode(data: PileOn, columns: Columns, x: Floats) -> Assignment:
    """Turn column values into a decision.

    Parameters
    ----------
    data
        The input.
    columns
        The columns of the program.
    x
        One integer value per column.
    """
    taken = x > 0.5
    slot = np.zeros((data.orders, data.stations), dtype=np.bool_)
    slot[columns.order, columns.at] = taken[columns.slot]
    chosen = taken[columns.prospect]
    waiting = (columns.order[chosen], columns.at[chosen]) if columns.prospect.size else (NONE, NONE)
    covered = taken[columns.cover]
    called, going = taken[columns.call], taken[columns.fetch]
    return Assignment(
        slot=slot,
        line_station=_spread(data.lines, columns.line[covered], columns.at[columns.place[covered]]),
        pod_station=_spread(data.pods, columns.pod[called], columns.station[called]),
        pod_robot=_spread(data.pods, columns.fetched[going], columns.robot[going]),
        prospect=_spread(data.orders, *waiting),
    )


def name_columns(data: PileOn, columns: Columns, names: Names) -> None:
    """Name the columns of the program.

    Parameters
    ----------
    data
        The input.
    columns
        The columns of the program.
    names
        The object in which the names are entered.
    """
    c = columns
    if c.cover.size and data.variant is not Variant.WHOLE:
        names.block("cover", c.cover, "line_station[{l}] = {s}", l=c.line, s=c.at[c.place])
    names.block("call", c.call, "pod_station[{p}] = {s}", p=c.pod, s=c.station)
    names.block("slot", c.slot, "slot[{o}, {s}] = 1", o=c.order, s=c.at)
    if c.prospect.size:
        names.block("prospect", c.prospect, "prospect[{o}] = {s}", o=c.order, s=c.at)
    names.block("complete", c.complete, o=np.arange(c.complete.size))
    names.block("started", c.started, o=np.arange(c.started.size))
    names.block("short", c.short, s=c.short_station, k=c.short_sku)
    names.block("fetch", c.fetch, "pod_robot[{p}] = {r}", r=c.robot, p=c.fetched)


def encode(data: PileOn, columns: Columns, values: Assignment, size: int) -> Floats:
    """Turn a decision into column values.

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
    x[columns.slot] = values.slot[columns.order, columns.at]
    if columns.prospect.size:
        x[columns.prospect] = values.prospect[columns.order] == columns.at
    if data.variant is not Variant.WHOLE:
        x[columns.cover] = values.line_station[columns.line] == columns.at[columns.place]
    if columns.complete.size:
        x[columns.complete] = complete(data, values)
    if columns.started.size:
        x[columns.started] = values.slot.any(axis=1)
    x[columns.short] = uncovered(data, values)[columns.short_station, columns.short_sku]
    x[columns.fetch] = values.pod_robot[columns.fetched] == columns.robot
    return x


def coverable_lines(data: PileOn, candidates: Candidates) -> Flags:
    """Return whether each line could be covered at each station, shape (L, S).

    A line could be covered if the surplus of the station's inbound pods and the stock of all pods
    that may be called to the station suffice for it.

    Parameters
    ----------
    data
        The input.
    candidates
        The pairs of pod and station, order and station, and robot and pod that may be used.
    """
    pods = np.flatnonzero(candidates.calls.any(axis=1))
    calls, stock = candidates.calls[pods], data.stock[pods]
    # Sums of units are exact in float64, and float products are much faster than integer ones.
    coming = calls.T.astype(np.float64) @ stock[:, data.line_sku].astype(np.float64)
    coverable: Flags = (data.surplus[:, data.line_sku] + coming >= data.line_units).T
    return coverable


def every(lines: Flags, data: PileOn) -> Flags:
    """Return for each order whether a flag is set for all its lines, shape (O, ...).

    Parameters
    ----------
    lines
        Flag of each line, shape (L, ...).
    data
        The input.
    """
    if not data.orders:
        return np.zeros((0, *lines.shape[1:]), dtype=np.bool_)
    return np.logical_and.reduceat(lines, data.first_line[:-1], axis=0)


def _slot_cost(data: PileOn) -> Floats:
    """Cost of a column y per order: the reward for filling a slot, and other terms by variant."""
    weights, variant = data.weights, data.variant
    lines = np.diff(data.first_line)
    cost = np.full(data.orders, -weights.empty_slot)
    if variant.many_stations:
        return cost + weights.part
    cost -= data.order_worth
    if variant is Variant.WHOLE:
        cost -= data.reward + weights.line * lines
    if variant is Variant.LATER:
        cost += weights.open_line * lines
    return cost


def _start_cost(data: PileOn) -> Floats:
    """Cost of a column w per order: refunds the weight `part` of its first slot; adds rewards."""
    cost = -data.order_worth - data.weights.part
    if data.variant is Variant.SPLIT_STATIONS:
        cost = cost - data.reward
    return cost


def _lines_of(data: PileOn, order: Integers) -> tuple[Integers, Integers]:
    """The lines of each listed order, with the position of the order in the list."""
    count = data.first_line[order + 1] - data.first_line[order]
    place = np.repeat(np.arange(order.size), count)
    first = np.repeat(data.first_line[order] - np.cumsum(count) + count, count)
    return first + np.arange(place.size), place


def _spread(size: int, index: Integers, value: Integers) -> Integers:
    """An array of -1 with the values in their places."""
    spread = np.full(size, -1)
    spread[index] = value
    return spread
