"""Use leftover slots and stock in variants that allow partly covered orders.

Heuristics place only orders that are covered in full. A slot that stays empty can be given to a
partly covered order. The uncovered lines of this order wait for later pods (`Variant.LATER`) or
stay in the backlog (`Variant.SPLIT_TIME` and `Variant.SPLIT_BOTH`).
"""

from __future__ import annotations

import numpy as np

from rmfs.solvers.models.pile_on.data import Integers, PileOn
from rmfs.solvers.models.pile_on.values import Assignment, called_supply, demand
from rmfs.solvers.models.pile_on.variant import Variant


def cover_rest(data: PileOn, values: Assignment) -> Assignment:
    """Fill empty slots with partly covered orders as long as that improves the objective.

    Parameters
    ----------
    data
        The input.
    values
        A feasible decision in which every order with a slot is covered in full.

    Returns
    -------
    A feasible decision that is at least as good as the given one. In variants without partly
    covered orders, the given decision is returned unchanged.
    """
    if data.variant not in (Variant.LATER, Variant.SPLIT_TIME, Variant.SPLIT_BOTH):
        return values
    slot, line_station = values.slot.copy(), values.line_station.copy()
    prospect = values.prospect.copy()
    left = data.surplus + called_supply(data, values) - data.shortage - demand(data, values)
    free = data.slots - slot.sum(axis=0)
    for station in np.flatnonzero(free > 0).tolist():
        while free[station] > 0:
            # A prospect holds stock back; it stays a prospect.
            waiting = ~slot.any(axis=1) & (prospect < 0)
            order, lines = _best_part(data, left[station], waiting)
            if order < 0:
                break
            slot[order, station] = True
            line_station[lines] = station
            left[station, data.line_sku[lines]] -= data.line_units[lines]
            free[station] -= 1
    return Assignment(slot, line_station, values.pod_station, values.pod_robot, prospect)


def _best_part(
    data: PileOn, left: Integers, waiting: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]
) -> tuple[int, Integers]:
    """The waiting order with the greatest gain at a station, and its covered lines; -1 if none."""
    none = np.zeros(0, dtype=np.int64)
    if not waiting.any():
        return -1, none
    weights = data.weights
    covered = left[data.line_sku] >= data.line_units
    lines = np.diff(data.first_line)
    count = np.add.reduceat(covered.astype(np.int64), data.first_line[:-1])
    gain = weights.empty_slot + data.order_worth + weights.line * count
    gain = gain + data.reward * (count == lines)
    if data.variant is Variant.LATER:
        gain = gain - weights.open_line * (lines - count)
    else:
        waiting = waiting & (count > 0)
    gain = np.where(waiting, gain, -np.inf)
    order = int(gain.argmax())
    if not gain[order] > 0:
        return -1, none
    own = np.arange(data.first_line[order], data.first_line[order + 1])
    return order, own[covered[own]]
