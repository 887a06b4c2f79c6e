"""Converts the state of the world to the data of the charging model."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rmfs.layout.charging import Charger, Swap
from rmfs.solvers.models.charging import AWAY, Charging
from rmfs.world.charging import ChargeTask

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.solvers.control.charging.parameters import ScheduleParameters
    from rmfs.world.batteries import Batteries
    from rmfs.world.charging import RecoveryStation


@dataclass(frozen=True)
class Group:
    """A group of identical chargers or swap stations.

    Attributes
    ----------
    stations
        The chargers or swap stations of the group.
    power_w
        Charging power of one charger; 0 for swap stations.
    swapped_share
        Battery level after a swap; 0 for chargers.
    swaps_s
        Mean time per swap at one station in the long run, in s; 0 for chargers.
    """

    stations: tuple[RecoveryStation, ...]
    power_w: float
    swapped_share: float
    swaps_s: float


def groups_of(view: View, batteries: Batteries) -> list[Group]:
    """Group the chargers and swap stations by kind and parameters, in the order of the layout."""
    alike: dict[tuple[float, float, float], list[RecoveryStation]] = {}
    for station in view.recovery_stations:
        kind = view.layout.stations[station.index].kind
        if isinstance(kind, Charger):
            key = (kind.head_w, 0.0, 0.0)
        elif isinstance(kind, Swap):
            given = kind.parameters
            # what a stock can give in the long run, if each swap fills half a battery
            filled_s = batteries.capacity_j / 2 / kind.long_run_w
            ready = min(given.ready_share, batteries.given.full_share)
            key = (0.0, ready, max(given.swap_s, filled_s))
        else:
            continue
        alike.setdefault(key, []).append(station)
    return [Group(tuple(stations), *key) for key, stations in alike.items()]


def slot_s(groups: Sequence[Group], batteries: Batteries, share: float) -> float:
    """Return the length of a time slot, in s.

    This is the time in which the most powerful charger supplies the fraction `share` of a battery's
    capacity. Without chargers, it is the longest mean time per swap (`swaps_s`) of all groups.
    """
    power_w = max((group.power_w for group in groups), default=0.0)
    if power_w > 0:
        return share * batteries.capacity_j / power_w
    return max((group.swaps_s for group in groups), default=1.0)


def snapshot(
    view: View,
    batteries: Batteries,
    groups: Sequence[Group],
    wanted: NDArray[np.int64],
    given: ScheduleParameters,
) -> Charging:
    """Build the charging problem from the state of the world.

    Parameters
    ----------
    view, batteries
        The world, and the batteries of its robots.
    groups
        The groups of stations, in the order of their numbers in the model.
    wanted
        Number of robots needed for work in each case of the forecast, shape (Q,).
    given
        The controller's parameters.
    """
    robots, slots = len(view.robots), given.slots
    length_s = slot_s(groups, batteries, given.slot_share)
    of_station = {s.index: number for number, group in enumerate(groups) for s in group.stations}
    waits, here = np.zeros(robots, bool), np.full(robots, AWAY)
    ready = np.ones(robots, np.int64)
    way_s = _ways_s(view, groups)
    for robot in view.robots:
        task = robot.task
        if robot.is_free and robot.index not in batteries.stranded:
            ready[robot.index] = 0
        if isinstance(task, ChargeTask) and task.station in of_station:
            group = of_station[task.station]
            if view.all_stations[task.station].robot == robot.index and groups[group].power_w:
                here[robot.index] = group
            else:
                waits[robot.index] = True
                way_s[robot.index, np.arange(len(groups)) != group] = np.inf
    power_w = np.array([group.power_w for group in groups])
    swaps_s = np.array([group.swaps_s for group in groups])
    each = np.array([len(group.stations) for group in groups])
    per_slot = np.where(swaps_s > 0, length_s / np.maximum(swaps_s, 1e-9), 1.0)
    places = np.maximum((each * per_slot).astype(np.int64), 1)
    full_s = batteries.capacity_j / (power_w.max() if power_w.any() else np.inf)
    trip_s = float(2 * np.where(np.isfinite(way_s), way_s, 0.0).mean()) if way_s.size else 0.0
    drain_w = batteries.mean_draw_w(view.now_s)
    # a swap ends at once, wherever in the slot; plug-in places fill at their power
    return Charging(
        level=np.maximum(batteries.shares(), 0.0),
        drain=np.full(robots, drain_w * length_s / batteries.capacity_j),
        ready=ready,
        waits=waits,
        here=here,
        way_s=way_s,
        places=np.repeat(places[:, np.newaxis], slots, axis=1),
        gain=power_w * length_s / batteries.capacity_j,
        swapped=np.array([group.swapped_share for group in groups]),
        wanted=np.repeat(wanted[:, np.newaxis], slots, axis=1),
        slot_s=length_s,
        worth_s=given.worth * full_s + trip_s,
        longest=given.longest,
        taper_from=batteries.given.taper_from_share,
        full=batteries.given.full_share,
        least=min(batteries.enough_share + given.margin_share, batteries.given.full_share),
        idle=given.idle,
        curve=given.curve,
    )


def _ways_s(view: View, groups: Sequence[Group]) -> NDArray[np.float64]:
    """Return the time from each robot to the nearest station of each group, shape (R, G)."""
    at = np.array([view.travel.robot_waypoint(robot.index) for robot in view.robots])
    way_s = np.full((len(view.robots), len(groups)), np.inf)
    for number, group in enumerate(groups):
        for station in group.stations:
            to_s = view.travel.to(station.waypoint, loaded=False)[at]
            way_s[:, number] = np.minimum(way_s[:, number], to_s)
    return way_s
