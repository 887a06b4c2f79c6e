"""PSA placement: stores all returning pods where current and later trips are shortest in total."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

import numpy as np
import pydantic
from numpy.typing import NDArray

from rmfs.control.asks import Answer, Ask
from rmfs.solvers.control.answers import answer
from rmfs.solvers.control.storage.ahead import Ahead
from rmfs.solvers.control.storage.parameters import StorageParameters
from rmfs.solvers.models.storage import placement
from rmfs.solvers.models.storage.placement import Placement

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.control.asks import Call
    from rmfs.world.robots import Robot


@dataclass(frozen=True)
class Question:
    """The pods that are to be stored, and the empty storage locations (places).

    Attributes
    ----------
    waypoint
        Waypoint of each place, shape (L,).
    """

    data: Placement
    method: str
    waypoint: NDArray[np.int64]


def solve(question: Question) -> Answer:
    """Choose the place of each pod; `place` in the answer contains the waypoints, shape (P,)."""
    found = placement.solve(question.data, question.method)
    values = None if found.values is None else {"place": question.waypoint[found.values]}
    return answer(found, values)


def worth_looking_at(cost_s: NDArray[np.float64]) -> NDArray[np.intp]:
    """Return indices of places that suffice for an optimal placement of the P pods.

    They include, for each pod, the P places with the least cost.

    Parameters
    ----------
    cost_s
        Cost of each pod at each place, shape (P, L).
    """
    pods, places = cost_s.shape
    if pods >= places:
        return np.arange(places)
    cheapest = np.argpartition(cost_s, pods - 1, axis=1)[:, :pods]
    found: NDArray[np.intp] = np.unique(cheapest)
    return found


class PlacementParameters(StorageParameters):
    """Parameters of PSA placement."""

    method: Literal["assignment", "greedy"] = "assignment"
    """Solution method: `assignment` (optimal) or `greedy` (a rule by which the pods with the most
    expected visits choose first)."""
    later_weight: Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)] = 1.0
    """Weight of robot time for later visits, relative to robot time for the current trip."""


class PlacementControl(Ahead[PlacementParameters]):
    """Stores pods where the current trip and the expected later trips are shortest in total.

    All pods that robots carry to stations or have to store now are assigned to empty storage
    locations jointly (linear assignment problem). The time of a pod's later trips is the mean time
    of a round trip to a pick station, times the number of visits that the pod is expected to make
    within the horizon.
    """

    parameters_model = PlacementParameters
    optimisers: ClassVar[tuple[str, ...]] = ("rmfs.solvers.control.storage.placement",)

    def question(self, robots: Sequence[Robot]) -> Ask[Question]:
        """Return the assignment problem, with places that suffice for an optimal assignment."""
        empty = self.view.storage.is_empty.nonzero()[0]
        pods = [robot.pod for robot in robots]
        travel_s = self.ways.storing_s(robots)[:, empty]
        visits = self.foresight.visits_per_h[pods] * (self.parameters.horizon_s / 3600.0)
        access_s = (self.ways.fetch_s + self.ways.home_s)[empty] * self.parameters.later_weight
        kept = worth_looking_at(travel_s + np.outer(visits, access_s))
        data = Placement(travel_s[:, kept], access_s[kept], visits)
        waypoint = self.view.storage.places[empty[kept]].astype(np.int64)
        sizes = {"pods": len(pods), "places": len(kept)}
        return Ask(solve, Question(data, self.parameters.method, waypoint), sizes, pods)

    def places(self, call: Call) -> Sequence[int]:
        """Return the place (waypoint) that the answer assigns to each pod."""
        assert call.solution is not None
        return [int(place) for place in call.solution["place"]]
