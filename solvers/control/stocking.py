"""RPS stocking: chooses pods and stations for bundles to save as much robot time as possible."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

import numpy as np
import pydantic

from rmfs.control.asks import Answer, Ask, own
from rmfs.control.decisions import PromiseBundle, ReleasePod, SendBundle
from rmfs.control.problems import Problem, Trigger
from rmfs.control.rps import ReplenishmentPodSelection
from rmfs.control.trackers.frequency import Frequency, PairFrequency
from rmfs.solvers.control.answers import answer
from rmfs.solvers.control.buffer import Buffer
from rmfs.solvers.control.foresight import Foresight
from rmfs.solvers.control.parameters import SearchParameters
from rmfs.solvers.models import replenishment
from rmfs.solvers.models.replenishment import Replenishment
from rmfs.solvers.models.solution import Limits

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from typing import Any

    from numpy.typing import NDArray

    from rmfs.control.asks import By, Call
    from rmfs.control.view import View
    from rmfs.world.orders import Bundle

    Told = Ask["Question"] | PromiseBundle | ReleasePod | SendBundle | By[Any]

Method = Literal["cp_sat", "highs", "rounding", "greedy"]
NotNegative = Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)]
Count = Annotated[int, pydantic.Field(ge=1)]

_NODES = 1
_SCORED_PER_S = 1e6
"""Number of candidates that the greedy rule evaluates in about a second."""


@dataclass(frozen=True)
class Question:
    """The problem of storing bundles in pods at replenishment stations, and how to solve it.

    Attributes
    ----------
    method
        `greedy`, `rounding`, `cp_sat` or `highs`. The latter two start from the solution of
        `greedy`.
    """

    data: Replenishment
    method: str
    limits: Limits


def solve(question: Question) -> Answer:
    """Choose a `pod` for each bundle and a `station` for each pod; -1 means none."""
    found = replenishment.solve(question.data, "greedy")
    if question.method != "greedy":
        found = replenishment.solve(
            question.data, question.method, question.limits, start=found.values
        )
    values = found.values
    return answer(found, None if values is None else dict(vars(values)))


class StockingParameters(SearchParameters):
    """Parameters of RPS stocking."""

    method: Method = "highs"
    """Solution method: `highs` (HiGHS, at its root node), `cp_sat` (CP-SAT), `rounding` (rounding
    of the linear relaxation) or `greedy` (the greedy rule)."""
    buffer_s: NotNegative = 30.0
    """Minimum time in seconds between two questions to the optimiser, so that one question covers
    several decisions."""
    work_s: Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)] = 0.05
    """With the method `cp_sat`, limit on the effort of the search in deterministic seconds of
    CP-SAT, which are close to wall time."""
    gap: NotNegative = 0.01
    """The search ends when the relative gap between the best value found and the bound is at most
    this."""
    leave_s: NotNegative = 20.0
    """Cost of postponing a bundle, in seconds of robot time. The robot time that storing the bundle
    would save is lost in addition."""
    bundles: Count = 60
    """Maximum number of bundles that are considered, the oldest first."""
    pods_per_bundle: Count = 8
    """Maximum number of pods that are considered for each bundle, the best first."""
    stations_per_pod: Count = 2
    """Maximum number of stations with room that are considered for each pod, the nearest first."""


class StockingControl(ReplenishmentPodSelection[StockingParameters]):
    """Chooses pods for bundles, and replenishment stations for these pods, by one model.

    The ROA controller must be `dummy`. The value of storing a bundle in a pod is the robot time
    that the bundle's units will save by raising the pile-on. This value is high if the bundle's SKU
    is in demand and the pod holds few units of this SKU. It is higher if other SKUs of the pod are
    often ordered together with the bundle's SKU. The robot time of the pod's trip to a station with
    room for the bundle is deducted from the value. The trip counts once for all bundles of the pod,
    and is free if the pod is brought to that station anyway. When bundles wait and a station has
    room, the optimiser is asked, at most once in `buffer_s` seconds. If it fails, the greedy rule
    decides.
    """

    parameters_model = StockingParameters
    decides: ClassVar[frozenset[Problem]] = frozenset({Problem.ROA})
    subscriptions = frozenset({Trigger.BUNDLE_STORED, Trigger.STATION_SWITCHED})
    optimisers: ClassVar[tuple[str, ...]] = ("rmfs.solvers.control.stocking",)

    def __init__(
        self, parameters: StockingParameters, view: View, rng: np.random.Generator
    ) -> None:
        super().__init__(parameters, view, rng)
        self._foresight = Foresight(view, horizon_s=1800.0, kept_s=300.0)
        self._frequency = view.trackers.get(Frequency)
        self._pairs = view.trackers.get(PairFrequency)
        self._buffer = Buffer(view, parameters.buffer_s)

    def next_event_s(self) -> float:
        """Return when a question may next be asked, in s; inf if an event has to occur first."""
        return self._buffer.next_event_s

    def decide(self) -> Iterator[Told]:
        """Ask the optimiser if bundles wait, a station has room, and the buffer time is over."""
        if self._buffer.is_over(not self.in_flight and self._is_possible()):
            self._buffer.begin(again=True)
            yield self._question()

    def answered(self, call: Call) -> Iterator[Told]:
        """Apply the valid decisions of the solution or, without a solution, of the greedy rule."""
        if call.solution is not None:
            yield from self._apply(call.solution, call.ask.memo, call)
            return
        question: Question = call.ask.question
        found = solve(Question(question.data, "greedy", question.limits)).solution
        if found is not None:
            yield from own(self._apply(found, call.ask.memo, None))

    def _is_possible(self) -> bool:
        waiting = self.view.bundles.without_pod.values()
        room = max((s.free_space for s in self.view.replenishment_stations if s.active), default=0)
        return any(bundle.space <= room for bundle in waiting)

    def _apply(
        self, solution: Mapping[str, Any], bundles: Sequence[Bundle], call: Call | None
    ) -> Iterator[Told]:
        inventory, view = self.view.inventory, self.view
        station_of = np.asarray(solution["station"]).tolist()
        by_pod: dict[int, list[Bundle]] = {}
        for bundle, pod in zip(bundles, np.asarray(solution["pod"]).tolist(), strict=True):
            if pod >= 0:
                by_pod.setdefault(pod, []).append(bundle)
        for pod, chosen in by_pod.items():
            target = view.replenishment_stations[station_of[pod]]
            room, space = inventory.capacity[pod] - inventory.load[pod], target.free_space
            kept = []
            for bundle in chosen:
                fits = bundle.pod < 0 and bundle.space <= min(room, space) and target.active
                if fits:
                    room, space = room - bundle.space, space - bundle.space
                    kept.append(bundle)
                    yield PromiseBundle(bundle, pod)
                elif call is not None:
                    call.stale += 1
            if kept:
                yield ReleasePod(pod)
                for bundle in kept:
                    yield SendBundle(bundle, target.index)

    def _question(self) -> Ask[Question]:
        given, view = self.parameters, self.view
        waiting = view.bundles.without_pod.values()
        bundles = [bundle for bundle in waiting if bundle.station < 0][: given.bundles]
        inventory = view.inventory
        everything = Replenishment(
            worth_s=self._worth_s(bundles),
            leave_s=np.full(len(bundles), given.leave_s),
            space=np.array([bundle.space for bundle in bundles]),
            pod_space=np.maximum(inventory.capacity - inventory.load, 0.0),
            trip_s=self._trip_s(),
            station_space=np.array(
                [s.free_space if s.active else 0.0 for s in view.replenishment_stations]
            ),
        )
        data = replenishment.best_pods(
            everything, pods=given.pods_per_bundle, stations=given.stations_per_pod
        )
        limits = Limits(deterministic_s=given.work_s, gap=given.gap, nodes=_NODES)
        pods, stations = data.trip_s.shape
        sizes = {"bundles": len(bundles), "pods": pods, "stations": stations}
        return Ask(solve, Question(data, given.method, limits), sizes, bundles)

    def _worth_s(self, bundles: Sequence[Bundle]) -> NDArray[np.float64]:
        """Return the value of every pod for every bundle, shape (B, P)."""
        view, foresight = self.view, self._foresight
        visits_per_h = max(float(foresight.visits_per_h.sum()), 1e-3)
        between_h = min(len(view.inventory.capacity) / visits_per_h, 24.0)
        skus = np.array([bundle.sku for bundle in bundles], np.int64)
        return replenishment.bundle_worth_s(
            view.inventory.available,
            skus,
            np.array([bundle.units for bundle in bundles], np.int64),
            foresight.units_per_h * between_h,
            self._affinity(skus),
            visit_s=len(view.robots) * 3600.0 / visits_per_h,
            pile_on=foresight.pile_on,
        )

    def _affinity(self, skus: NDArray[np.int64]) -> NDArray[np.float64]:
        """Return the number of orders with both SKUs per unit ordered of the first, shape (K, K).

        Only rows of the given SKUs are computed; all others are 0.
        """
        count = len(self.view.skus)
        affinity = np.zeros((count, count))
        units = self._frequency.units
        for sku in np.unique(skus).tolist():
            affinity[sku] = self._pairs.orders_with(sku)[:count] / max(int(units[sku]), 1)
        return affinity

    def _trip_s(self) -> NDArray[np.float64]:
        """Return the robot time to bring each pod and store it again, shape (P, S), s.

        Pods carried by robots are excluded; those that go to a station anyway cost nothing there.
        """
        view = self.view
        at = view.storage.pod_waypoint
        transfer_s = max(kind.pod_transfer_s for kind in view.layout.robot_kinds)
        trips = [
            view.travel.to(s.waypoint, loaded=True)[at]
            + view.travel.away(s.waypoint, loaded=True)[at]
            + 2.0 * transfer_s
            for s in view.replenishment_stations
        ]
        trip_s = np.stack(trips, axis=1)
        trip_s[~view.storage.is_stored] = inf
        goes = view.bundles_waiting.T > 0
        trip_s[goes.any(axis=1)] = inf
        trip_s[goes] = 0.0
        return trip_s
