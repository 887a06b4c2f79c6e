r"""The problem: waiting bundles, and pods and stations with free space.

.. math::

    \min \sum_{ps} trip_{ps}\, y_{ps} + \sum_b leave_b\, l_b - \sum_{bp} worth_{bp}\, x_{bp}

Every bundle b goes to one pod p or is left, :math:`\sum_p x_{bp} + l_b = 1`. A pod that gets a
bundle is brought to one station s, :math:`x_{bp} \le \sum_s y_{ps} \le 1`. The bundles of a pod fit
into its free space, and the bundles of all pods brought to a station fit into the free space of the
station. The worth of a bundle in a pod is the robot time that the bundle will save there
(`bundle_worth_s`), so cost and worth are both in seconds, and a trip is made if its bundles save
more than it costs. The waiting bundles are rated one by one; the mutual benefit of two new bundles
in the same pod is not counted.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rmfs.solvers.models.checks import costs, reals

LEFT = -1
"""Stands for no pod (of a bundle left for later) or no station (of a pod that is not brought)."""

PARTS = 16
"""Number of parts per space unit; spaces are rounded to whole parts."""


@dataclass(frozen=True)
class Replenishment:
    """Bundles, pods and replenishment stations.

    Spaces are rounded to sixteenths of a space unit (bundles up, free space down), so that all back
    ends solve the same problem in integers.

    Parameters
    ----------
    worth_s
        Robot time that storing a bundle in a pod saves later, shape (B, P), in s; -inf where the
        bundle may not be stored.
    leave_s
        Cost of leaving each bundle for later, shape (B,), in s; +inf if it must be stored.
    space
        Space units of each bundle, shape (B,).
    pod_space
        Space units free in each pod, shape (P,).
    trip_s
        Robot time to bring each pod to each station and back, shape (P, S), in s; +inf where the
        pod may not go, 0 where the pod is going anyway.
    station_space
        Space units free at each station, shape (S,).

    Raises
    ------
    ModelError
        If a shape or a value is wrong.
    """

    worth_s: NDArray[np.float64]
    leave_s: NDArray[np.float64]
    space: NDArray[np.float64]
    pod_space: NDArray[np.float64]
    trip_s: NDArray[np.float64]
    station_space: NDArray[np.float64]

    def __post_init__(self) -> None:
        worth_s = -costs("worth_s", _negative(self.worth_s), (None, None))
        worth_s.setflags(write=False)
        bundles, pods = worth_s.shape
        trip_s = costs("trip_s", self.trip_s, (pods, None), low=0)
        checked = {
            "worth_s": worth_s,
            "leave_s": costs("leave_s", self.leave_s, (bundles,)),
            "space": _parts(np.ceil, "space", self.space, bundles),
            "pod_space": _parts(np.floor, "pod_space", self.pod_space, pods),
            "trip_s": trip_s,
            "station_space": _parts(np.floor, "station_space", self.station_space, trip_s.shape[1]),
        }
        for field, value in checked.items():
            object.__setattr__(self, field, value)


def _negative(value: ArrayLike) -> ArrayLike:
    raw = np.asarray(value)
    return -raw if raw.dtype.kind in "if" else value


def _parts(rounding: np.ufunc, field: str, value: ArrayLike, count: int) -> NDArray[np.float64]:
    """Check spaces and round them to parts of a unit."""
    exact = reals(field, value, (count,), low=0)
    rounded: NDArray[np.float64] = rounding(exact * PARTS) / PARTS
    rounded.setflags(write=False)
    return rounded


@dataclass(frozen=True)
class Stocking:
    """Where bundles and pods go.

    Attributes
    ----------
    pod
        Pod of each bundle, or `LEFT`, shape (B,).
    station
        Station of each pod, or `LEFT`, shape (P,).
    """

    pod: NDArray[np.int64]
    station: NDArray[np.int64]


def objective(data: Replenishment, stocking: Stocking) -> float:
    """Return the cost of trips and of bundles left minus the worth of stored bundles, in s.

    Parameters
    ----------
    data
        The problem.
    stocking
        Where bundles and pods go.
    """
    stored, brought = stocking.pod != LEFT, stocking.station != LEFT
    trips = data.trip_s[np.flatnonzero(brought), stocking.station[brought]]
    worth = data.worth_s[np.flatnonzero(stored), stocking.pod[stored]]
    return math.fsum(trips) + math.fsum(data.leave_s[~stored]) - math.fsum(worth)


def violations(data: Replenishment, stocking: Stocking) -> list[str]:
    """Return what is wrong with a stocking; empty if it is feasible.

    Parameters
    ----------
    data
        The problem.
    stocking
        Where bundles and pods go.
    """
    pods, stations = data.trip_s.shape
    pod, station = stocking.pod, stocking.station
    for chosen, count, of in ((pod, pods, data.leave_s), (station, stations, data.pod_space)):
        if chosen.shape != of.shape or not ((chosen >= LEFT) & (chosen < count)).all():
            return ["pod must have a pod or -1 per bundle, and station a station or -1 per pod"]
    found = []
    stored = pod != LEFT
    if (station[pod[stored]] == LEFT).any():
        return ["a pod gets a bundle, but is brought to no station"]
    in_pod = np.bincount(pod[stored], weights=data.space[stored], minlength=pods)
    if (in_pod > data.pod_space).any():
        found.append("a pod gets more bundles than fit into it")
    at = np.bincount(station[pod[stored]], weights=data.space[stored], minlength=stations)
    if (at > data.station_space).any():
        found.append("a station gets more bundles than fit into it")
    if not math.isfinite(objective(data, stocking)):
        found.append("a pair is not allowed, or a bundle that must be stored is left out")
    return found
