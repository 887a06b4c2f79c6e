"""Overrides on explicit layouts: the few parameters that make sense without a generator.

A layout given waypoint by waypoint has no aisles to lengthen, but its robots and stations can
still be other ones. The keys are those of layout parameters, and mean the same.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.config import apply_overrides, validate
from rmfs.errors import InputError
from rmfs.layout.generator.placement import draw_robots
from rmfs.layout.values import Count, Positive, Strict

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.layout.model import Layout

_STATION_KEYS = ("order_slots", "unit_transfer_s", "unit_pick_s")
_ROBOT_KEYS = (
    *("acceleration_m_s2", "deceleration_m_s2", "top_speed_m_s"),
    *("full_turn_s", "pod_transfer_s"),
)

SEED = 0
"""Robots of an explicit layout are drawn with a fixed seed, as in RAWSim-O."""


class ExplicitOverrides(Strict):
    """What can be overridden on an explicit layout; absent keys leave it as it is."""

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


def override(layout: Layout, overrides: Sequence[tuple[list[str], Any]], source: str) -> Layout:
    """Return a copy of an explicit layout with some values replaced.

    Parameters
    ----------
    overrides
        (path, value) pairs; `robots` counts robots per tier, drawn anew from the road waypoints.
    source
        Name of the file, for messages.

    Raises
    ------
    InputError
        If a key cannot be overridden on an explicit layout, or a value is wrong.
    """
    if not overrides:
        return layout
    given = validate(
        ExplicitOverrides,
        apply_overrides({}, list(overrides)),
        f"{source} (an explicit layout)",
    )
    changed = _stations(_robot_kinds(layout, given), given)
    if given.pod_capacity is not None:
        changed = replace(changed, pod_capacity=np.full(changed.pods, given.pod_capacity))
    if given.robots is not None:
        changed = _robots(changed, given.robots, source)
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


def _robots(layout: Layout, per_tier: int, source: str) -> Layout:
    """Replace the robots: all of the first robot's kind, on the road waypoints of every tier."""
    road = ~layout.is_storage & ~layout.is_queue
    drawn = []
    for tier in range(len(layout.tiers)):
        candidates = np.flatnonzero(road & (layout.tier == tier)).astype(np.int32)
        if per_tier > len(candidates):
            raise InputError(
                f"{source}: robots: tier {tier} has only {len(candidates)} waypoints that are "
                f"neither storage nor queue (given: {per_tier})"
            )
        drawn.append(draw_robots(candidates, per_tier, SEED, tier))
    waypoints = np.concatenate(drawn)
    kind = layout.robot_kind[0] if layout.robots else 0
    return replace(
        layout,
        robot_waypoint=waypoints,
        robot_heading_rad=np.zeros(len(waypoints)),
        robot_kind=np.full(len(waypoints), kind, dtype=np.int16),
    )
