"""POA rules that first choose an order, then a station regardless of the order's contents."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
import pydantic

from rmfs.control.decisions import AssignOrder
from rmfs.control.poa.filling import FastLaneParameters, Filling
from rmfs.control.poa.ties import first_row
from rmfs.control.trackers.frequency import Frequency

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.world.orders import Order
    from rmfs.world.stations import PickStation

_DRAWS = 8
"""Number of draws from the whole backlog, before a draw from the orders that can be served."""


class OrderRuleParameters(FastLaneParameters):
    """Parameters of POA rules that choose the order first."""

    station: Literal["random", "least-busy", "most-busy"] = "random"
    """Which station with a free slot is chosen: a random one (`random`), or the one with the lowest
    (`least-busy`) or highest (`most-busy`) share of its slots occupied. Ties go to the lowest
    station number."""
    stick_to_station: bool = False
    """Whether the station chosen for the previous order is chosen again as long as it has a free
    slot that is not reserved for the fast lane."""


class OrderRule(Filling[OrderRuleParameters]):
    """Base class of rules that choose an order, then a station for it."""

    parameters_model = OrderRuleParameters

    def __init__(
        self, parameters: OrderRuleParameters, view: View, rng: np.random.Generator
    ) -> None:
        super().__init__(parameters, view, rng)
        self._last: PickStation | None = None

    @abstractmethod
    def choose_order(self) -> Order | None:
        """Choose an order that stock can serve; None if there is none."""

    def next_assignment(self, stations: list[PickStation]) -> AssignOrder | None:
        """Choose an order with `choose_order`, and a station as the parameters specify."""
        order = self.choose_order()
        if order is None:
            return None
        if not (self.parameters.stick_to_station and self._last in stations):
            self._last = self._station(stations)
        assert self._last is not None
        return AssignOrder(order, self._last.index)

    def _station(self, stations: list[PickStation]) -> PickStation:
        if self.parameters.station == "random":
            return stations[self.draw(len(stations))]
        sign = 1 if self.parameters.station == "least-busy" else -1
        return min(stations, key=lambda station: sign * len(station.orders) / station.slots)


class RandomOrder(OrderRule):
    """Fills free slots with orders drawn at random.

    Source: rule "Default" of RAWSim-O with a random choice of orders.
    """

    def choose_order(self) -> Order | None:
        """Draw one of the orders that stock can serve; None if there is none."""
        backlog = self.view.orders.at_row
        free_stock = self.view.inventory.free_stock.item
        for _ in range(_DRAWS):
            order = backlog[self.draw(len(backlog))]
            if all(free_stock(line.sku) >= line.units for line in order.lines):
                return order
        rows = self.servable_rows()
        return backlog[int(rows[self.draw(len(rows))])] if len(rows) else None


class FirstCome(OrderRule):
    """Fills free slots with orders in the sequence of their arrival.

    Orders that stock cannot serve are skipped. Sources: two rules of RAWSim-O, "Random" (where only
    the station is random) and "Default" with first come, first served.
    """

    def choose_order(self) -> Order | None:
        """Choose the oldest order that stock can serve; None if there is none."""
        return self.oldest_order()


class DueTime(OrderRule):
    """Fills free slots with orders in the sequence of their due times.

    Ties go to the order that arrived first. Source: rule "Default" of RAWSim-O with due time.
    """

    def choose_order(self) -> Order | None:
        """Choose, of the orders that stock can serve, the one due first; None if there is none."""
        rows = self.servable_rows()
        if not len(rows):
            return None
        orders = self.view.orders
        return orders.at_row[first_row(rows, orders, "due-time", self.draw)]


class WorkParameters(OrderRuleParameters):
    """Parameters of POA rules that compare the time until an order is due with the order's work."""

    line_s: Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)] = 60.0
    """Assumed work per order line in seconds: an estimate of the time until a pod for the line
    arrives."""
    unit_s: Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)] = 10.0
    """Assumed work per unit of an order in seconds."""


class _ByWork(OrderRule):
    """Chooses by due time and work; ties go to the order that arrived first."""

    parameters_model = WorkParameters

    @abstractmethod
    def _scores(
        self,
        left_s: NDArray[np.float64],
        work_s: NDArray[np.float64],
        weight: NDArray[np.float64],
    ) -> NDArray[np.float64]:
        """Return the score of each order; the smallest comes first."""

    def choose_order(self) -> Order | None:
        """Choose the order with the smallest score."""
        rows = self.servable_rows()
        if not len(rows):
            return None
        orders, given = self.view.orders, self.parameters
        assert isinstance(given, WorkParameters)
        units = orders.units[rows]
        work_s = given.line_s * (units > 0).sum(axis=1) + given.unit_s * units.sum(axis=1)
        left_s = orders.due_s[rows] - self.view.now_s
        scores = self._scores(left_s, work_s, orders.weight[rows])
        best = rows[scores == scores.min()]
        return orders.at_row[first_row(best, orders, "first-come", self.draw)]


