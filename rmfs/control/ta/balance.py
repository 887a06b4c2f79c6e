"""Functions for TA rules that assign robots to stations: how many each station gets, and which."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray


def split(robots: int, first: float, second: float) -> tuple[int, int]:
    """Divide robots between two groups in proportion to weights; return the number in each group.

    Numbers are rounded down. If this leaves one robot over, it goes to the group with fewer robots
    or, in a tie, to the first group, but never to a group of weight 0. If both weights are 0, both
    groups are empty.
    """
    total = first + second
    if total <= 0:
        return 0, 0
    # the tolerance is for weights such as 0.1, which binary numbers only approximate
    a, b = int(robots * first / total + 1e-9), int(robots * second / total + 1e-9)
    rest = robots - a - b
    if second <= 0 or (first > 0 and a <= b):
        return a + rest, b
    return a, b + rest


def deal(robots: int, stations: Sequence[int], limit: int, goals: dict[int, int]) -> int:
    """Assign robots to stations in turn, up to `limit` per station; return the number left over.

    Parameters
    ----------
    robots
        Number of robots to be assigned.
    stations
        Stations in the order in which they get robots.
    goals
        Number of robots of each station; the function increases these numbers in place.
    """
    while robots > 0:
        before = robots
        for station in stations:
            if robots > 0 and goals[station] < limit:
                goals[station] += 1
                robots -= 1
        if robots == before:
            break
    return robots


def reassign(
    station_of: list[int], goals: dict[int, int], distance: NDArray[np.float64]
) -> list[int]:
    """Assign robots to stations below their goal, the nearest pair of robot and station first.

    A robot may be reassigned if it has no station, or if its station has more robots than its goal.
    Ties go to the robot, then to the station, with the lowest number.

    Parameters
    ----------
    station_of
        Station of each of the R robots, or -1.
    goals
        Number of robots that each station should have; 0 for stations not listed.
    distance
        Distance between each robot and each station, in any unit, shape (R, S).

    Returns
    -------
    list of int
        The new station of each robot, or -1. If a station still has more robots than its goal, the
        excess robots (those with the highest numbers) get -1.
    """
    result = list(station_of)
    surplus = {station: -goal for station, goal in goals.items()}
    for station in result:
        if station >= 0:
            surplus[station] = surplus.get(station, 0) + 1
    cost = np.full(distance.shape, np.inf)
    movable = [s < 0 or surplus[s] > 0 for s in result]
    short = [station for station, count in surplus.items() if count < 0]
    cost[np.ix_(movable, short)] = distance[np.ix_(movable, short)]
    while short:
        robot, station = divmod(int(cost.argmin()), len(cost[0]))
        if cost[robot, station] == np.inf:
            break
        former = result[robot]
        result[robot] = station
        cost[robot] = np.inf
        surplus[station] += 1
        if surplus[station] == 0:
            cost[:, station] = np.inf
        if former >= 0:
            surplus[former] -= 1
            if surplus[former] == 0:
                cost[[r for r, s in enumerate(result) if s == former]] = np.inf
    return _without_excess(result, surplus)


def _without_excess(station_of: list[int], surplus: dict[int, int]) -> list[int]:
    """Take the last robots away from stations that still have too many."""
    result = list(station_of)
    for robot in reversed(range(len(result))):
        station = result[robot]
        if station >= 0 and surplus[station] > 0:
            surplus[station] -= 1
            result[robot] = -1
    return result
