r"""The problem: waiting bundles, and pods and stations with free space.

.. math::

    \min \sum_{ps} trip_{ps}\, y_{ps} + \sum_b leave_b\, l_b - \sum_{bp} worth_{bp}\, x_{bp}

The variable :math:`x_{bp}` is 1 if bundle b is stored in pod p, :math:`l_b` is 1 if bundle b is
left for later, and :math:`y_{ps}` is 1 if pod p is brought to station s. Every bundle is stored in
one pod or left: :math:`\sum_p x_{bp} + l_b = 1`. A pod that gets a bundle is brought to one
station: :math:`x_{bp} \le \sum_s y_{ps} \le 1`. The bundles of a pod fit into its free space, and
the bundles of all pods brought to a station fit into the free space of the station.

The worth of a bundle in a pod is the robot time that the bundle will save there (`bundle_worth_s`).
The cost of a trip is its robot time, so worth and cost can be compared. Bundles are rated one by
one; the mutual benefit of two new bundles in the same pod is not counted.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rmfs.solvers.models.checks import costs, reals

LEFT = -1
"""Pod of a bundle that is left for later, and station of a pod that is not brought."""

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
        Robot time that storing a bundle in a pod saves later, shape (B, P), in s; -inf if the
        bundle may not be stored in the pod.
    leave_s
        Cost of leaving each bundle for later, shape (B,), in s; +inf if the bundle must be stored.
    space
        Size of each bundle, shape (B,), in space units.
    pod_space
        Free space in each pod, shape (P,), in space units.
    trip_s
        Robot time to bring each pod to each station and back, shape (P, S), in s; +inf if the pod
        may not go to the station, 0 if the pod goes there anyway.
    station_space
        Free space at each station, shape (S,), in space units.

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
    # as floats: minus an unsigned number is a large one
    return -raw.astype(np.float64) if raw.dtype.kind in "iufb" else value


def _parts(rounding: np.ufunc, field: str, value: ArrayLike, count: int) -> NDArray[np.float64]:
    """Check spaces and round them to parts of a unit."""
    exact = reals(field, value, (count,), low=0)
    rounded: NDArray[np.float64] = rounding(exact * PARTS) / PARTS
    rounded.setflags(write=False)
    return rounded


@dataclass(frozen=True)
class Stocking:
    """The pod of each bundle and the station of each pod.

    Attributes
    ----------
    pod
        Pod of each bundle, or `LEFT` if the bundle is left for later, shape (B,).
    station
        Station of each pod, or `LEFT` if the pod is not brought, shape (P,).
    """

    pod: NDArray[np.int64]
    station: NDArray[np.int64]


def objective(data: Replenishment, stocking: Stocking) -> float:
    """Return the cost of trips and of leaving bundles, minus the worth of stored bundles, in s.

    Parameters
    ----------
    data
        The problem.
    stocking
        The pod of each bundle and the station of each pod.
    """
    stored, brought = stocking.pod != LEFT, stocking.station != LEFT
    trips = data.trip_s[np.flatnonzero(brought), stocking.station[brought]]
    worth = data.worth_s[np.flatnonzero(stored), stocking.pod[stored]]
    return math.fsum(trips) + math.fsum(data.leave_s[~stored]) - math.fsum(worth)


def violations(data: Replenishment, stocking: Stocking) -> list[str]:
    """Return a message for each violation found; an empty list if the stocking is feasible.

    Parameters
    ----------
    data
        The problem.
    stocking
        The pod of each bundle and the station of each pod.
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
