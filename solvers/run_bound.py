"""The proven bound on units per hour in a warehouse, computed from its layout and SKUs.

The bound depends on travel and handling times, the capacity of pods, and the numbers of robots and
stations, but not on controllers, demand or seed. Therefore one number holds for all runs of a
layout with the same SKUs and the same duration.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from rmfs.measure.tables.at_pile_on import change_s
from rmfs.solvers.models.run_bound import (
    Legs,
    PickStations,
    Refill,
    RunBound,
    Stock,
    solve,
    visit_legs,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Collection

    from numpy.typing import NDArray

    from rmfs.control.travel import TravelTimes
    from rmfs.layout.model import Layout
    from rmfs.scenario import SkuSet

_SAFE = 1.0 - 1e-6
"""Factor that shortens travel times slightly, as they are sums of rounded microseconds."""


def units_per_h_bound(layout: Layout, skus: SkuSet, times: TravelTimes, duration_s: float) -> float:
    """Return an upper bound on units per hour; infinite if some handling takes no time.

    Parameters
    ----------
    layout, skus
        The warehouse and its SKUs.
    times
        Unhindered travel times between the waypoints of the layout.
    duration_s
        Length of the window in which units are counted, in s.
    """
    data = run_bound(layout, skus, times, duration_s)
    return math.inf if data is None else solve(data).bound


def units_per_h_keeping_stock(
    layout: Layout,
    skus: SkuSet,
    times: TravelTimes,
    duration_s: float,
    fleets: Collection[int],
) -> dict[int, float]:
    """Return an upper bound on units per hour for each fleet size, for runs that keep their stock.

    A run keeps its stock if it stores at least as many units as it picks. The bound holds for any
    choice of orders, pods and places, even for a controller that knows all future orders. It is
    infinite if some handling takes no time. The bound assumes that every bundle has the number of
    units that `bundle_units` gives for its SKU.

    Parameters
    ----------
    layout, skus, times, duration_s
        As for `units_per_h_bound`; of the robots in the layout, only the kinds matter.
    fleets
        The numbers of robots for which bounds are computed.
    """
    data = run_bound(layout, skus, times, duration_s)
    if data is None:
        return dict.fromkeys(fleets, math.inf)
    refill = data.refill
    most, least = int(skus.bundle_units.max()), max(int(skus.bundle_units.min()), 1)
    refill = replace(
        refill,
        bundle_units=min(refill.bundle_units, most),
        bundles_per_visit=max(refill.bundles_per_visit // least, 1),
    )
    kept = replace(data, refill=refill).keeping_stock()
    return {robots: solve(replace(kept, robots=robots)).bound for robots in fleets}


def run_bound(
    layout: Layout, skus: SkuSet, times: TravelTimes, duration_s: float
) -> RunBound | None:
    """Return the input of the bound; None if some handling takes no time (there is no bound then).

    Parameters
    ----------
    layout, skus, times, duration_s
        As for `units_per_h_bound`.
    """
    picking, refilling = layout.pick_stations, layout.replenishment_stations
    at_least_s = [
        *(max(one.unit_transfer_s, one.unit_pick_s) for one in picking),
        *(one.bundle_transfer_s for one in refilling),
    ]
    if not all(at_least_s):
        return None
    legs = _legs(layout, times)
    number = len(picking)
    fits = np.floor(layout.pod_capacity / skus.space_per_unit.min() * (1.0 + 1e-9)).astype(np.int64)
    largest = max(int(fits.max(initial=0)), 1)
    return RunBound(
        duration_s,
        layout.robots,
        PickStations(
            np.array([station.unit_transfer_s for station in picking]),
            np.array([station.unit_pick_s for station in picking]),
            np.array([change_s(layout, station.waypoint) for station in picking]) * _SAFE,
            legs.inbound_s[:number],
            legs.outbound_s[:number],
            np.array([station.order_slots for station in picking], np.int64),
        ),
        # a bundle has a unit at least and must fit into a pod
        Refill(
            np.array([station.bundle_transfer_s for station in refilling]),
            legs.inbound_s[number:],
            legs.outbound_s[number:],
            largest,
            largest,
        ),
        Stock(fits, largest),
    )


def _legs(layout: Layout, times: TravelTimes) -> Legs:
    """Return the least robot time of the drives of a visit, per pick or replenishment station.

    Stations of other kinds are left out: a drive via such a station is never shorter.
    """
    waypoints = [station.waypoint for station in layout.pick_stations]
    waypoints += [station.waypoint for station in layout.replenishment_stations]
    to = np.array([_fastest(layout, times.travel_times_to, one) for one in waypoints])
    away = np.array([_fastest(layout, times.travel_times_from, one) for one in waypoints])
    shape = (len(waypoints), layout.waypoints)
    to, away = to.reshape(shape), away.reshape(shape)
    return visit_legs(
        _finite(to[:, layout.is_storage].min(axis=1, initial=math.inf)),
        _finite(away[:, layout.is_storage].min(axis=1, initial=math.inf)),
        to[:, waypoints].T,
        min((kind.pod_transfer_s for kind in layout.robot_kinds), default=0.0) * _SAFE,
    )


def _fastest(
    layout: Layout, travel_times: Callable[..., NDArray[np.float64]], waypoint: int
) -> NDArray[np.float64]:
    """Return the travel times with a pod of the robot that is fastest on each drive."""
    of_each_kind = np.unique(layout.robot_kind, return_index=True)[1]
    tables = [travel_times(waypoint, True, int(robot)) for robot in of_each_kind]
    fastest: NDArray[np.float64] = np.min(tables, axis=0, initial=math.inf) * _SAFE
    return fastest


def _finite(time_s: NDArray[np.float64]) -> NDArray[np.float64]:
    """Replace infinite times by 0, which keeps the bound valid."""
    return np.where(np.isfinite(time_s), time_s, 0.0)
