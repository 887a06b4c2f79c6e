r"""The least robot time that each visit requires to bring its pod and to take it away.

A pod comes to a station from a storage location, where it was lifted, or directly from another
station. It leaves for a storage location, where it is set down, or for another station. A drive
from or to storage belongs to one visit; a drive between two stations is shared by two visits, each
of which is charged one half. With driving times t and storage locations l, the times of station s
are

.. math::

    in_s &= \min(lift + \min_l t_{ls},\; \tfrac12 \min_{r \ne s} t_{rs}) \\
    out_s &= \min(setdown + \min_l t_{sl},\; \tfrac12 \min_{r \ne s} t_{sr})

Whatever a robot does, the charges of its visits never exceed its total time for driving, lifting
and setting down. Empty driving is not counted, as it can be zero.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.checks import costs, number


class Legs(NamedTuple):
    """Least robot times per visit, to bring a pod and to take it away, in s, both shape (S,)."""

    inbound_s: NDArray[np.float64]
    outbound_s: NDArray[np.float64]


def visit_legs(
    from_storage_s: NDArray[np.float64],
    to_storage_s: NDArray[np.float64],
    between_s: NDArray[np.float64],
    transfer_s: float,
) -> Legs:
    """Compute the robot time charged to a visit of each station.

    In all arrays, the pick stations come before the replenishment stations.

    Parameters
    ----------
    from_storage_s
        Least driving time from a storage location to each station, shape (S,), in s.
    to_storage_s
        Least driving time from each station to a storage location, shape (S,), in s.
    between_s
        Least driving time from each station (row) to each station (column), shape (S, S), in s;
        +inf if no pod is brought directly from the one to the other. The diagonal is not read: a
        pod that stays makes no new visit.
    transfer_s
        Least time to lift or to set down a pod, in s.

    Returns
    -------
    The robot times. The first is +inf if no pod can reach the station, the second if no pod can
    leave it. `PickStations` and `Refill` raise an error for such a station.

    Raises
    ------
    ModelError
        If a shape or a value is wrong.
    """
    inward = costs("from_storage_s", from_storage_s, (None,), low=0)
    stations = len(inward)
    outward = costs("to_storage_s", to_storage_s, (stations,), low=0)
    between = costs("between_s", between_s, (stations, stations), low=0).copy()
    lift = number("transfer_s", transfer_s, low=0)
    np.fill_diagonal(between, math.inf)
    return Legs(
        np.minimum(lift + inward, between.min(axis=0, initial=math.inf) / 2.0),
        np.minimum(lift + outward, between.min(axis=1, initial=math.inf) / 2.0),
    )
