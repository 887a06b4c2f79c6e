r"""The problem: stays of pods, with known begin and end, and zones of storage locations.

.. math::

    \min \sum_{sz} c_{sz} x_{sz}, \quad \sum_z x_{sz} = 1, \quad
    \sum_{s \text{ present at } t} x_{sz} \le k_z \text{ for all } t, \quad x \in \{0, 1\}

Here :math:`x_{sz}` is 1 if stay s is in zone z, and zone z has :math:`k_z` storage locations
(places). A stay lasts from the moment when a place is assigned to a pod until the pod has left that
place, ``[begin, end)``. The places of a zone are interchangeable. If at most :math:`k_z` stays
overlap at any time, each stay can have a place to itself, because interval graphs are perfect. A
pod that is already stored has a stay that begins now and is allowed only in the pod's current zone.
(Weidinger, Boysen, Briskorn 2018 decide on single places, that is, zones of one place.)
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.checks import costs, integers, reals, require


@dataclass(frozen=True)
class Stays:
    """Stays of pods and zones of places.

    Parameters
    ----------
    begin_s, end_s
        Begin and end of each stay, shape (S,), in s; every stay has a positive length.
    cost_s
        Robot time of each stay in each zone: for the drive to the zone and for the drive from there
        to the next station, shape (S, Z), in s; +inf where the stay is not allowed.
    capacity
        Number of places of each zone, shape (Z,).

    Raises
    ------
    ModelError
        If a shape or a value is wrong.
    """

    begin_s: NDArray[np.float64]
    end_s: NDArray[np.float64]
    cost_s: NDArray[np.float64]
    capacity: NDArray[np.int64]

    def __post_init__(self) -> None:
        cost_s = costs("cost_s", self.cost_s, (None, None))
        stays, zones = cost_s.shape
        object.__setattr__(self, "cost_s", cost_s)
        object.__setattr__(self, "begin_s", reals("begin_s", self.begin_s, (stays,)))
        object.__setattr__(self, "end_s", reals("end_s", self.end_s, (stays,)))
        object.__setattr__(self, "capacity", integers("capacity", self.capacity, (zones,), low=0))
        require(bool((self.begin_s < self.end_s).all()), "end_s", "must be after begin_s")

    @cached_property
    def periods(self) -> tuple[NDArray[np.int64], NDArray[np.int64], int]:
        """The periods during which each stay is present, and the number of periods.

        A *period* is a moment at which the occupied places must be counted. The number of stays
        present can only grow until a stay ends. So it suffices to count just before the end of a
        stay, and only if a stay has begun since the previous end. The stays present at such a
        moment form a maximal set of simultaneous stays.

        Returns
        -------
        Index of the first period of each stay, shape (S,); one more than the index of the last
        period of each stay, shape (S,); and the number of periods.
        """
        ended = np.searchsorted(np.sort(self.end_s), self.begin_s, side="right")
        distinct, first = np.unique(ended, return_inverse=True)
        # a period opens with its earliest begin, after the end that closed the one before
        opens = np.full(len(distinct), np.inf)
        np.minimum.at(opens, first, self.begin_s)
        last = np.searchsorted(opens, self.end_s, side="left")
        return first.astype(np.int64), last.astype(np.int64), len(distinct)

    def present(self, zone: NDArray[np.int64], counted: int) -> NDArray[np.int64]:
        """Count the stays in one zone in each period.

        Parameters
        ----------
        zone
            Zone of each stay, shape (S,).
        counted
            Index of the zone whose stays are counted.

        Returns
        -------
        Number of stays present in the zone in each period, shape (periods,).
        """
        first, last, periods = self.periods
        change = np.zeros(periods + 1, np.int64)
        np.add.at(change, first[zone == counted], 1)
        np.add.at(change, last[zone == counted], -1)
        return np.cumsum(change[:-1])


def objective(data: Stays, zone: NDArray[np.int64]) -> float:
    """Return the robot time of all stays, in s.

    Parameters
    ----------
    data
        The problem.
    zone
        Zone of each stay, shape (S,).
    """
    return float(data.cost_s[np.arange(len(zone)), zone].sum())


def violations(data: Stays, zone: NDArray[np.int64]) -> list[str]:
    """List the conditions that a choice of zones violates; empty if the choice is feasible.

    Parameters
    ----------
    data
        The problem.
    zone
        Zone of each stay, shape (S,).
    """
    stays, zones = data.cost_s.shape
    if zone.shape != (stays,) or not ((zone >= 0) & (zone < zones)).all():
        return ["zone must have a zone for each stay"]
    found = []
    if np.isinf(data.cost_s[np.arange(stays), zone]).any():
        found.append("a stay is in a zone that is not allowed")
    for each, places in enumerate(data.capacity.tolist()):
        if (data.present(zone, each) > places).any():
            found.append(f"zone {each} has more stays at a time than locations")
    return found