class Slack(_ByWork):
    """Fills free slots with the orders that have the least slack.

    The slack of an order is the time until it is due, minus its work (`line_s` per order line plus
    `unit_s` per unit). Ties go to the order that arrived first. Source: the least-slack rule of job
    shops (Panwalkar, Iskander 1977).
    """

    def _scores(
        self,
        left_s: NDArray[np.float64],
        work_s: NDArray[np.float64],
        weight: NDArray[np.float64],
    ) -> NDArray[np.float64]:
        return left_s - work_s


class CriticalRatio(_ByWork):
    """Fills free slots with the orders that have the least time left relative to their work.

    The critical ratio of an order is the time until it is due, divided by its work (`line_s` per
    order line plus `unit_s` per unit). If this ratio is below 1, the order is expected to be late.
    Slack divided by work, which is this ratio minus 1, gives the same sequence. Ties go to the
    order that arrived first. Source: Panwalkar, Iskander (1977).
    """

    def _scores(
        self,
        left_s: NDArray[np.float64],
        work_s: NDArray[np.float64],
        weight: NDArray[np.float64],
    ) -> NDArray[np.float64]:
        return left_s / np.maximum(work_s, 1e-9)


class TardinessCostParameters(WorkParameters):
    """Parameters of POA tardiness-cost."""

    ahead: Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)] = 2.0
    """Look-ahead of the rule: the slack that reduces the urgency of an order by the factor e. It is
    given as a multiple of the mean work of the orders that stock can serve."""


class TardinessCost(_ByWork):
    """Fills free slots with the orders whose lateness would be most costly relative to their work.

    The order with the highest value of (w / p) x exp(-s / (`ahead` x m)) comes first. Here, w is
    the weight of the order's class, p the order's work (`line_s` per order line plus `unit_s` per
    unit), s its slack (the time until it is due minus p, but at least 0), and m the mean work of
    the orders that stock can serve. Ties go to the order that arrived first. Source: apparent
    tardiness cost (Vepsalainen, Morton 1987), with `ahead` = 2.
    """

    parameters_model = TardinessCostParameters

    def _scores(
        self,
        left_s: NDArray[np.float64],
        work_s: NDArray[np.float64],
        weight: NDArray[np.float64],
    ) -> NDArray[np.float64]:
        given = self.parameters
        assert isinstance(given, TardinessCostParameters)
        work_s = np.maximum(work_s, 1e-9)
        slack_s = np.maximum(left_s - work_s, 0.0)
        # as a logarithm, which does not underflow for large slack
        scores: NDArray[np.float64] = slack_s / (given.ahead * work_s.mean())
        return scores - np.log(weight / work_s)


class FrequencyAge(OrderRule):
    """Fills free slots with old orders for frequently ordered SKUs.

    The order with the highest product of age and frequency comes first. Age is measured by rank: 1
    for the oldest of the B orders in the backlog, 1 - 1/B for the second oldest, and so on, down to
    1/B for the newest. The frequency of an order is the mean, over its lines, of the number of
    units of the line's SKU that have been ordered so far, including before the run. Ties go to the
    order that arrived first. Source: rule "Default" of RAWSim-O with frequency and age.
    """

    def __init__(
        self, parameters: OrderRuleParameters, view: View, rng: np.random.Generator
    ) -> None:
        super().__init__(parameters, view, rng)
        self._frequency = view.trackers.get(Frequency)

    def choose_order(self) -> Order | None:
        """Choose, of the orders that stock can serve, the one with the highest age times frequency.

        Return None if stock can serve no order.
        """
        rows = self.servable_rows()
        if not len(rows):
            return None
        orders = self.view.orders
        by_arrival = orders.index.argsort()
        age = np.empty(len(by_arrival), np.int64)
        age[by_arrival] = np.arange(len(by_arrival), 0, -1)
        is_line = orders.units > 0
        frequency = (self._frequency.units[orders.sku] * is_line).sum(axis=1)
        # integers up to here; factors common to all orders are left out
        scores = (age * frequency / is_line.sum(axis=1))[rows]
        best = rows[scores == scores.max()]
        return orders.at_row[first_row(best, orders, "first-come", self.draw)]
