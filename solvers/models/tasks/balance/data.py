r"""The problem: free robots, waiting tasks, stations with queues, due times.

.. math::

    \min \sum_{rt} \bigl(arrive_{rt} + w \max(0, arrive_{rt} - due_t)\bigr) x_{rt}
    + \sum_t leave_t \Bigl(1 - \sum_r x_{rt}\Bigr)
    + \sum_s \sum_{k=1}^{n_s} (queue_s + k - 1)\, service_s

where :math:`x_{rt}` is 1 if robot r does task t, w is the weight of lateness, and :math:`n_s \le
room_s` is the number of robots sent to station s. The k-th of these robots waits for
:math:`queue_s + k - 1` pods. So each further robot sent to the same station costs more, which
balances the queues. The estimated waiting time depends only on the number of robots sent to a
station, and it does not count as lateness. Therefore, the cost of travel and lateness of a robot
with a task does not depend on the tasks of other robots.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.checks import costs, integers, number, reals
from rmfs.solvers.models.tasks.matching import Matching
from rmfs.solvers.models.tasks.matching import objective as matching_objective
from rmfs.solvers.models.tasks.matching import violations as matching_violations
from rmfs.solvers.models.tasks.matching.data import LEFT


@dataclass(frozen=True)
class Balance:
    """Free robots, waiting tasks and stations.

    Parameters
    ----------
    arrive_s
        Time until each robot would be at the station with the pod of each task, shape (R, T), in s;
        +inf where the robot may not do the task.
    leave_s
        Cost of leaving each task for later, shape (T,), in s; +inf if it must be done.
    due_s
        Time from now until the pod of each task is due at its station, shape (T,), in s; negative
        if it is already late, +inf without a due time.
    station
        Station of each task, shape (T,).
    queue
        Number of pods at each station or on their way to it, shape (S,).
    service_s
        Time for which a pod occupies each station, shape (S,), in s.
    room
        Maximum number of robots that may be sent to each station now, shape (S,).
    late_weight
        Cost of one second of lateness, in seconds of travel. Default 1.

    Raises
    ------
    ModelError
        If a shape or a value is wrong.
    """

    arrive_s: NDArray[np.float64]
    leave_s: NDArray[np.float64]
    due_s: NDArray[np.float64]
    station: NDArray[np.int64]
    queue: NDArray[np.int64]
    service_s: NDArray[np.float64]
    room: NDArray[np.int64]
    late_weight: float = 1.0

    def __post_init__(self) -> None:
        arrive_s = costs("arrive_s", self.arrive_s, (None, None), low=0)
        tasks = arrive_s.shape[1]
        service_s = reals("service_s", self.service_s, (None,), low=0)
        stations = len(service_s)
        checked = {
            "arrive_s": arrive_s,
            "leave_s": costs("leave_s", self.leave_s, (tasks,)),
            "due_s": costs("due_s", self.due_s, (tasks,)),
            "station": integers("station", self.station, (tasks,), low=0, high=stations - 1),
            "queue": integers("queue", self.queue, (stations,), low=0),
            "service_s": service_s,
            "room": integers("room", self.room, (stations,), low=0),
            "late_weight": number("late_weight", self.late_weight, low=0),
        }
        for field, value in checked.items():
            object.__setattr__(self, field, value)

    @property
    def pairs(self) -> Matching:
        """The problem without queues, as a matching with travel and weighted lateness as costs."""
        late_s = np.maximum(0.0, self.arrive_s - np.where(np.isinf(self.due_s), 0.0, self.due_s))
        counted = self.late_weight * np.where(np.isinf(self.due_s) | np.isinf(late_s), 0.0, late_s)
        return Matching(self.arrive_s + counted, self.leave_s)

    def waiting_s(self, sent: NDArray[np.int64]) -> NDArray[np.float64]:
        """Return the total waiting time of the robots sent to each station, shape (S,), in s.

        Parameters
        ----------
        sent
            Number of robots sent to each station, shape (S,).
        """
        waiting: NDArray[np.float64] = self.service_s * (
            sent * self.queue + sent * (sent - 1) / 2.0
        )
        return waiting


def objective(data: Balance, robot: NDArray[np.int64]) -> float:
    """Return the cost of travel, lateness, waiting and tasks left for later, in s.

    Parameters
    ----------
    data
        The problem.
    robot
        Robot of each task, or `LEFT` if the task is left for later, shape (T,).
    """
    sent = np.bincount(data.station[robot != LEFT], minlength=len(data.room))
    return matching_objective(data.pairs, robot) + float(data.waiting_s(sent).sum())


def violations(data: Balance, robot: NDArray[np.int64]) -> list[str]:
    """List the conditions that a choice of robots violates; empty if the choice is feasible.

    Parameters
    ----------
    data
        The problem.
    robot
        Robot of each task, or `LEFT` if the task is left for later, shape (T,).
    """
    found = matching_violations(data.pairs, robot)
    if robot.shape == data.station.shape:
        sent = np.bincount(data.station[robot != LEFT], minlength=len(data.room))
        if (sent > data.room).any():
            found.append("a station gets more robots than it has room for")
    return found
