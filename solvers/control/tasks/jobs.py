"""Jobs: pods that stations could use next; they are the tasks of the controller TA routes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rmfs.control.pps.candidates import pick_candidates, replenishment_candidates
from rmfs.world.stations import PickStation

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from rmfs.control.pps.candidates import PickCandidates
    from rmfs.control.view import View
    from rmfs.world.stations import ReplenishmentStation


@dataclass(frozen=True)
class Worth:
    """Value of the work of a pod, in seconds of a robot's time.

    Attributes
    ----------
    unit_s, order_s, bundle_s
        Value of a unit picked, of an order completed, and of a bundle stored.
    """

    unit_s: float
    order_s: float
    bundle_s: float


@dataclass(frozen=True)
class Job:
    """A pod that a station could use.

    Attributes
    ----------
    pod, station
        Index of the pod, and of the station that could use it.
    bring_s
        Time of the loaded trip to the station, in s.
    service_s
        Service time at the station, in s.
    due_s
        Time from now until the station has finished the pods under way to it and the jobs chosen
        before this one, in s.
    worth_s
        Value of the pod's work, in s of robot time.
    """

    pod: int
    station: int
    bring_s: float
    service_s: float
    due_s: float
    worth_s: float


def jobs(view: View, worth: Worth, robots_per_station: int, per_station: int) -> list[Job]:
    """Choose the next pods of every station, one pod after another.

    The next pod of a station is the one whose value minus trip time is largest; ties go to the pod
    with the lowest number. At a pick station, the value of a pod counts units and orders, except
    those already picked or completed with the pods chosen before. At a replenishment station, it
    counts the bundles stored. Each pod is chosen only once, for one station.

    Parameters
    ----------
    view
        The world, with at least one robot.
    worth
        Values of work.
    robots_per_station
        Maximum number of robots at, or on their way to, a station.
    per_station
        Maximum number of pods chosen for each station.
    """
    taken: set[int] = set()
    found: list[Job] = []
    for station in view.stations:
        count = min(per_station, robots_per_station - len(station.tasks))
        if count > 0 and view.has_open_work(station.index):
            if isinstance(station, PickStation):
                found += _picks(view, station, worth, count, taken)
            else:
                found += _bundles(view, station, worth, count, taken)
    return found


def _picks(
    view: View, station: PickStation, worth: Worth, count: int, taken: set[int]
) -> Iterator[Job]:
    """Choose pods for the open requests of a pick station greedily."""
    pods = pick_candidates(view, view.robots[0], station)
    if not len(pods):
        return
    unit_s = view.unit_s(station.index)
    busy_s = unit_s * sum(len(task.picks) for task in station.tasks.values())
    to_station_s = view.travel.to(station.waypoint, loaded=True)
    bring_s = to_station_s[view.storage.pod_waypoint[pods.pods]]
    left = view.need[station.index][pods.skus].astype(np.int64)
    completes = _completes(pods)
    for _ in range(count):
        units = np.minimum(pods.have, left[:, None]).sum(axis=0)
        gain = units * worth.unit_s + completes.sum(axis=0) * worth.order_s
        rating = np.where(units > 0, gain - bring_s, -np.inf)
        rating[np.isin(pods.pods, list(taken))] = -np.inf
        best = int(rating.argmax())
        if rating[best] == -np.inf:
            return
        pod, service_s = int(pods.pods[best]), unit_s * float(units[best])
        yield Job(pod, station.index, float(bring_s[best]), service_s, busy_s, float(gain[best]))
        taken.add(pod)
        busy_s += service_s
        left -= np.minimum(pods.have[:, best], left)
        completes = completes & ~completes[:, [best]]


def _completes(pods: PickCandidates) -> NDArray[np.bool_]:
    """Return which orders each pod completes, shape (O, C)."""
    done = pods.completed()
    return done.flags[: done.assigned].copy()


def _bundles(
    view: View, station: ReplenishmentStation, worth: Worth, count: int, taken: set[int]
) -> Iterator[Job]:
    """Choose the pods with the most bundles."""
    pods = replenishment_candidates(view, view.robots[0], station).pods
    each_s = view.layout.replenishment_stations[station.number].bundle_transfer_s
    busy_s = each_s * sum(len(task.bundles) for task in station.tasks.values())
    bundles = view.bundles_waiting[station.number][pods]
    bring_s = view.travel.to(station.waypoint, loaded=True)[view.storage.pod_waypoint[pods]]
    rating = bundles * worth.bundle_s - bring_s
    for best in np.argsort(-rating, kind="stable").tolist():
        pod = int(pods[best])
        if count == 0:
            return
        if pod not in taken:
            taken.add(pod)
            count -= 1
            service_s, worth_s = (
                each_s * float(bundles[best]),
                worth.bundle_s * float(bundles[best]),
            )
            yield Job(pod, station.index, float(bring_s[best]), service_s, busy_s, worth_s)
            busy_s += service_s
