"""A partial decision, which heuristics extend step by step.

It contains only orders that are covered in full, which every variant allows. For the candidate pods
of a station, it computes how much would be gained by calling each of them, and which set of them
would complete one order at the least cost.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from rmfs.solvers.models.pile_on.candidates import Candidates
from rmfs.solvers.models.pile_on.columns import every
from rmfs.solvers.models.pile_on.data import Flags, Floats, Integers, PileOn
from rmfs.solvers.models.pile_on.values import Assignment

TABLE_ENTRY = 1 / 32
"""Time to process a table entry (pod and line), relative to a nonzero of a program; it converts
table entries to `Solution.built`."""


@dataclass(frozen=True)
class Call:
    """Pods to be called to a station together, and the gain from calling them."""

    gain: float
    station: int
    pods: tuple[int, ...]


@dataclass(frozen=True)
class Offers:
    """The pairs of a pod and a line whose SKU the pod holds, as a sparse list.

    Parameters
    ----------
    pod, line, units
        One entry per pair, sorted by pod, then line; `units` is the pod's stock of the SKU.
    match
        Index of the match to which each entry belongs. A *match* is a pair of a pod and an order
        such that the pod holds a SKU of the order.
    match_pod, match_order
        Pod and order of each match.
    """

    pod: Integers
    line: Integers
    units: Integers
    match: Integers
    match_pod: Integers
    match_order: Integers

    @classmethod
    def of(cls, data: PileOn) -> Offers:
        """Return the pairs of a pod and a line in an input."""
        pod, line = np.nonzero(data.stock[:, data.line_sku])
        order = data.line_order[line]
        new = (np.diff(pod, prepend=-1) != 0) | (np.diff(order, prepend=-1) != 0)
        units = data.stock[pod, data.line_sku[line]]
        return cls(pod, line, units, np.cumsum(new) - 1, pod[new], order[new])


class PartialAssignment:
    """Orders placed and pods called so far.

    Parameters
    ----------
    data
        The input.
    candidates
        The pairs of pod and station, order and station, and robot and pod that may be used.

    Attributes
    ----------
    scored
        Number of orders, and of pairs of pod and line, examined so far: the deterministic work of a
        heuristic.
    built
        Effort of preparing the tables, in the unit of `Solution.built`.
    """

    def __init__(self, data: PileOn, candidates: Candidates) -> None:
        self.data = data
        self.candidates = candidates
        self.scored = 0
        self.built = TABLE_ENTRY * data.pods * data.lines
        self.slots = data.slots.copy()
        self.stock_left = data.surplus.copy()
        self.shortage = data.shortage.copy()
        self.order_station = np.full(data.orders, -1)
        self.prospect = np.full(data.orders, -1)
        self.pod_station = np.full(data.pods, -1)
        self.robots = data.free_robots
        self._rank = np.lexsort((data.order_units, -data.order_worth))
        self._offers = Offers.of(data)
        self._pods_of = [np.flatnonzero(calls) for calls in candidates.calls.T]
        self._fetch = self._fetch_costs()

    @property
    def open_orders(self) -> Flags:
        """Whether each order has no slot yet and is not a prospect, shape (O,)."""
        return (self.order_station < 0) & (self.prospect < 0)

    def coverable(self, station: int) -> Flags:
        """Return whether the stock left in a station's pods covers each order, shape (O,).

        The result is False for orders that have a slot, are prospects, or may not be assigned to
        the station.
        """
        left = self.stock_left[station, self.data.line_sku]
        self.scored += self.data.orders
        covered = every(left >= self.data.line_units, self.data)
        return covered & self.open_orders & self.candidates.places[:, station]

    def place(self, order: int, station: int) -> None:
        """Give an order a slot, and take its units from the remaining stock."""
        self._take(order, station)
        self.order_station[order] = station
        self.slots[station] -= 1

    def fill(self, station: int) -> None:
        """Place coverable orders in free slots, by greatest `worth`, then fewest units, then index.

        Among orders with the same worth, small ones take precedence because they leave the most
        stock for the others.
        """
        while self.slots[station] > 0:
            ready = self.coverable(station)[self._rank]
            if not ready.any():
                return
            self.place(int(self._rank[ready.argmax()]), station)

    def reserve(self, station: int) -> None:
        """Choose prospects at a station, in the same sequence as `fill`.

        A *prospect* is an order that gets no slot, although the remaining stock covers it in full.
        Its units are taken from this stock.
        """
        if not self.data.weights.prospects or not self.data.slots[station]:
            return
        while (ready := self.coverable(station)[self._rank]).any():
            order = int(self._rank[ready.argmax()])
            self._take(order, station)
            self.prospect[order] = station

    def _take(self, order: int, station: int, sign: int = 1) -> None:
        """Take the units of an order from the stock left at a station, or give them back."""
        data = self.data
        lines = slice(data.first_line[order], data.first_line[order + 1])
        self.stock_left[station, data.line_sku[lines]] -= sign * data.line_units[lines]

    def call(self, call: Call) -> None:
        """Call pods to a station; their stock is used first to ease shortages."""
        for pod in call.pods:
            self.pod_station[pod] = call.station
            eased = np.minimum(self.shortage[call.station], self.data.stock[pod])
            self.shortage[call.station] -= eased
            self.stock_left[call.station] += self.data.stock[pod] - eased
            if self.data.needs_robot[pod]:
                self._send_robot(pod)

    def free_pods(self, station: int) -> Integers:
        """Return the uncalled candidate pods of a station that have a robot or can get one."""
        pods = self._pods_of[station]
        return pods[(self.pod_station[pods] < 0) & np.isfinite(self._fetch[pods])]

    def call_costs(self, pods: Integers, station: int) -> Floats:
        """Return the cost of calling each pod, including the drive of the nearest free robot."""
        cost: Floats = self.data.call_cost[pods, station] + self._fetch[pods]
        return cost

    def completions(self, pods: Integers, station: int) -> tuple[Floats, Floats]:
        """Return the number, and the total units, of the orders that each pod would complete.

        Both arrays have one entry per pod. Orders that have a slot or are prospects do not count.
        Each of the other orders is compared separately with the stock of the pod and the stock left
        in the station's pods, so the same stock may count for several orders.
        """
        offers, need = self._offers, self._needs(station)
        lacking = need > 0
        # An order is complete if the pod has enough of as many lines as it lacks.
        met = lacking[offers.line] & (offers.units >= need[offers.line])
        self.scored += met.size
        served = np.bincount(offers.match, met, minlength=offers.match_order.size)
        lines = np.bincount(self.data.line_order, lacking, minlength=self.data.orders)
        done = (served > 0) & (served == lines[offers.match_order])
        count = np.bincount(offers.match_pod, done, minlength=self.data.pods)
        units = done * self.data.order_units[offers.match_order]
        of_them = np.bincount(offers.match_pod, units, minlength=self.data.pods)
        return count[pods].astype(np.float64), of_them[pods].astype(np.float64)

    def easing(self, pods: Integers, station: int) -> Integers:
        """Return the units of a station's shortage that each pod could ease, one entry per pod."""
        skus = np.flatnonzero(self.shortage[station])
        stock = self.data.stock[pods[:, None], skus]
        eased: Integers = np.minimum(stock, self.shortage[station, skus]).sum(axis=1)
        return eased

    def best_call(self, station: int) -> Call | None:
        """Return the call with the greatest gain at a station; None if no gain is positive.

        The gain of a pod is the value of the slots that it fills, the prospects that it makes
        possible and the shortage that it eases, minus the cost of calling it. If the pod with the
        greatest gain fills no slot although one is free, it is compared with the cheapest set of
        pods that completes an order.
        """
        pods = self.free_pods(station)
        if not pods.size or (not self.slots[station] and not self.shortage[station].any()):
            return None
        weights, cost = self.data.weights, self.call_costs(pods, station)
        done = units = np.zeros(pods.size)
        if self.slots[station]:
            done, units = self.completions(pods, station)
        filled = np.minimum(done, self.slots[station])
        eased = self.easing(pods, station)
        rewarded = done if weights.prospects else filled
        # without prospects: as many units as the mean of the orders that could be filled
        units = units * (rewarded / np.maximum(done, 1.0))
        gain = weights.empty_slot * filled + weights.complete * rewarded + weights.unit * units
        gain = gain + weights.open_unit * eased - cost
        gain[(filled == 0) & (eased == 0)] = -np.inf
        best = int(gain.argmax())
        single = Call(float(gain[best]), station, (int(pods[best]),))
        if filled[best] > 0 or not self.slots[station]:
            return single if single.gain > 0 else None
        together = self._best_set(pods, cost, station)
        options = [call for call in (single, together) if call is not None and call.gain > 0]
        return max(options, key=lambda call: call.gain, default=None)

    def best_prospect_call(self, station: int) -> Call | None:
        """Return the best pod to call for prospects; None if no call is worth its cost.

        By constraint (5) of `program`, the pod must serve an order with a slot at the station. If
        it serves no order already placed there, one of the prospects must take the slot of a placed
        order. If another called pod serves only one placed order, that order must stay.
        """
        pods = self.free_pods(station)
        if self._spare_order(station) < 0:
            pods = pods[self._useful(station)[pods]]
        if not pods.size or not self.data.weights.prospects:
            return None
        done, units = self.completions(pods, station)
        gain = self.data.weights.complete * done + self.data.weights.unit * units
        gain = gain - self.call_costs(pods, station)
        best = int(gain.argmax())
        return Call(float(gain[best]), station, (int(pods[best]),)) if gain[best] > 0 else None

    def settle_prospects(self, call: Call) -> None:
        """Make prospects of the orders without a slot that the called pods can serve.

        A prospect is an order that gets no slot now, but that pods called to the station could
        complete. If the called pods serve no order with a slot, one of the prospects takes the slot
        of an order, which becomes a prospect in turn. If this is impossible, the call is cancelled.
        """
        station, pods = call.station, np.array(call.pods)
        new = np.flatnonzero(self.prospect < 0)
        self.reserve(station)
        if self._useful(station)[pods].all():
            return
        spare = self._spare_order(station)
        new = new[self.prospect[new] == station]
        ready = new[self._holds(pods, new).any(axis=0)]
        if spare < 0 or not ready.size:
            self._take_back(call, new)
            return
        promoted = ready[self.data.order_worth[ready].argmax()]
        self.order_station[promoted], self.prospect[promoted] = station, -1
        self.order_station[spare], self.prospect[spare] = -1, station

    def _take_back(self, call: Call, new: Integers) -> None:
        """Undo a call that was made only for prospects; its robot is not released."""
        for order in new.tolist():
            self._take(order, call.station, -1)
            self.prospect[order] = -1
        pods = np.array(call.pods)
        self.stock_left[call.station] -= self.data.stock[pods].sum(axis=0)
        self.pod_station[pods] = -1

    def _useful(self, station: int) -> Flags:
        """Whether each pod holds a SKU of an order placed at a station, shape (P,)."""
        placed = (self.order_station == station)[self._offers.match_order]
        useful = np.zeros(self.data.pods, dtype=np.bool_)
        useful[self._offers.match_pod[placed]] = True
        return useful

    def _holds(self, pods: Integers, orders: Integers) -> Flags:
        """Whether each pod holds a SKU of each order."""
        data = self.data
        asked = np.zeros((orders.size, data.skus), dtype=np.float32)
        line = np.flatnonzero(np.isin(data.line_order, orders))
        asked[np.searchsorted(orders, data.line_order[line]), data.line_sku[line]] = 1
        holds: Flags = (data.stock[pods] > 0).astype(np.float32) @ asked.T > 0
        return holds

    def _spare_order(self, station: int) -> int:
        """The placed order of least worth that no called pod depends on; -1 if there is none."""
        orders = np.flatnonzero(self.order_station == station)
        called = np.flatnonzero(self.pod_station == station)
        serves = self._holds(called, orders)
        needed = (serves & (serves.sum(axis=1) == 1)[:, None]).any(axis=0)
        spare = orders[~needed]
        return int(spare[self.data.order_worth[spare].argmin()]) if spare.size else -1

    def _best_set(self, pods: Integers, cost: Floats, station: int) -> Call | None:
        """Return the cheapest set of pods that completes one order, one pod per missing line."""
        data, offers, need = self.data, self._offers, self._needs(station)
        lacking = need > 0
        if not lacking.any():
            return None
        cost_of = np.full(data.pods, np.inf)
        cost_of[pods] = cost
        price = np.where(offers.units >= need[offers.line], cost_of[offers.pod], np.inf)
        self.scored += price.size
        dearest = np.full(data.lines, np.inf)
        np.minimum.at(dearest, offers.line, price)
        total = np.bincount(data.line_order[lacking], dearest[lacking], minlength=data.orders)
        total[np.bincount(data.line_order, lacking, minlength=data.orders) == 0] = np.inf
        order = int(total.argmin())
        if not np.isfinite(total[order]):
            return None
        chosen = []
        for line in range(data.first_line[order], data.first_line[order + 1]):
            if lacking[line]:
                own = np.flatnonzero(offers.line == line)
                chosen.append(int(offers.pod[own[price[own].argmin()]]))
        together = np.unique(chosen)
        if data.fetch is not None and data.needs_robot[together].sum() > self.robots.size:
            return None
        gain = data.weights.empty_slot + data.reward[order] + data.order_worth[order]
        gain = gain - total[order]
        return Call(float(gain), station, tuple(together.tolist()))

    def _needs(self, station: int) -> Integers:
        """Units that lines of open orders lack at a station, 0 for other lines, shape (L,)."""
        data = self.data
        waiting = self.open_orders & self.candidates.places[:, station]
        lacks = np.maximum(data.line_units - self.stock_left[station, data.line_sku], 0)
        need: Integers = np.where(waiting[data.line_order], lacks, 0)
        return need

    def _send_robot(self, pod: int) -> None:
        """Take the nearest free robot out of the fleet."""
        assert self.data.fetch is not None
        nearest = self.data.fetch[self.robots, pod].argmin()
        self.robots = np.delete(self.robots, nearest)
        self._fetch = self._fetch_costs()

    def _fetch_costs(self) -> Floats:
        """Cost of the nearest free robot per pod: 0 if none is needed, inf if none is left."""
        if self.data.fetch is None:
            return np.zeros(self.data.pods)
        if not self.robots.size:
            return np.where(self.data.needs_robot, np.inf, 0.0)
        nearest = self.data.weights.travel * self.data.fetch[self.robots].min(axis=0)
        return np.where(self.data.needs_robot, nearest, 0.0)


