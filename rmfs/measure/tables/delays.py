"""The table `delays`: for each order line, the parts of its order's turnover time.

The parts are the times between the following moments (some of these times are divided further): the
order arrives; the line is assigned to a station, with all or a part of its order; a robot gets the
task to bring the pod from which the line's last unit is picked; the robot lifts the pod; the robot
enters the queue zone; the robot reaches the station; the line's last unit has been handled;
the order is complete. The parts add up to the order's turnover time. If the robot got its task,
lifted the pod, entered the queue zone or reached the station before the line was assigned, the time
of the assignment takes the place of that moment.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.measure.columns import INTEGER, REAL, Column
from rmfs.measure.recorder import TASKS
from rmfs.measure.steps import covered
from rmfs.measure.tables.tidy import tidy

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

    from rmfs.measure.tables.logs import Logs

    Floats = NDArray[np.float64]
    Integers = NDArray[np.int64]

PARTS = {
    "wait_assignment": "waiting for POA to assign the order, or the part of it with this line, "
    "to a station",
    "wait_pod": "waiting until a robot gets the task to bring the pod, while at least one robot "
    "is at rest",
    "wait_robot": "waiting until a robot gets the task to bring the pod, while all robots have "
    "work",
    "wait_plan": "waiting for path plans before the drives to the pod and to the queue zone; 0 if "
    "planning takes no simulated time",
    "drive_free": "time that the drive to the pod, lifting, and the drive to the queue zone take "
    "without other robots",
    "drive_hindered": "additional time of the drive to the pod and of the drive to the queue zone "
    "because of other robots",
    "queue": "waiting in the queue zone",
    "service": "service at the station, until the last unit of the line has been handled",
    "wait_order": "waiting in the order slot for the other lines of the order",
}
"""The parts of the turnover time for an order line, roughly in chronological order."""

DELAYS = (
    Column("order", INTEGER, "", "Order of the line, as in the table `orders`"),
    Column("sku", INTEGER, "", "SKU of the line"),
    Column("station", INTEGER, "", "Pick station"),
    Column(
        "robot",
        INTEGER,
        "",
        "Robot that brought the pod from which the line's last unit was picked",
    ),
    Column("completed_s", REAL, "s", "Time of completion of the order"),
    Column("turnover_s", REAL, "s", "Time from the order's arrival to its completion"),
    *(
        Column(f"{part}_s", REAL, "s", f"Part of turnover_s: {what}")
        for part, what in PARTS.items()
    ),
)

_TO_POD, _TO_STATION = 0, 1
_PICK, _REST = TASKS.index("pick"), TASKS.index("rest")


def delays(logs: Logs) -> pd.DataFrame:
    """Return one row per line of the orders completed in the measured time."""
    lines = _lines(logs)
    created, completed = lines["created_s"].to_numpy(), lines["completed_s"].to_numpy()
    robot, picked = lines["robot"].to_numpy(), lines["time_s"].to_numpy()
    assigned, handled = lines["assigned_s"].to_numpy(), lines["end_s"].to_numpy()
    moments = _Moments(logs, robot, picked)
    begun = np.clip(moments.task, assigned, handled)
    lifted = np.clip(moments.lift, begun, handled)
    queued = np.clip(moments.queue, lifted, handled)
    arrived = np.clip(moments.visit, queued, handled)
    drives = ((moments.to_pod, begun, lifted), (moments.to_station, lifted, queued))
    awaited = sum(drive.awaited(since, until) for drive, since, until in drives)
    hindered = sum(drive.hindered(since, until) for drive, since, until in drives)
    at_rest = _time_at_rest(logs, begun) - _time_at_rest(logs, assigned)
    at_rest = np.clip(at_rest, 0.0, begun - assigned)
    return tidy(
        "delays",
        DELAYS,
        {
            "order": lines["order"],
            "sku": lines["sku"],
            "station": lines["station"],
            "robot": robot,
            "completed_s": completed,
            "turnover_s": completed - created,
            "wait_assignment_s": assigned - created,
            "wait_pod_s": at_rest,
            "wait_robot_s": (begun - assigned) - at_rest,
            "wait_plan_s": awaited,
            "drive_free_s": (queued - begun) - hindered - awaited,
            "drive_hindered_s": hindered,
            "queue_s": arrived - queued,
            "service_s": handled - arrived,
            "wait_order_s": completed - handled,
        },
    )


def by_order(frame: pd.DataFrame) -> pd.DataFrame:
    """Return the turnover time of each order in the table `delays`, and the parts of this time.

    Each part is the mean over the order's lines, in s.
    """
    columns = ["turnover_s", *(f"{part}_s" for part in PARTS)]
    return frame.groupby("order")[columns].mean()


def _lines(logs: Logs) -> pd.DataFrame:
    """Return the lines of orders completed in the measured time, with the orders' times."""
    orders = logs.orders.set_index("order")[["created_s", "completed_s"]]
    lines = logs.lines.join(orders, on="order")
    return lines[lines["completed_s"] >= logs.start_s].reset_index(drop=True)


