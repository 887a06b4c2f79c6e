r"""A joint decision on orders, pods and robots, its cost, and its feasibility.

The symbols of the objective are

- x_ps: pod p is called to station s, with the travel cost t_ps;
- b_rp: robot r fetches pod p, with the travel cost f_rp;
- C_s: number of free slots of station s; n_s: number of slots that the decision takes there;
- v_sk: units of open demand for SKU k at station s that the decision leaves uncovered;
- c_o: order o is covered in full, or is a prospect; q_o: its units; worth_o: extra reward for
  giving it a slot; m_o: number of slots that it takes;
- z_l: line l is covered; o(l): its order.

The other names are those of `Weights`:

.. math::

    \min\ & \sum_{p,s} (visit + travel \cdot t_{ps})\, x_{ps} + travel \sum_{r,p} f_{rp}\, b_{rp}
        + empty\_slot \sum_s (C_s - n_s) + open\_unit \sum_{s,k} v_{sk} \\
    & - \sum_o (complete + unit\, q_o)\, c_o - line \sum_l z_l - \sum_o worth_o [m_o > 0]
        + open\_line \sum_{l: m_{o(l)} > 0} (1 - z_l) + part \sum_o (m_o - 1)^+

where the `open_line` term applies only in `Variant.LATER`. With the default weights, in
`Variant.WHOLE` and with robots assigned, this is the objective of the model M1G (Jiao et al. 2025,
eq. 14), except that prospects at stations without free slots are not rewarded. Here, c_o replaces
h_o of the paper ("order could be filled").
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rmfs.solvers.models.pile_on.data import Flags, Integers, PileOn
from rmfs.solvers.models.pile_on.variant import Variant


@dataclass(frozen=True)
class Assignment:
    """A joint decision on orders, pods and robots.

    Parameters
    ----------
    slot
        Whether an order (or a part of it) takes a slot at a station, shape (O, S).
    line_station
        Station whose pods cover a line now, or -1, shape (L,).
    pod_station
        Station to which a pod is newly called, or -1, shape (P,).
    pod_robot
        Robot that fetches a called pod, or -1, shape (P,).
    prospect
        Station at which an order is a prospect, or -1, shape (O,). A prospect gets no slot,
        although its station has free slots before the decision, and the pods of the station could
        serve the order in full, in addition to the other orders.
    """

    slot: Flags
    line_station: Integers
    pod_station: Integers
    pod_robot: Integers
    prospect: Integers


def nothing(data: PileOn) -> Assignment:
    """Return the empty decision, which is feasible for every input and variant.

    Parameters
    ----------
    data
        The input.
    """
    return Assignment(
        slot=np.zeros((data.orders, data.stations), dtype=np.bool_),
        line_station=np.full(data.lines, -1),
        pod_station=np.full(data.pods, -1),
        pod_robot=np.full(data.pods, -1),
        prospect=np.full(data.orders, -1),
    )


def demand(data: PileOn, values: Assignment) -> Integers:
    """Return the units that covered lines and prospects take at each station, shape (S, K).

    Parameters
    ----------
    data
        The input.
    values
        The decision.
    """
    wanted = np.zeros((data.stations, data.skus), dtype=np.int64)
    for station in (values.line_station, values.prospect[data.line_order]):
        at = np.flatnonzero(station >= 0)
        np.add.at(wanted, (station[at], data.line_sku[at]), data.line_units[at])
    return wanted


def called_supply(data: PileOn, values: Assignment) -> Integers:
    """Return the units that newly called pods bring to each station, shape (S, K).

    Parameters
    ----------
    data
        The input.
    values
        The decision.
    """
    supply = np.zeros((data.stations, data.skus), dtype=np.int64)
    called = np.flatnonzero(values.pod_station >= 0)
    np.add.at(supply, values.pod_station[called], data.stock[called])
    return supply


def uncovered(data: PileOn, values: Assignment) -> Integers:
    """Return the units of open demand that a decision leaves without stock, shape (S, K).

    Parameters
    ----------
    data
        The input.
    values
        The decision. If its lines and prospects take more units than the pods of a station hold,
        the excess is included, so the result can exceed `data.shortage`.
    """
    have = data.surplus + called_supply(data, values)
    return np.maximum(data.shortage + demand(data, values) - have, 0)


def complete(data: PileOn, values: Assignment) -> Flags:
    """Return whether all lines of each order are covered now, shape (O,).

    Parameters
    ----------
    data
        The input.
    values
        The decision.
    """
    covered = values.line_station >= 0
    if not data.orders:
        return np.zeros(0, dtype=np.bool_)
    return np.logical_and.reduceat(covered, data.first_line[:-1])


def cost_of_calls(data: PileOn, values: Assignment) -> float:
    """Return the cost of called pods and their robots; controllers state gaps relative to it.

    Parameters
    ----------
    data
        The input.
    values
        The decision.
    """
    called = np.flatnonzero(values.pod_station >= 0)
    cost = float(data.call_cost[called, values.pod_station[called]].sum())
    if data.fetch is not None:
        fetched = np.flatnonzero(values.pod_robot >= 0)
        cost += data.weights.travel * float(data.fetch[values.pod_robot[fetched], fetched].sum())
    return cost


def objective(data: PileOn, values: Assignment) -> float:
    """Return the objective of a decision (see the module).

    Parameters
    ----------
    data
        The input.
    values
        The decision.
    """
    weights = data.weights
    cost = cost_of_calls(data, values)
    cost += weights.empty_slot * int(data.slots.sum() - values.slot.sum())
    cost += weights.open_unit * int(uncovered(data, values).sum())
    parts = values.slot.sum(axis=1)
    covered = values.line_station >= 0
    full = complete(data, values) | (values.prospect >= 0)
    cost -= weights.complete * int(full.sum())
    cost -= weights.unit * int(data.order_units[full].sum())
    cost -= weights.line * int(covered.sum())
    cost -= float(data.order_worth[parts > 0].sum())
    if data.variant is Variant.LATER:
        cost += weights.open_line * int((~covered & (parts[data.line_order] > 0)).sum())
    return cost + weights.part * int(np.maximum(parts - 1, 0).sum())


def violations(data: PileOn, values: Assignment) -> list[str]:
    """Return messages about the constraints that a decision violates.

    Parameters
    ----------
    data
        The input.
    values
        The decision.

    Returns
    -------
    One message per kind of violation, naming its first occurrence; empty if the decision is
    feasible.
    """
    parts = values.slot.sum(axis=1)
    called = np.flatnonzero(values.pod_station >= 0)
    missing = uncovered(data, values) - data.shortage
    checks = {
        "station takes more orders than it has slots": values.slot.sum(axis=0) > data.slots,
        "stock of station does not cover what it serves": (missing > 0).any(axis=1),
        "pod is called but not available": (values.pod_station >= 0) & ~data.available,
        "pod is called to a station that may call none": (values.pod_station >= 0)
        & ~np.append(data.callable_to, True)[values.pod_station],
        "prospect is not rewarded, or has a slot": (values.prospect >= 0)
        & ((parts > 0) | (not data.weights.prospects)),
        "prospect waits for a station without slots": np.append(data.slots == 0, False)[
            values.prospect
        ],
        "called pod serves no order": _idle(data, values, called),
    }
    checks |= _order_checks(data, values, parts)
    checks |= _robot_checks(data, values)
    return [
        f"{text}: {np.flatnonzero(broken)[0]}" for text, broken in checks.items() if broken.any()
    ]


def _order_checks(data: PileOn, values: Assignment, parts: Integers) -> dict[str, Flags]:
    """Check the rules of the variant on the lines and slots of orders."""
    covered = values.line_station >= 0
    placed = parts[data.line_order] > 0
    stray = covered.copy()
    at = np.flatnonzero(covered)
    stray[at] = ~values.slot[data.line_order[at], values.line_station[at]]
    checks = {"line is covered where its order has no slot": stray}
    if not data.variant.many_stations:
        checks["order has slots at several stations"] = parts > 1
    if data.variant in (Variant.WHOLE, Variant.SPLIT_STATIONS):
        checks["placed order has an open line"] = placed & ~covered
    if data.variant.many_stations or data.variant.leaves_backlog:
        served = np.zeros_like(values.slot)
        served[data.line_order[at], values.line_station[at]] = True
        idle: Flags = np.any(values.slot & ~served, axis=1)
        checks["slot of order covers no line"] = idle
    return checks


def _idle(data: PileOn, values: Assignment, called: Integers) -> Flags:
    """Whether each pod is called but holds nothing for a served line or a shortage there."""
    asked = data.shortage > 0
    at = np.flatnonzero(values.line_station >= 0)
    asked[values.line_station[at], data.line_sku[at]] = True
    useful = ((data.stock[called] > 0) & asked[values.pod_station[called]]).any(axis=1)
    idle = np.zeros(data.pods, dtype=np.bool_)
    idle[called] = ~useful
    return idle


def _robot_checks(data: PileOn, values: Assignment) -> dict[str, Flags]:
    """Check that pods that need a robot have one, and robots fetch one pod at most."""
    fetched = values.pod_robot >= 0
    needs = data.needs_robot & (values.pod_station >= 0)
    checks = {
        "called pod has no robot": needs & ~fetched,
        "pod has a robot, but needs none": fetched & ~needs,
    }
    if data.robot_pod is not None:
        robot = values.pod_robot[fetched]
        trips = np.bincount(robot, minlength=data.robots)
        checks["robot fetches two pods, or one although it is bound"] = (trips > 1) | (
            (trips > 0) & (data.robot_pod >= 0)
        )
    return checks
