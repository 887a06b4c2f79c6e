"""Bodies too near to each other, each in a layout broken by hand."""

from __future__ import annotations

from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest
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

from rmfs import instances
from rmfs.layout import check, load


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
    assert_found(
        layout,
        IMPOSSIBLE,
        "waypoint",
        "less than the sum of the two radii that pass there (1.02 m)",
    )


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


separation = import_module("rmfs.layout.checks.separation")


def never(*_given):
    raise AssertionError("edges of a wide grid need not be compared")


@pytest.mark.parametrize("name", instances.names("layouts"))
def test_on_a_wide_grid_nothing_is_compared(name, monkeypatch):
    """A grid of a million cells is checked in seconds; the result is that of comparing all."""
    layout = load(name)
    with monkeypatch.context() as patched:
        patched.setattr(separation, "_is_wide_grid", lambda *_given: False)
        assert check(layout) == []
    monkeypatch.setattr(separation, "_close_edges", never)
    monkeypatch.setattr(separation, "_beside_edges", never)
    assert check(layout) == []


@pytest.mark.parametrize("off", ["waypoint", "narrow", "edge"])
def test_anything_off_the_grid_is_compared(off, monkeypatch):
    layout = small()
    if off == "waypoint":
        a = road(layout)[0]
        layout = moved(layout, a, layout.x_m[a] + 1e-3, layout.y_m[a])
    elif off == "narrow":
        layout = replace(layout, pod_radius_m=0.5)
    else:
        a, _, c = road(layout)[:3]
        layout = with_edges(layout, [*edges(layout), (a, c), (c, a)])
    monkeypatch.setattr(separation, "_close_edges", never)
    monkeypatch.setattr(separation, "_beside_edges", never)
    with pytest.raises(AssertionError, match="need not be compared"):
        list(separation.separation(layout))