def _time_at_rest(logs: Logs, at_s: Floats) -> Floats:
    """Return, for each time, the total time until then in which at least one robot was at rest."""
    tasks, robots = logs.tasks, logs.layout.robots
    first = np.full(robots, logs.end_s)
    np.minimum.at(first, tasks["robot"].to_numpy(), tasks["begin_s"].to_numpy())
    resting = tasks[tasks["kind"] == _REST]
    begin = np.concatenate([np.zeros(robots), resting["begin_s"].to_numpy()])
    end = np.concatenate([first, resting["end_s"].to_numpy()])
    order = np.argsort(begin, kind="stable")
    begin, end = begin[order], np.maximum.accumulate(end[order])
    apart = np.flatnonzero(begin[1:] > end[:-1])
    starts = begin[np.concatenate([[0], apart + 1])]
    ends = end[np.concatenate([apart, [len(end) - 1]])]
    return covered(starts, ends, at_s)


class _Moments:
    """For each order line, the times (s) at which its robot reached certain stages before the pick.

    Attributes
    ----------
    task
        When it got the task to bring the pod.
    lift
        When it lifted the pod; `task` if it already carried the pod.
    queue
        When it reached the queue zone; `lift` if it was already at the station.
    visit
        When it reached the station.
    to_pod, to_station
        The robot's drives to the pod and to the station.
    """

    def __init__(self, logs: Logs, robot: Integers, picked: Floats) -> None:
        tasks = logs.tasks[logs.tasks["kind"] == _PICK]
        self.task = _last(tasks["robot"], tasks["begin_s"], robot, picked)
        visits = logs.visits
        self.visit = _last(visits["robot"], visits["begin_s"], robot, picked)
        self.visit = np.where(self.visit < self.task, self.task, self.visit)
        lifts = logs.lifts
        lift = _last(lifts["robot"], lifts["time_s"], robot, self.visit)
        self.lift = np.maximum(lift, self.task)
        trips = logs.all_trips
        self.to_pod = _Drives(trips, _TO_POD, robot, self.task, self.lift)
        self.to_station = _Drives(trips, _TO_STATION, robot, self.lift, self.visit)
        self.queue = np.maximum(self.to_station.end, self.lift)


class _Drives:
    """The last trip of a given kind of each robot within a time interval.

    Attributes
    ----------
    end
        End of the trip; the start of the interval if there was no such trip.
    """

    def __init__(
        self,
        trips: dict[str, NDArray[np.float64]],
        kind: int,
        robot: Integers,
        from_s: Floats,
        to_s: Floats,
    ) -> None:
        own = trips["kind"] == kind
        found = _last_row(trips["robot"][own], trips["end_s"][own], robot, to_s)
        begin, end, unhindered, awaited = (
            np.append(trips[name][own], 0.0)[found]
            for name in ("start_s", "end_s", "unhindered_s", "awaited_s")
        )
        there = (found >= 0) & (end >= from_s)
        self._from = from_s
        self._begin = np.where(there, np.maximum(begin, from_s), from_s)
        self.end = np.where(there, end, from_s)
        self._unhindered = np.where(there, unhindered, 0.0)
        self._planned = np.where(there, np.maximum(begin + awaited, self._begin), self._begin)
        self._is_to_pod = kind == _TO_POD

    def awaited(self, from_s: Floats, to_s: Floats) -> Floats:
        """Return the part of a time interval in which each robot waited for its plan."""
        awaited = np.minimum(self._planned, to_s) - np.maximum(self._begin, from_s)
        clipped: Floats = np.clip(awaited, 0.0, to_s - from_s)
        return clipped

    def hindered(self, from_s: Floats, to_s: Floats) -> Floats:
        """Return the hindered time of the part of each drive that lies in a time interval.

        Hindrance is distributed evenly over a drive. A drive to a pod counts from the task to the
        lift, so it includes time for which another robot was standing beneath the pod.
        """
        since = self._from if self._is_to_pod else self._begin
        until = to_s if self._is_to_pod else self.end
        whole = np.maximum(until - self._from, 0.0)
        awaited = self._planned - self._begin
        late = np.clip(until - since - self._unhindered - awaited, 0.0, whole)
        share = np.divide(to_s - from_s, whole, out=np.zeros_like(whole), where=whole > 0)
        most = to_s - from_s - self.awaited(from_s, to_s)
        clipped: Floats = np.clip(late * np.minimum(share, 1.0), 0.0, most)
        return clipped


def _last(
    robots: pd.Series[int], times: pd.Series[float], robot: Integers, until_s: Floats
) -> Floats:
    """Return, for each entry of `robot`, its last time up to `until_s`; -inf if there is none."""
    found = _last_row(np.asarray(robots), np.asarray(times, np.float64), robot, until_s)
    return np.append(np.asarray(times, np.float64), -np.inf)[found]


def _last_row(
    robots: NDArray[np.int64] | Floats, times: Floats, robot: Integers, until_s: Floats
) -> Integers:
    """Return, for each entry of `robot`, the row of its last time up to `until_s`, or -1."""
    order = np.lexsort((times, robots))
    found = np.full(len(robot), -1, np.int64)
    for one in np.unique(robot):
        low, high = np.searchsorted(robots[order], [one, one + 1])
        here = robot == one
        place = np.searchsorted(times[order[low:high]], until_s[here], side="right") - 1
        rows = order[low:high]
        found[here] = np.append(rows, -1)[place] if len(rows) else -1
    return found
