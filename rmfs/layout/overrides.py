"""Overrides for explicit layouts, which are not generated from parameters.

The aisles of an explicit layout cannot be lengthened, but its robots and stations can be changed.
Most keys are also layout parameters and have the same meaning. The others are `FACTORS`: the shares
of pick and replenishment stations that are kept, and the number of robots per pick station. They
are intended as factors of experiments. They can also be used for generated layouts, layouts drawn
as text, and grid maps with stations.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import numpy as np
import pydantic

from rmfs.config import apply_overrides, validate
from rmfs.errors import InputError
from rmfs.layout.generator.placement import draw_robots
from rmfs.layout.model import PickStation, ReplenishmentStation
from rmfs.layout.values import Count, Positive, Strict

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.layout.model import Layout

_STATION_KEYS = ("order_slots", "unit_transfer_s", "unit_pick_s")
_ROBOT_KEYS = (
    *("acceleration_m_s2", "deceleration_m_s2", "top_speed_m_s"),
    *("full_turn_s", "pod_transfer_s"),
)

Share = Annotated[float, pydantic.Field(gt=0, le=1)]

SEED = 0
"""Seed with which the initial positions of an explicit layout's robots are drawn; fixed, as in
RAWSim-O."""


class ExplicitOverrides(Strict):
    """The values that can be overridden in an explicit layout; None leaves a value unchanged."""

    robots: Count | None = None
    order_slots: Count | None = None
    unit_transfer_s: Positive | None = None
    unit_pick_s: Positive | None = None
    bundle_transfer_s: Positive | None = None
    replenishment_station_capacity: Positive | None = None
    pod_capacity: Positive | None = None
    acceleration_m_s2: Positive | None = None
    deceleration_m_s2: Positive | None = None
    top_speed_m_s: Positive | None = None
    full_turn_s: Positive | None = None
    pod_transfer_s: Positive | None = None
    pick_station_share: Share | None = None
    replenishment_station_share: Share | None = None
    robots_per_pick_station: Count | None = None


FACTORS = ("pick_station_share", "replenishment_station_share", "robots_per_pick_station")
"""Keys that are also valid for generated and drawn layouts, to which they are applied last."""


def override(layout: Layout, overrides: Sequence[tuple[list[str], Any]], source: str) -> Layout:
    """Return a copy of an explicit layout with some values replaced.

    Parameters
    ----------
    overrides
        Pairs of a key, as a list of its parts, and its new value, such as `(["robots"], 16)`.
        `robots` is the number of robots per tier. If `robots` or `robots_per_pick_station` is
        given, the robots are replaced by robots of the first robot's kind, at random waypoints that
        are neither storage locations nor in queue zones. If only a share of the stations of a kind
        is kept, the stations that are activated first remain; their number is rounded down, but is
        at least one.
    source
        Name of the file, for error messages.

    Raises
    ------
    InputError
        If a key cannot be overridden in an explicit layout, or a value is invalid.
    """
    if not overrides:
        return layout
    given = validate(
        ExplicitOverrides,
        apply_overrides({}, list(overrides)),
        f"{source} (an explicit layout)",
    )
    changed = _stations(_robot_kinds(layout, given), given)
    changed = _fewer_stations(changed, given)
    if given.pod_capacity is not None:
        changed = replace(changed, pod_capacity=np.full(changed.pods, given.pod_capacity))
    if given.robots is not None:
        changed = _robots(changed, [given.robots] * len(changed.tiers), source)
    if given.robots_per_pick_station is not None:
        total = given.robots_per_pick_station * len(changed.pick_stations)
        tiers = len(changed.tiers)
        changed = _robots(changed, [(total + k) // tiers for k in range(tiers)], source)
    return changed


def _given(overrides: ExplicitOverrides, keys: Sequence[str]) -> dict[str, Any]:
    values = {key: getattr(overrides, key) for key in keys}
    return {key: value for key, value in values.items() if value is not None}


def _stations(layout: Layout, overrides: ExplicitOverrides) -> Layout:
    pick = _given(overrides, _STATION_KEYS)
    replenishment = _given(overrides, ("bundle_transfer_s",))
    if overrides.replenishment_station_capacity is not None:
        replenishment["capacity"] = overrides.replenishment_station_capacity
    return replace(
        layout,
        pick_stations=tuple(replace(station, **pick) for station in layout.pick_stations),
        replenishment_stations=tuple(
            replace(station, **replenishment) for station in layout.replenishment_stations
        ),
    )


def _robot_kinds(layout: Layout, overrides: ExplicitOverrides) -> Layout:
    values = _given(overrides, _ROBOT_KEYS)
    return replace(
        layout, robot_kinds=tuple(replace(kind, **values) for kind in layout.robot_kinds)
    )


def _fewer_stations(layout: Layout, overrides: ExplicitOverrides) -> Layout:
    """Remove stations; the waypoints of their queues become road waypoints."""
    picks = _first(layout.pick_stations, overrides.pick_station_share)
    others = _first(layout.replenishment_stations, overrides.replenishment_station_share)
    fewer = replace(layout, pick_stations=picks, replenishment_stations=others)
    kept = {place for station in fewer.stations for place in station.queue}
    dropped = {place for station in layout.stations for place in station.queue} - kept
    is_queue = layout.is_queue.copy()
    is_queue[sorted(dropped)] = False
    return replace(fewer, is_queue=is_queue)


S = TypeVar("S", PickStation, ReplenishmentStation)


def _first(stations: tuple[S, ...], share: float | None) -> tuple[S, ...]:
    """Return the given share of the stations, those activated first, in the original order."""
    if share is None or not stations:
        return stations
    # a share such as 0.7 is slightly less than seven tenths in binary
    number = max(1, int(share * len(stations) + 1e-9))
    ranks = sorted(range(len(stations)), key=lambda one: (stations[one].activation, one))
    return tuple(stations[one] for one in sorted(ranks[:number]))


def _robots(layout: Layout, per_tier: Sequence[int], source: str) -> Layout:
    """Replace the robots by robots of the first one's kind, at road waypoints of every tier."""
    road = ~layout.is_storage & ~layout.is_queue
    drawn = []
    for tier, number in enumerate(per_tier):
        candidates = np.flatnonzero(road & (layout.tier == tier)).astype(np.int32)
        if number > len(candidates):
            raise InputError(
                f"{source}: robots: tier {tier} has only {len(candidates)} waypoints that are "
                f"neither storage nor queue (given: {number})"
            )
        drawn.append(draw_robots(candidates, number, SEED, tier))
    waypoints = np.concatenate(drawn)
    kind = layout.robot_kind[0] if layout.robots else 0
    return replace(
        layout,
        robot_waypoint=waypoints,
        robot_heading_rad=np.zeros(len(waypoints)),
        robot_kind=np.full(len(waypoints), kind, dtype=np.int16),
    )
