"""Travel times and distances for controllers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from rmfs.control.paths import PathLengths

if TYPE_CHECKING:
    from collections.abc import Callable

    from rmfs.layout.model import Layout


_Waypoints = NDArray[np.signedinteger[Any]]

Metric = Literal["euclidean", "manhattan", "path", "time"]
"""Measures of distance: Euclidean, Manhattan, length of the shortest path, and travel time."""


class TravelTimes(Protocol):
    """The part of the traffic model that `Travel` needs.

    Travel times depend on the kind of robot; the returned times are those of the kind to which
    robot number `robot` (default: 0) belongs.
    """

    def travel_times_to(self, waypoint: int, loaded: bool, robot: int = ...) -> NDArray[np.float64]:
        """Return unhindered times from all waypoints to one, in s (inf: no path), shape (N,)."""
        ...

    def travel_times_from(
        self, waypoint: int, loaded: bool, robot: int = ...
    ) -> NDArray[np.float64]:
        """Return unhindered times from one waypoint to all, in s (inf: no path), shape (N,)."""
        ...

    def robot_waypoint(self, robot: int) -> int:
        """Return the waypoint where a robot stops next or, if it has no plan, where it stands."""
        ...

    def heat(self) -> dict[str, NDArray[Any]]:
        """Return statistics of the waypoints by name (`rmfs.traffic.readings.Readings.heat`).

        Among them are `visits`, how often robots passed each waypoint or stopped there, and
        `waiting_s`, how long they stood there.
        """
        ...


class TravelTables:
    """Cached travel times and distances.

    If a run is copied in order to try out decisions, the run and its copies share these values.

    Attributes
    ----------
    paths
        Lengths of shortest paths.
    distances
        Distances from all waypoints to one waypoint w, in m, shape (N,). The key consists of w, the
        metric, and whether the robot is loaded. For path lengths in the other direction, from w to
        all waypoints, the key contains ``~w`` instead of w.
    to, away
        Travel times from all waypoints to one waypoint w (`to`), or from w to all waypoints
        (`away`), in s, shape (N,). The key consists of w and whether the robot is loaded.
    """

    def __init__(self, layout: Layout) -> None:
        self.paths = PathLengths(layout)
        self.distances: dict[tuple[int, Metric, bool], NDArray[np.float64]] = {}
        self.to: dict[tuple[int, bool], NDArray[np.float64]] = {}
        self.away: dict[tuple[int, bool], NDArray[np.float64]] = {}


class Travel:
    """Travel times and distances between waypoints.

    Travel times come from the traffic model. They are those of robot 0's kind, from standstill to
    standstill with the best initial heading. Times and distances between a waypoint and all others
    are cached; request them only for stations, of which there are few. For other waypoints, use
    `estimate_s`.

    Parameters
    ----------
    layout
        The warehouse.
    times
        The traffic model, or any other source of travel times.

    Attributes
    ----------
    tier
        Tier of each waypoint, shape (N,).
    tiers
        Number of tiers.
    tables
        Cached values.
    """

    def __init__(self, layout: Layout, times: TravelTimes) -> None:
        self._times = times
        self.tables = TravelTables(layout)
        self._x, self._y = layout.x_m, layout.y_m
        self.tier = layout.tier
        self.tiers = len(layout.tiers)
        kinds = layout.robot_kinds
        self._seconds_per_metre = 1 / min(kind.top_speed_m_s for kind in kinds)
        self._quarter_turn_s = max(kind.full_turn_s for kind in kinds) / 4
        # longer than any distance on one tier, so that the own tier always comes first
        self._other_tier_m = 1 + max(tier.length_m + tier.width_m for tier in layout.tiers)

    def to(self, waypoint: int, *, loaded: bool) -> NDArray[np.float64]:
        """Return unhindered times from all waypoints to this one, in s (inf: no path), shape (N,).

        `loaded` states whether the robot carries a pod.
        """
        times = self.tables.to.get((waypoint, loaded))
        if times is None:
            times = self.tables.to[waypoint, loaded] = self._times.travel_times_to(waypoint, loaded)
        return times

    def away(self, waypoint: int, *, loaded: bool, keep: bool = True) -> NDArray[np.float64]:
        """Return unhindered times from this waypoint to all, in s (inf: no path), shape (N,).

        `loaded` states whether the robot carries a pod. With `keep=False`, the times are not
        cached; this is for callers that have a cache of their own.
        """
        times = self.tables.away.get((waypoint, loaded))
        if times is None:
            times = self._times.travel_times_from(waypoint, loaded)
            if keep:
                self.tables.away[waypoint, loaded] = times
        return times

    def distances_to(
        self, waypoint: int, metric: Metric, *, loaded: bool = True
    ) -> NDArray[np.float64]:
        """Return distances from all waypoints to this one, in m (metric `time`: in s), shape (N,).

        `loaded` (whether the robot carries a pod) matters only for the metrics `path` and `time`.
        """
        if metric == "time":
            return self.to(waypoint, loaded=loaded)
        if metric == "path":
            return self._kept(waypoint, metric, loaded, self.tables.paths.to)
        return self._kept(waypoint, metric, True, self._straight(metric))

    def distances_from(
        self, waypoint: int, metric: Metric, *, loaded: bool = True, keep: bool = True
    ) -> NDArray[np.float64]:
        """Return distances from this waypoint to all, in m (metric `time`: in s), shape (N,).

        With `keep=False`, travel times (metric `time`) are not cached. `loaded` (whether the robot
        carries a pod) matters only for the metrics `path` and `time`.
        """
        if metric == "time":
            return self.away(waypoint, loaded=loaded, keep=keep)
        if metric == "path":
            # keys of paths in the other direction are negative
            return self._kept(~waypoint, metric, loaded, self.tables.paths.away)
        return self._kept(waypoint, metric, True, self._straight(metric))

    def between(
        self,
        waypoint: int,
        others: NDArray[np.signedinteger[Any]],
        metric: Metric,
        *,
        loaded: bool = True,
    ) -> NDArray[np.float64]:
        """Return distances from a waypoint to n others, in m (metric `time`: in s), shape (n,).

        Euclidean and Manhattan distances are not cached, so call this method for waypoints that are
        rarely requested again. `loaded` (whether the robot carries a pod) matters only for the
        metrics `path` and `time`.
        """
        if metric == "euclidean":
            return self.metres(waypoint, others)
        if metric == "manhattan":
            return self.manhattan_metres(waypoint, others)
        distances: NDArray[np.float64] = self.distances_from(waypoint, metric, loaded=loaded)[
            others
        ]
        return distances

    def _kept(
        self,
        key: int,
        metric: Metric,
        loaded: bool,
        work_out: Callable[[int, bool], NDArray[np.float64]],
    ) -> NDArray[np.float64]:
        distances = self.tables.distances.get((key, metric, loaded))
        if distances is None:
            distances = work_out(max(key, ~key), loaded)
            distances.flags.writeable = False
            self.tables.distances[key, metric, loaded] = distances
        return distances

    def _straight(self, metric: Metric) -> Callable[[int, bool], NDArray[np.float64]]:
        measure = self.metres if metric == "euclidean" else self.manhattan_metres
        everywhere = np.arange(len(self._x))
        return lambda waypoint, _: measure(waypoint, everywhere)

    def manhattan_metres(
        self, waypoint: int | _Waypoints, others: _Waypoints
    ) -> NDArray[np.float64]:
        """Return Manhattan distances to n other waypoints, in m, with a surcharge between tiers.

        The shape is (n,), or (m, n) if `waypoint` is an array of shape (m, 1).
        """
        distance = _apart(self._x, waypoint, others)
        distance += _apart(self._y, waypoint, others)
        if self.tiers > 1:
            distance += self._other_tier_m * (self.tier[others] != self.tier[waypoint])
        return distance

    def estimate_s(self, waypoint: int | _Waypoints, others: _Waypoints) -> NDArray[np.float64]:
        """Estimate travel times to other waypoints, in s, from Manhattan distances.

        The estimate is the time for the distance at top speed plus the time for a quarter turn. If
        there are several kinds of robot, the lowest top speed and the longest turning time are
        used. Waypoints on other tiers get a surcharge.

        Parameters
        ----------
        waypoint
            Where the trips start: a single waypoint; m waypoints, shape (m, 1); or one for each of
            `others`, shape (n,).
        others
            Where the trips end, shape (n,).

        Returns
        -------
        NDArray
            Seconds, shape (n,), or (m, n) if `waypoint` has shape (m, 1).
        """
        seconds = self.manhattan_metres(waypoint, others)
        seconds *= self._seconds_per_metre
        seconds += self._quarter_turn_s
        return seconds

    def one_estimate_s(self, waypoint: int, other: int) -> float:
        """Estimate the travel time between two waypoints, in s; faster than `estimate_s`."""
        x, y, tier = self._x.item, self._y.item, self.tier.item
        metres = abs(x(other) - x(waypoint)) + abs(y(other) - y(waypoint))
        if self.tiers > 1 and tier(other) != tier(waypoint):
            metres += self._other_tier_m
        return metres * self._seconds_per_metre + self._quarter_turn_s

    def metres(self, waypoint: int, others: NDArray[np.signedinteger[Any]]) -> NDArray[np.float64]:
        """Return Euclidean distances from a waypoint to n others, in m, shape (n,).

        Waypoints on other tiers get a surcharge.
        """
        x, y = self._x[others] - self._x[waypoint], self._y[others] - self._y[waypoint]
        distance: NDArray[np.float64] = np.sqrt(
            x * x + y * y
        )  # hypot differs between maths libraries
        if self.tiers > 1:
            distance += self._other_tier_m * (self.tier[others] != self.tier[waypoint])
        return distance

    def robot_waypoint(self, robot: int) -> int:
        """Return the waypoint where a robot stops next or, if it has no plan, where it stands."""
        return self._times.robot_waypoint(robot)

    def passages(self) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Return how often robots passed each waypoint or stopped there, and how long they stood.

        Both arrays have shape (N,); the times are in s and include service at stations. Times of
        robots without a destination, and times for lifting and setting down pods, are left out.
        Counting starts at time zero; all values are reset to 0 at the end of the warm-up.
        """
        counted = self._times.heat()
        return counted["visits"], counted["waiting_s"]


def _apart(
    along: NDArray[np.float64], waypoint: int | _Waypoints, others: _Waypoints
) -> NDArray[np.float64]:
    """Return the absolute difference between coordinates of waypoints, shape (n,) or (m, n)."""
    if isinstance(waypoint, np.ndarray):
        found: NDArray[np.float64] = along[others] - along[waypoint]
    else:  # in place, for the many questions about one robot and few waypoints
        found = along.take(others)
        found -= along.item(waypoint)
    return np.abs(found, out=found)
