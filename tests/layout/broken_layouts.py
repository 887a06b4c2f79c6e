"""Layouts broken by hand, and what is found in them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from rmfs.layout import LayoutParameters, check, generate
from rmfs.layout.graph import compressed, edge_sources

IMPOSSIBLE, NOT_WELL_FORMED = "impossible", "not well-formed"


def small(**more):
    return generate(
        LayoutParameters(
            **{
                "horizontal_aisles": 2,
                "vertical_aisles": 2,
                "block_length": 2,
                "hall_width": 2,
                "buffer_width": 2,
                "robots": 4,
                "pick_stations": {"east": 1},
                "replenishment_stations": {"west": 1},
                **more,
            }
        )
    )


def two_tiers():
    return small(tiers=2, elevators={"north": 1})


def edges(layout):
    return list(zip(edge_sources(layout).tolist(), layout.edge_target.tolist(), strict=True))


def with_edges(layout, changed):
    start, target = compressed(layout.waypoints, changed)
    return replace(layout, edge_start=start, edge_target=target)


def without(layout, unwanted):
    """Remove the edges (tail, head) for which `unwanted` is true."""
    return with_edges(layout, [edge for edge in edges(layout) if not unwanted(*edge)])


def moved(layout, waypoint, x_m, y_m):
    x, y = layout.x_m.copy(), layout.y_m.copy()
    x[waypoint], y[waypoint] = x_m, y_m
    return replace(layout, x_m=x, y_m=y)


def placed(values, index, value):
    copy = values.copy()
    copy[index] = value
    return copy


def marked(mask, *waypoints):
    copy = mask.copy()
    copy[list(waypoints)] = True
    return copy


def pick(layout, **changes):
    """Change the first pick station."""
    first, *others = layout.pick_stations
    return replace(layout, pick_stations=(replace(first, **changes), *others))


def road(layout):
    return np.flatnonzero(~layout.is_storage & ~layout.is_queue)


def places(layout):
    return np.flatnonzero(layout.is_storage)


def assert_found(layout, severity, element, message):
    found = [
        v
        for v in check(layout)
        if v.severity == severity and element in v.element and message in v.message
    ]
    assert found, [str(v) for v in check(layout)]


def inner_place(layout):
    """Return a storage location and the storage locations and road waypoints next to it."""
    place = int(places(layout)[0])
    around = {b for a, b in edges(layout) if a == place}
    return place, {v for v in around if layout.is_storage[v]}, around
