"""How long it takes to get from here to there, as controllers may ask."""

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
"""Straight distance, distance along the axes, length of the shortest way, and time for it."""


class TravelTimes(Protocol):
    """The part of traffic that knows travel times; they depend on the kind of the robot."""

    def travel_times_to(self, waypoint: int, loaded: bool, robot: int = ...) -> NDArray[np.float64]:
        """Unhindered times from all waypoints to one, shape (N,), s; inf if unreachable."""
        ...

    def travel_times_from(
        self, waypoint: int, loaded: bool, robot: int = ...
    ) -> NDArray[np.float64]:
        """Unhindered times from one waypoint to all, shape (N,), s; inf if unreachable."""
        ...

    def robot_waypoint(self, robot: int) -> int:
        """Where a robot stands, or the next waypoint at which it stops."""
        ...


class TravelTables:
    """What has been worked out of times and distances: it holds for every copy of a run.

    Attributes
    ----------
    paths
        Lengths of the shortest ways.
    distances, to, away
        By waypoint: distances of a metric, times to it, and times from it, shape (N,) each.
    """

    def __init__(self, layout: Layout) -> None:
        self.paths = PathLengths(layout)
        self.distances: dict[tuple[int, Metric, bool], NDArray[np.float64]] = {}
        self.to: dict[tuple[int, bool], NDArray[np.float64]] = {}
        self.away: dict[tuple[int, bool], NDArray[np.float64]] = {}


class Travel:
    """Travel times and distances between waypoints.

    Exact times come from traffic and are kept, like distances, for the waypoints asked for: ask for
    stations, of which there are few. From anywhere else `estimate_s` is meant.

    Parameters
    ----------
    layout
        The warehouse.
    times
        Traffic, or whatever else knows times.

    Attributes
    ----------
    tier
        Tier of each waypoint, shape (N,).
    tiers
        Number of tiers.
    tables
        What has been worked out so far.
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
        # farther than anything on one tier, so that the own tier always comes first
        self._other_tier_m = 1 + max(tier.length_m + tier.width_m for tier in layout.tiers)

    def to(self, waypoint: int, *, loaded: bool) -> NDArray[np.float64]:
        """Unhindered times from all waypoints to this one, shape (N,), s."""
        times = self.tables.to.get((waypoint, loaded))
        if times is None:
            times = self.tables.to[waypoint, loaded] = self._times.travel_times_to(waypoint, loaded)
        return times

    def away(self, waypoint: int, *, loaded: bool, keep: bool = True) -> NDArray[np.float64]:
        """Unhindered times from this waypoint to all, shape (N,), s.

        Without `keep` they are not remembered: for who remembers what it needs of them.
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
        """How far it is from every waypoint to this one, shape (N,), m or, by time, s."""
        if metric == "time":
            return self.to(waypoint, loaded=loaded)
        if metric == "path":
            return self._kept(waypoint, metric, loaded, self.tables.paths.to)
        return self._kept(waypoint, metric, True, self._straight(metric))

    def distances_from(
        self, waypoint: int, metric: Metric, *, loaded: bool = True, keep: bool = True
    ) -> NDArray[np.float64]:
        """How far it is from this waypoint to every other, shape (N,), m or, by time, s.

        Times are not remembered without `keep`.
        """
        if metric == "time":
            return self.away(waypoint, loaded=loaded, keep=keep)
        if metric == "path":
            # keys of ways in the other direction are negative
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
        """How far it is from a waypoint to others, shape (n,), m or, by time, s.

        Straight distances are worked out each time: to be used where waypoints hardly ever repeat.
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
        """Distances along the axes to other waypoints, more on other tiers, m.

        Shape (n,); for waypoints of shape (m, 1) shape (m, n).
        """
        distance: NDArray[np.float64] = np.abs(self._x[others] - self._x[waypoint])
        distance += np.abs(self._y[others] - self._y[waypoint])
        if self.tiers > 1:
            distance += self._other_tier_m * (self.tier[others] != self.tier[waypoint])
        return distance

    def estimate_s(self, waypoint: int | _Waypoints, others: _Waypoints) -> NDArray[np.float64]:
        """Estimate times to other waypoints: Manhattan distance at top speed and one turn.

        Parameters
        ----------
        waypoint
            One, or several of shape (m, 1).
        others
            Waypoints, shape (n,).

        Returns
        -------
        NDArray
            Seconds, shape (n,), or (m, n) from several waypoints.
        """
        seconds = self.manhattan_metres(waypoint, others)
        seconds *= self._seconds_per_metre
        seconds += self._quarter_turn_s
        return seconds

    def metres(self, waypoint: int, others: NDArray[np.signedinteger[Any]]) -> NDArray[np.float64]:
        """Euclidean distances to other waypoints, more on other tiers, shape (n,), m."""
        x, y = self._x[others] - self._x[waypoint], self._y[others] - self._y[waypoint]
        distance: NDArray[np.float64] = np.sqrt(
            x * x + y * y
        )  # hypot differs between maths libraries
        if self.tiers > 1:
            distance += self._other_tier_m * (self.tier[others] != self.tier[waypoint])
        return distance

    def robot_waypoint(self, robot: int) -> int:
        """Where a robot stands, or the next waypoint at which it stops."""
        return self._times.robot_waypoint(robot)
