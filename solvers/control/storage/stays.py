"""PSA stays: chooses zones for returning pods by the times at which pods will be fetched."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

import numpy as np
import pydantic

from rmfs.control.asks import Answer, Ask
from rmfs.solvers.control.answers import answer
from rmfs.solvers.control.parameters import SearchParameters
from rmfs.solvers.control.storage.ahead import Ahead
from rmfs.solvers.control.storage.bands import bands, means
from rmfs.solvers.control.storage.parameters import Positive, StorageParameters
from rmfs.solvers.models.solution import Limits
from rmfs.solvers.models.storage import stays
from rmfs.solvers.models.storage.stays import Stays
from rmfs.solvers.models.storage.zones import expected_stay_h

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.control.asks import Call
    from rmfs.control.view import View
    from rmfs.world.robots import Robot

_SERVICE_S = 30.0
"""Assumed time from the question until a pod is stored, in s, if its service is not over."""


@dataclass(frozen=True)
class Question:
    """Stays of pods in zones, those of the returning pods first.

    Attributes
    ----------
    returning
        Number of stays of returning pods.
    """

    data: Stays
    returning: int
    method: str
    limits: Limits


def solve(question: Question) -> Answer:
    """Choose the zone of each returning pod; the answer has `zone`, shape (returning,)."""
    found = stays.solve(question.data, "greedy")
    if question.method != "greedy":
        found = stays.solve(question.data, question.method, question.limits, start=found.values)
    values = None if found.values is None else {"zone": found.values[: question.returning]}
    return answer(found, values)


class StaysParameters(StorageParameters, SearchParameters):
    """Parameters of PSA stays."""

    method: Literal["cp_sat", "highs", "greedy"] = "cp_sat"
    """Solution method: `greedy` (a rule that chooses zones for one stay after another, beginning
    with those whose cost depends most on the zone), or `cp_sat` or `highs`, which improve the
    solution of `greedy`."""
    work_s: Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)] = 0.02
    """Limit of the search by CP-SAT in deterministic seconds, which are close to wall time. The
    method `highs` has no such limit."""
    gap: Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)] = 0.001
    """Relative gap between objective value and bound at which the search ends."""
    horizon_s: Positive = 900.0
    """Horizon, in seconds, of the plan and of the forecast of visits. Stored pods that are expected
    to stay longer only occupy their storage locations."""
    zones: Annotated[int, pydantic.Field(ge=1)] = 8
    """Number of zones into which storage locations are divided by distance from the pick
    stations."""


class StaysControl(Ahead[StaysParameters]):
    """Chooses zones for returning pods by the times at which pods are expected to be fetched.

    Storage locations (places) are divided into zones by distance from the pick stations. A
    returning pod is assumed to be fetched at the end of its expected stay, which is limited to the
    horizon. A stored pod whose expected stay is shorter than the horizon is assumed to leave its
    zone at the end of that stay; the other stored pods only occupy their places. An integer program
    chooses the zones so that no zone is ever overfull and robot time is least. Within the chosen
    zone, a returning pod is stored at the empty place nearest to the station from which it returns.
    """

    parameters_model = StaysParameters
    optimisers: ClassVar[tuple[str, ...]] = ("rmfs.solvers.control.storage.stays",)

    def __init__(self, parameters: StaysParameters, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._zone = bands(self.ways.fetch_s + self.ways.home_s, parameters.zones)
        self._index = np.array(view.storage.place_index)

    def question(self, robots: Sequence[Robot]) -> Ask[Question]:
        """Return the problem of choosing zones for the stays of pods."""
        data = self._stays(robots)
        question = Question(data, len(robots), self.parameters.method, self.parameters.limits)
        sizes = {"pods": len(robots), "stays": len(data.begin_s), "zones": len(data.capacity)}
        return Ask(solve, question, sizes, [robot.pod for robot in robots])

    def places(self, call: Call) -> Sequence[int]:
        """Return, for each pod, the nearest empty place in its zone; -1 if none is left.

        Pods are processed in sequence, and each place is given to only one pod.
        """
        assert call.solution is not None
        storage = self.view.storage
        carriers = {robot.pod: robot for robot in self.view.robots if robot.pod >= 0}
        free = storage.is_empty.copy()
        places = []
        for pod, zone in zip(call.ask.memo, call.solution["zone"], strict=True):
            place = -1
            if pod in carriers:
                store_s = self.ways.store_s(carriers[pod].waypoint)
                place = self.least(store_s, free & (self._zone == zone))
            if place >= 0:
                free[storage.place_index[place]] = False
            places.append(place)
        return places

    def _stays(self, robots: Sequence[Robot]) -> Stays:
        """Return the stays of returning pods, then of stored pods that leave within the horizon.

        Places of pods that stay longer do not count as capacity, nor do places that are reserved.
        """
        view, horizon_s = self.view, self.parameters.horizon_s
        stay_s = expected_stay_h(self.foresight.visits_per_h, horizon_s / 3600.0) * 3600.0
        zones = int(self._zone.max()) + 1
        stored = view.storage.is_stored.nonzero()[0]
        zone_of = self._zone[self._index[view.storage.pod_waypoint[stored]]]
        leaves = stay_s[stored] < horizon_s
        capacity = np.bincount(self._zone[view.storage.is_empty], minlength=zones)
        capacity += np.bincount(zone_of[leaves], minlength=zones)
        begin_s = np.array([0.0 if r.task is None else _SERVICE_S for r in robots])
        end_s = begin_s + stay_s[[robot.pod for robot in robots]]
        fetch_s = means(self.ways.fetch_s, self._zone)
        cost_s = np.stack([means(self.ways.store_s(r.waypoint), self._zone) for r in robots])
        settled = np.full((int(leaves.sum()), zones), np.inf)
        settled[np.arange(len(settled)), zone_of[leaves]] = 0.0
        return Stays(
            begin_s=np.concatenate([begin_s, np.zeros(len(settled))]),
            end_s=np.concatenate([end_s, stay_s[stored[leaves]]]),
            cost_s=np.vstack([cost_s + fetch_s, settled]),
            capacity=capacity,
        )
