"""Functions about stations and robots that several TA rules use."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.control.decisions import BringForBundles, BringForPicks
from rmfs.world.stations import PickStation
from rmfs.world.tasks import VisitTask

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from rmfs.control.decisions import TaskDecision
    from rmfs.control.ta import Consult
    from rmfs.control.view import View
    from rmfs.world.robots import Robot


def waypoints(view: View) -> NDArray[np.int64]:
    """Return the waypoint of each of the S pick and replenishment stations, shape (S,)."""
    return np.array([station.waypoint for station in view.stations])


def by_kind(view: View, stations: Iterable[int]) -> tuple[list[int], list[int]]:
    """Divide stations into pick stations and replenishment stations."""
    picks: list[int] = []
    others: list[int] = []
    for station in stations:
        (picks if isinstance(view.stations[station], PickStation) else others).append(station)
    return picks, others


def bring(view: View, robot: Robot, pod: int, station: int) -> TaskDecision:
    """Return the decision to let a robot bring a pod to a pick or replenishment station."""
    if isinstance(view.stations[station], PickStation):
        return BringForPicks(robot, pod, station)
    return BringForBundles(robot, pod, station)


def station_of_task(robot: Robot) -> int:
    """Return the pick or replenishment station to which a robot's task leads; -1 if none."""
    task = robot.task
    return -1 if task is None or isinstance(task, VisitTask) else task.station


def keeper_of(view: View, robot: Robot, pod: int) -> Robot:
    """Return the idle robot beneath a stored, available pod; if there is none, the given robot.

    A robot on its way to rest beneath the pod counts as being there.
    """
    storage = view.storage
    keeper = storage.kept_by[storage.place_of[pod]]
    return robot if keeper < 0 else view.robots[keeper]


def near_by(
    view: View, robot: Robot, radius_m: float, among: Iterable[int], consult: Consult
) -> list[int]:
    """Return those stations of `among` that are near a robot and have work for its pod.

    A station is near if it is on the robot's tier and its Euclidean distance is at most `radius_m`.
    """
    stations = [view.stations[index] for index in among]
    if not stations:
        return []
    where = np.array([station.waypoint for station in stations])
    metres = view.travel.metres(robot.waypoint, where).tolist()
    return [
        station.index
        for station, distance in zip(stations, metres, strict=True)
        if distance <= radius_m
        and station.tier == robot.tier
        and consult.serves(robot.pod, station.index)
    ]


def far_first(view: View) -> list[int]:
    """Return the pick and replenishment stations, those farthest from the middle of the tier first.

    Stations at equal distances are in order of number.
    """
    layout, at = view.layout, waypoints(view)
    tiers = [layout.tiers[tier] for tier in layout.tier[at].tolist()]
    x = layout.x_m[at] - np.array([tier.length_m / 2 for tier in tiers])
    y = layout.y_m[at] - np.array([tier.width_m / 2 for tier in tiers])
    order: list[int] = np.argsort(-(x * x + y * y), kind="stable").tolist()
    return order
