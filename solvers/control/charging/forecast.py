"""Forecast of the number of robots needed for work, from recent observations."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from rmfs.world.charging import ChargeTask

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.control.view import View


class _Seen(NamedTuple):
    time_s: float
    used: int
    busy: int
    stations: int


class Forecast:
    """Forecasts the number of robots needed for work from recent counts of robots in use.

    Robots that rest, charge or are on their way to charge are not counted. Of the robots in the
    queue of each pick or replenishment station, at most two are counted. If some stations with work
    have no robot at the head of their queue, more robots are needed than are in use. The forecast
    therefore multiplies each count by a ratio: the number of stations with work, divided by the
    number of those that have a robot at the head of their queue, both summed over all recent
    counts.

    Parameters
    ----------
    view
        The world.
    window_s
        Time for which counts are kept, in s.
    cases
        Number of cases (scenarios) of the forecast.
    """

    def __init__(self, view: View, window_s: float, cases: int) -> None:
        self._view = view
        self._window_s = window_s
        self._cases = cases
        self._seen: deque[_Seen] = deque()
        self._queues = {s.index: set(view.layout.stations[s.index].queue) for s in view.stations}

    def look(self) -> None:
        """Record the number of robots in use now."""
        self._seen.append(self._count())
        while self._seen[0].time_s < self._view.now_s - self._window_s:
            self._seen.popleft()

    def cases(self) -> NDArray[np.int64]:
        """Return the number of robots needed in each of Q equally likely cases, shape (Q,)."""
        robots = len(self._view.robots)
        busy = sum(seen.busy for seen in self._seen)
        stations = sum(seen.stations for seen in self._seen)
        counted = np.sort([seen.used for seen in self._seen])
        at = (np.arange(self._cases) + 0.5) / self._cases * len(counted)
        used = counted[at.astype(np.int64)]
        if not busy:
            return np.full(self._cases, robots if stations else 0, np.int64)
        wanted: NDArray[np.int64] = np.rint(used * (stations / busy)).astype(np.int64)
        return np.minimum(wanted, robots)

    def _count(self) -> _Seen:
        view = self._view
        robots = view.robots
        used = len(robots) - len(view.resting)
        used -= sum(isinstance(robot.task, ChargeTask) for robot in robots)
        at = view.travel.robot_waypoint
        busy = stations = 0
        for station in view.stations:
            queue = self._queues[station.index]
            there = sum(at(task.robot) in queue for task in station.tasks.values())
            used -= max(0, there - 2)
            stations += station.has_work
            busy += station.has_work and station.robot >= 0
        return _Seen(view.now_s, max(used, 0), busy, stations)
