"""PSA prices: stores each pod where travel time plus the price of its stay is least."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

import numpy as np
import pydantic
from numpy.typing import NDArray

from rmfs.control.asks import Answer, Ask, By
from rmfs.control.problems import Trigger
from rmfs.control.psa import PodStorageAssignment
from rmfs.control.psa.nearest import Nearest
from rmfs.solvers.control.answers import answer
from rmfs.solvers.control.foresight import Foresight
from rmfs.solvers.control.storage.bands import bands, means
from rmfs.solvers.control.storage.parameters import ForecastParameters, Positive
from rmfs.solvers.control.storage.ways import Ways
from rmfs.solvers.models.storage import zones
from rmfs.solvers.models.storage.zones import Prices, Zones, expected_stay_h, place_values

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.control.asks import Call
    from rmfs.control.view import View
    from rmfs.world.robots import Robot

Count = Annotated[int, pydantic.Field(ge=1)]


@dataclass(frozen=True)
class Question:
    """The problem of the optimal steady state, from which prices are computed."""

    data: Zones
    method: str


def solve(question: Question) -> Answer:
    """Compute dual prices; the values in the answer are the attributes of `Prices`."""
    found = zones.solve(question.data, question.method)
    if found.values is None:
        return answer(found, None)
    prices = Prices.of(question.data, found.values)
    return answer(found, dict(vars(prices)))


class PricesParameters(ForecastParameters):
    """Parameters of PSA prices."""

    method: Literal["clarabel", "greedy"] = "clarabel"
    """Solution method for the steady state: `clarabel` (the convex program) or `greedy` (a rule by
    which the pods with the most expected visits get the best zones)."""
    classes: Count = 8
    """Number of classes into which pods are divided by expected visits."""
    zones: Count = 8
    """Number of zones into which storage locations are divided by distance from the pick
    stations."""
    period_s: Positive = 300.0
    """Time, in seconds, after which prices are recomputed."""
    congestion_s_h: Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)] = 0.02
    """Delay by congestion, in s h. The delay of a visit, in seconds, is this number times the
    number of visits per hour that pods of the same zone make."""


class PricesControl(PodStorageAssignment[PricesParameters]):
    """Computes prices of storage locations (places), and stores each pod at the least cost.

    Places are divided into zones by distance from the pick stations. Every `period_s` seconds, pods
    are divided into classes by expected visits, and a convex program determines how many pods of
    each class should be stored in each zone in a steady state. The program takes delays by
    congestion into account. The price of a place, a dual price of this program, is the robot time
    that one more place in its zone would save per hour. A pod goes to the empty place with the
    least cost: the time of the trips to the place and from there to a pick station, plus the delay,
    plus the price times the expected stay. Until the first answer, and after a failure, pods go to
    the nearest empty place.
    """

    parameters_model = PricesParameters
    subscriptions = frozenset({Trigger.START})
    optimisers: ClassVar[tuple[str, ...]] = ("rmfs.solvers.control.storage.prices",)

    def __init__(self, parameters: PricesParameters, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._foresight = Foresight(view, parameters.horizon_s, parameters.refresh_s)
        self._ways = Ways(view)
        self._heuristic = Nearest(Nearest.parameters_model(), view, rng)
        self._zone = bands(self._ways.fetch_s + self._ways.home_s, parameters.zones)
        self._prices: tuple[Prices, NDArray[np.int64], Call] | None = None
        self._asked_s = -inf

    def next_event_s(self) -> float:
        """Return the time at which prices will next be recomputed, in s."""
        return max(self._asked_s, 0.0) + self.parameters.period_s

    def decide(self) -> Iterator[Ask[Question]]:
        """Ask for new prices, unless the last question is recent or its answer is pending."""
        if self.in_flight or self.view.now_s < self._asked_s + self.parameters.period_s:
            return
        self._asked_s = self.view.now_s
        rate = self._foresight.visits_per_h
        pod_class = bands(-rate, self.parameters.classes)
        data = self._steady_state(rate, pod_class)
        sizes = {"classes": len(data.pods), "zones": len(data.places)}
        yield Ask(solve, Question(data, self.parameters.method), sizes, pod_class)

    def answered(self, call: Call) -> Iterator[Any]:
        """Store the prices of the answer; if it has none, discard the old prices."""
        self._prices = None
        if call.solution is not None:
            prices = Prices(**{name: np.asarray(value) for name, value in call.solution.items()})
            self._prices = prices, call.ask.memo, call
        return iter(())

    def place(self, robot: Robot) -> int | By[int]:
        """Return the empty place with the least cost for the robot's pod."""
        if self._prices is None:
            return self._heuristic.place(robot)
        prices, pod_class, call = self._prices
        rate = self._foresight.visits_per_h[[robot.pod]]
        values = place_values(
            prices,
            self._ways.storing_s([robot]) + self._ways.fetch_s,
            zone=self._zone,
            pod_class=pod_class[[robot.pod]],
            stay_h=expected_stay_h(rate, self.parameters.horizon_s / 3600.0),
        )
        return By(self.least(values[0], self.view.storage.is_empty), call)

    def _steady_state(self, rate: NDArray[np.float64], pod_class: NDArray[np.int64]) -> Zones:
        """Return the problem, with mean trip times of the zones and mean visits of the classes."""
        each_s = means(self._ways.home_s + self._ways.fetch_s, self._zone)
        classes, count = int(pod_class.max()) + 1, len(each_s)
        return Zones(
            visit_s=np.broadcast_to(each_s, (classes, count)),
            rate_per_h=means(rate, pod_class),
            pods=np.bincount(pod_class).astype(np.float64),
            places=np.bincount(self._zone).astype(np.float64),
            congestion_s_h=np.full(count, self.parameters.congestion_s_h),
        )
