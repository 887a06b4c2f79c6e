"""Bodies too near to each other, each in a layout broken by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from broken_layouts import (
    IMPOSSIBLE,
    assert_found,
    edges,
    moved,
    road,
    small,
    two_tiers,
    with_edges,
)

from rmfs.layout import check


def test_waypoints_too_near():
    layout = small()
    a, b = road(layout)[:2]
    broken = moved(layout, a, layout.x_m[b], layout.y_m[b] + 0.1)
    assert_found(broken, IMPOSSIBLE, f"waypoint {a} ", "0.1 m apart at the nearest")


def test_waypoints_at_one_place():
    layout = small()
    a, b, c = road(layout)[:3]
    broken = moved(layout, a, layout.x_m[c], layout.y_m[c])
    broken = moved(broken, b, layout.x_m[c], layout.y_m[c])
    assert_found(broken, IMPOSSIBLE, f"waypoint {a} ", "0 m apart at the nearest")


def test_pods_wider_than_the_grid():
    layout = replace(small(), pod_radius_m=0.51)
    assert_found(layout, IMPOSSIBLE, "waypoint", "less than the two radii that pass there (1.02 m)")


def test_empty_warehouse_needs_room_for_robots_only():
    layout = replace(
        small(),
        pod_radius_m=0.6,
        pod_waypoint=np.array([], dtype=np.int32),
        pod_capacity=np.array([]),
    )
    assert check(layout) == []


def test_crossing_edges():
    layout = small()
    a = int(road(layout)[0])
    at = {(x, y): v for v, (x, y) in enumerate(zip(layout.x_m, layout.y_m, strict=True))}
    x, y = layout.x_m[a], layout.y_m[a]
    corner, below = at[x + 1, y + 1], at[x, y + 1]
    broken = with_edges(layout, [*edges(layout), (a, corner), (below, at[x + 1, y])])
    assert_found(broken, IMPOSSIBLE, f"edges {a}-{corner} and", "0 m apart at the nearest")


def test_edge_past_a_waypoint():
    layout = small()
    a = int(road(layout)[0])
    at = {(x, y): v for v, (x, y) in enumerate(zip(layout.x_m, layout.y_m, strict=True))}
    x, y = layout.x_m[a], layout.y_m[a]
    far = at[x + 2, y]
    broken = with_edges(layout, [*edges(layout), (a, far)])
    assert_found(broken, IMPOSSIBLE, f"waypoint {at[x + 1, y]} ", "0 m apart at the nearest")


def test_one_long_edge_is_compared_with_all_others():
    layout = small()
    first, last = 0, layout.waypoints - 1
    broken = with_edges(layout, [*edges(layout), (first, last)])
    assert_found(broken, IMPOSSIBLE, f"edge {first}-{last}", "apart at the nearest")


def test_tiers_do_not_touch_each_other():
    layout = two_tiers()
    assert not [v for v in check(layout) if "apart" in v.message]