def decision(partial: PartialAssignment) -> Assignment:
    """Turn a partial assignment into a decision, with robots assigned at the least total cost.

    Parameters
    ----------
    partial
        The partial assignment.
    """
    data = partial.data
    slot = np.zeros((data.orders, data.stations), dtype=np.bool_)
    placed = np.flatnonzero(partial.order_station >= 0)
    slot[placed, partial.order_station[placed]] = True
    return Assignment(
        slot=slot,
        line_station=partial.order_station[data.line_order],
        pod_station=partial.pod_station,
        pod_robot=assign_robots(data, partial.pod_station),
        prospect=partial.prospect,
    )


def assign_robots(data: PileOn, pod_station: Integers) -> Integers:
    """Assign free robots to the called pods at the least total cost.

    Parameters
    ----------
    data
        The input.
    pod_station
        Station to which each pod is called, or -1 if it is not called, shape (P,). There must be
        enough free robots.

    Returns
    -------
    The free robot that fetches each pod, shape (P,); -1 if the pod is not called or needs no free
    robot.
    """
    pod_robot = np.full(data.pods, -1)
    pods = np.flatnonzero((pod_station >= 0) & data.needs_robot)
    if data.fetch is not None and pods.size:
        row, column = linear_sum_assignment(data.fetch[np.ix_(data.free_robots, pods)])
        pod_robot[pods[column]] = data.free_robots[row]
    return pod_robot


def drop_idle(partial: PartialAssignment) -> None:
    """Cancel the calls of pods that are no longer needed, starting with the most expensive call.

    Parameters
    ----------
    partial
        The partial assignment, changed in place. Robots are not released.
    """
    data = partial.data
    called = np.flatnonzero(partial.pod_station >= 0)
    cost = data.call_cost[called, partial.pod_station[called]]
    for pod in called[np.lexsort((called, -cost))].tolist():
        station = partial.pod_station[pod]
        # What is left without the pod must still cover all that was placed or eased.
        if np.all(data.stock[pod] <= partial.stock_left[station]):
            partial.stock_left[station] -= data.stock[pod]
            partial.pod_station[pod] = -1
