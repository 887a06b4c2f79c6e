r"""The input of the pile-on models: one snapshot of orders, pods, stations and robots.

Sets: stations s, orders o with lines l (SKU k(l), units q_l), pods p with stock a_pk, robots r.
Earlier decisions are part of the data: the open demand of orders already at stations, inbound pods
(pods that are already assigned to a station), and robots that carry or fetch a pod. The stock of
the inbound pods of station s (the pods with :math:`p \to s`) first serves the open demand there:
:math:`open_{sk}` units of SKU k. A surplus or a shortage remains:

.. math::

    surplus_{sk}  = \max(0, \textstyle\sum_{p \to s} a_{pk} - open_{sk}), \qquad
    shortage_{sk} = \max(0, open_{sk} - \textstyle\sum_{p \to s} a_{pk})
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.checks import flags, integers, reals, require
from rmfs.solvers.models.pile_on.variant import Variant, Weights

Integers = NDArray[np.int64]
Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]


@dataclass(frozen=True)
class PileOn:
    """Input for assigning orders and pods to stations (POA, PPS) and robots to pods (TA, optional).

    Parameters
    ----------
    slots
        Free order slots per station, shape (S,).
    line_order, line_sku, line_units
        Order, SKU and units of each line of the orders to be assigned, shape (L,). Lines are sorted
        by order, then SKU; orders are numbered 0..O-1, and each has at least one line.
    stock
        Units per pod and SKU that no order has reserved yet, shape (P, K). SKUs without demand may
        be left out.
    travel
        Cost of bringing a pod to a station, shape (P, S).
    available
        Whether a pod may be called, shape (P,).
    inbound
        Station that a pod is already assigned to, shape (P,); -1: none. A pod that is assigned to a
        station is not called again.
    open_units
        Units per station and SKU that orders already at the station still need but have not
        reserved on any pod, shape (S, K).
    fetch
        Cost for each robot to reach each pod, shape (R, P). Default: none, so that no robots are
        assigned.
    robot_pod
        Pod that a robot is bound to (carries or fetches), or -1 if the robot is free, shape (R,). A
        bound robot fetches no other pod; if its pod is called, the pod needs no other robot.
        Default: all robots are free.
    worth
        Extra reward for giving an order its (first) slot, shape (O,), for example for its age or
        due time. Default: none.
    may_call
        Whether pods may be called to each station, shape (S,). A station to which no pods may be
        called receives only its inbound pods. Default: pods may be called to every station.
    variant
        How orders may be covered. Default: whole.
    weights
        The weights of the objective. Default: those of the model M1G (Jiao et al. 2025).

    Raises
    ------
    ModelError
        If a shape or value is wrong; the error names the field.
    """

    slots: Integers
    line_order: Integers
    line_sku: Integers
    line_units: Integers
    stock: Integers
    travel: Floats
    available: Flags
    inbound: Integers
    open_units: Integers
    fetch: Floats | None = None
    robot_pod: Integers | None = None
    worth: Floats | None = None
    may_call: Flags | None = None
    variant: Variant = Variant.WHOLE
    weights: Weights = field(default_factory=Weights)

    def __post_init__(self) -> None:
        stock = integers("stock", self.stock, (None, None), low=0)
        pods, skus = stock.shape
        stations = np.shape(self.slots)[0] if np.ndim(self.slots) else 0
        line_order = integers("line_order", self.line_order, (None,), low=0)
        lines = line_order.shape[0]
        orders = int(line_order[-1]) + 1 if lines else 0
        checked = {
            "slots": integers("slots", self.slots, (stations,), low=0),
            "line_order": line_order,
            "line_sku": integers("line_sku", self.line_sku, (lines,), low=0, high=skus - 1),
            "line_units": integers("line_units", self.line_units, (lines,), low=1),
            "stock": stock,
            "travel": reals("travel", self.travel, (pods, stations), low=0),
            "available": flags("available", self.available, (pods,)),
            "inbound": integers("inbound", self.inbound, (pods,), low=-1, high=stations - 1),
            "open_units": integers("open_units", self.open_units, (stations, skus), low=0),
        }
        if self.fetch is not None:
            checked["fetch"] = reals("fetch", self.fetch, (None, pods), low=0)
            robots = checked["fetch"].shape[0]
            bound = np.full(robots, -1) if self.robot_pod is None else self.robot_pod
            checked["robot_pod"] = integers("robot_pod", bound, (robots,), low=-1, high=pods - 1)
        if self.worth is not None:
            checked["worth"] = reals("worth", self.worth, (orders,), low=0)
        if self.may_call is not None:
            checked["may_call"] = flags("may_call", self.may_call, (stations,))
        for name, value in checked.items():
            object.__setattr__(self, name, value)
        self._check_relations()

    def _check_relations(self) -> None:
        """Check the conditions that involve several fields."""
        step = np.diff(self.line_order, prepend=0)
        first_is_zero = self.lines == 0 or self.line_order[0] == 0
        require(
            bool(first_is_zero and np.all((step == 0) | (step == 1))),
            "line_order",
            "must be sorted and number the orders 0, 1, 2, ... without gaps",
        )
        repeated = (step[1:] == 0) & (np.diff(self.line_sku) <= 0)
        require(
            not bool(repeated.any()), "line_sku", "must increase within an order (one line per SKU)"
        )
        taken = self.available & (self.inbound >= 0)
        require(not bool(taken.any()), "available", "must be false for a pod that is inbound")
        require(self.fetch is not None or self.robot_pod is None, "robot_pod", "needs fetch")
        if self.robot_pod is not None:
            bound = self.robot_pod[self.robot_pod >= 0]
            require(np.unique(bound).size == bound.size, "robot_pod", "binds a pod to two robots")

    @property
    def stations(self) -> int:
        """Number of stations S."""
        return int(self.slots.shape[0])

    @property
    def lines(self) -> int:
        """Number of order lines L."""
        return int(self.line_order.shape[0])

    @cached_property
    def orders(self) -> int:
        """Number of orders O."""
        return int(self.line_order[-1]) + 1 if self.lines else 0

    @property
    def pods(self) -> int:
        """Number of pods P."""
        return int(self.stock.shape[0])

    @property
    def skus(self) -> int:
        """Number of SKUs K."""
        return int(self.stock.shape[1])

    @property
    def robots(self) -> int:
        """Number of robots R; 0 if robots are not assigned (`fetch` is not given)."""
        return 0 if self.fetch is None else int(self.fetch.shape[0])

    @cached_property
    def first_line(self) -> Integers:
        """Index of the first line of each order, followed by L, shape (O + 1,)."""
        return np.searchsorted(self.line_order, np.arange(self.orders + 1)).astype(np.int64)

    @cached_property
    def supply(self) -> Integers:
        """Units that inbound pods bring, shape (S, K)."""
        supply = np.zeros((self.stations, self.skus), dtype=np.int64)
        coming = np.flatnonzero(self.inbound >= 0)
        np.add.at(supply, self.inbound[coming], self.stock[coming])
        return supply

    @cached_property
    def surplus(self) -> Integers:
        """Inbound units in excess of the open demand of their station, shape (S, K)."""
        surplus: Integers = np.maximum(self.supply - self.open_units, 0)
        return surplus

    @cached_property
    def shortage(self) -> Integers:
        """Open demand of each station in excess of its inbound units, shape (S, K)."""
        shortage: Integers = np.maximum(self.open_units - self.supply, 0)
        return shortage

    @cached_property
    def wanted(self) -> Integers:
        """The SKUs for which there is an order line or a shortage, sorted."""
        asked = np.zeros(self.skus, dtype=np.bool_)
        asked[self.line_sku] = True
        asked |= (self.shortage > 0).any(axis=0)
        return np.flatnonzero(asked)

    @cached_property
    def call_cost(self) -> Floats:
        """Weighted cost of calling a pod, excluding the robot's drive to the pod, shape (P, S)."""
        cost: Floats = self.weights.visit + self.weights.travel * self.travel
        return cost

    @cached_property
    def free_robots(self) -> Integers:
        """Indices of the robots that may fetch a pod, in ascending order."""
        if self.robot_pod is None:
            return np.zeros(0, dtype=np.int64)
        return np.flatnonzero(self.robot_pod < 0)

    @cached_property
    def needs_robot(self) -> Flags:
        """Whether a pod, if called, needs a free robot, shape (P,)."""
        needs = np.full(self.pods, self.fetch is not None)
        if self.robot_pod is not None:
            needs[self.robot_pod[self.robot_pod >= 0]] = False
        return needs

    @cached_property
    def order_units(self) -> Integers:
        """Units of each order, shape (O,)."""
        units = np.bincount(self.line_order, self.line_units, minlength=self.orders)
        return units.astype(np.int64)

    @cached_property
    def reward(self) -> Floats:
        """Reward for covering each order in full, shape (O,)."""
        reward: Floats = self.weights.complete + self.weights.unit * self.order_units.astype(float)
        return reward

    @cached_property
    def callable_to(self) -> Flags:
        """`may_call`, or all true if it was not given, shape (S,)."""
        return np.ones(self.stations, np.bool_) if self.may_call is None else self.may_call

    @cached_property
    def order_worth(self) -> Floats:
        """`worth`, or zeros if it was not given, shape (O,)."""
        return np.zeros(self.orders) if self.worth is None else self.worth
