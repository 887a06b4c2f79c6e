"""Base of PSA controllers that plan storage locations for all returning pods by a model."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from rmfs.control.asks import By
from rmfs.control.problems import Trigger
from rmfs.control.psa import PodStorageAssignment
from rmfs.control.psa.nearest import Nearest
from rmfs.solvers.control.buffer import Buffer
from rmfs.solvers.control.foresight import Foresight
from rmfs.solvers.control.storage.parameters import StorageParameters
from rmfs.solvers.control.storage.ways import Ways

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rmfs.control.asks import Ask, Call
    from rmfs.control.view import View
    from rmfs.world.robots import Robot

P = TypeVar("P", bound=StorageParameters)


class Ahead(PodStorageAssignment[P]):
    """Plans storage locations (places) for the pods that robots carry, before these are stored.

    When a pod reaches a station, but at most once in `buffer_s` seconds, the optimiser is asked for
    the places of all pods that robots carry to stations or have to store now. The new plan replaces
    the previous one. Pods for which no place is planned, or whose planned place is no longer empty,
    go to the nearest empty place.
    """

    subscriptions = frozenset({Trigger.POD_AT_STATION})

    def __init__(self, parameters: P, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self.foresight = Foresight(view, parameters.horizon_s, parameters.refresh_s)
        self.ways = Ways(view)
        self._heuristic = Nearest(Nearest.parameters_model(), view, rng)
        self._plan: dict[int, tuple[int, Call]] = {}
        self._buffer = Buffer(view, parameters.buffer_s)

    @abstractmethod
    def question(self, robots: Sequence[Robot]) -> Ask[Any]:
        """Return the question of where to store these robots' pods; its `memo` lists the pods."""

    @abstractmethod
    def places(self, call: Call) -> Sequence[int]:
        """Return the place (waypoint) that an answer assigns to each pod of its question, or -1."""

    def next_event_s(self) -> float:
        """Return when a question may next be asked, in s; inf if an event has to occur first."""
        return self._buffer.next_event_s

    def decide(self) -> Iterator[Ask[Any]]:
        """Ask the optimiser, unless an answer is pending or the buffer time has not passed yet."""
        if not self._buffer.is_over(not self.in_flight):
            return
        robots = [robot for robot in self.view.robots if _will_store(robot)]
        if robots and self.view.storage.is_empty.any():
            self._buffer.begin()
            yield self.question(robots)

    def answered(self, call: Call) -> Iterator[Any]:
        """Replace the plan by the answer, less pods already stored and places already taken."""
        self._plan.clear()
        if call.solution is not None:
            carried = {robot.pod for robot in self.view.robots}
            for pod, place in zip(call.ask.memo, self.places(call), strict=True):
                if pod in carried and place >= 0 and self._is_empty(place):
                    self._plan[pod] = place, call
                else:
                    call.stale += 1
        return iter(())

    def place(self, robot: Robot) -> int | By[int]:
        """Return the planned place of the pod if still empty, otherwise the nearest empty place."""
        planned = self._plan.pop(robot.pod, None)
        if planned is not None:
            place, call = planned
            if self._is_empty(place):
                return By(place, call)
            call.stale += 1
        return self._heuristic.place(robot)

    def _is_empty(self, place: int) -> bool:
        storage = self.view.storage
        return bool(storage.is_empty[storage.place_index[place]])


def _will_store(robot: Robot) -> bool:
    """Whether a robot carries a pod to a station, or waits for a storage location."""
    return robot.pod >= 0 and (robot.task is None or robot.task.station >= 0)
