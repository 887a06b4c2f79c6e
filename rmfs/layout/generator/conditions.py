"""Conditions that concern several layout parameters together.

`RULES` lists each condition with the keys that it reads. A condition is skipped if the value of one
of these keys is already known to be wrong. Otherwise, it returns a list of errors, each beginning
with the key to change.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from rmfs.layout.generator.compass import SIDES, Direction
from rmfs.layout.generator.extent import (
    aisles_at,
    blocks,
    extent,
    lanes,
    road_tiles,
    sites_at,
    storage_places,
)
from rmfs.layout.generator.sites import sites

if TYPE_CHECKING:
    from collections.abc import Callable

    from rmfs.layout.parameters import LayoutParameters

    Rule = Callable[[LayoutParameters], list[str]]

STATIONS = ("pick_stations", "replenishment_stations", "other_stations", "elevators")
AISLES = ("horizontal_aisles", "vertical_aisles")
SIZE = (*AISLES, *STATIONS, "block_length", "single_lane", "hall_width", "buffer_width")

MOST_TILES = 4_000_000
"""Maximum number of tiles, set by memory; the largest published layout has 12,000."""


def _even_aisles(p: LayoutParameters) -> list[str]:
    if not p.two_directional_aisles:
        why = "one-way aisles need"
    elif p.hall_pattern == "highway" and p.single_lane:
        # the one-way rows and columns of the halls alternate all around the tier
        why = '"highway" halls around single-lane aisles need'
    else:
        return []
    return [
        f"{key}: {why} an even number (given: {getattr(p, key)})"
        for key in AISLES
        if getattr(p, key) % 2
    ]


def _even_highway(p: LayoutParameters) -> list[str]:
    if p.hall_pattern == "highway" and p.hall_width % 2:
        return [f'hall_width: the "highway" pattern needs an even number (given: {p.hall_width})']
    return []


def _entrance(p: LayoutParameters) -> list[str]:
    given, most = p.entry_exit_distance, 4 + lanes(p)
    if given % 2 == 0 or given > most:
        return [f"entry_exit_distance: must be odd and at most {most} (given: {given})"]
    return []


def _some_stations(p: LayoutParameters) -> list[str]:
    return [
        f"{key}: at least one is needed, for example {key}.{side}=1"
        for key, side in (("pick_stations", "east"), ("replenishment_stations", "west"))
        if getattr(p, key).total == 0
    ]


def _elevators(p: LayoutParameters) -> list[str]:
    if p.tiers > 1 and p.elevators.total == 0:
        return [f"elevators: {p.tiers} tiers need at least one, for example elevators.north=1"]
    if p.tiers == 1 and p.elevators.total:
        return [f"elevators: must be 0 with one tier (given: {p.elevators.total})"]
    return []


def _size(p: LayoutParameters) -> list[str]:
    size = extent(p)
    tiles = size.rows * size.columns * p.tiers
    if tiles > MOST_TILES:
        return [
            f"tiers, aisles, block_length: give {tiles} tiles; at most {MOST_TILES} are allowed"
        ]
    return []


def _room_at_sides(p: LayoutParameters) -> list[str]:
    return [
        f"{' + '.join(STATIONS)}: the {side.name.lower()} side has room for "
        f"{aisles_at(p, side) // 2}, half the number of its aisles (given: {sites_at(p, side)})"
        for side in SIDES
        if sites_at(p, side) > aisles_at(p, side) // 2
    ]


def _queues_fit(p: LayoutParameters) -> list[str]:
    size = extent(p)
    problems = []
    for side in SIDES:
        length = size.height if side in (Direction.EAST, Direction.WEST) else size.width
        crowded = sites_at(p, side) > aisles_at(p, side) // 2  # reported by _room_at_sides
        chosen = [] if crowded else sites(p, side)
        if any(not 0 <= site.entrance < length for site in chosen):
            problems.append(
                f"entry_exit_distance: a queue on the {side.name.lower()} side would start outside "
                f"the tier (given: {p.entry_exit_distance})"
            )
    return problems


def _robots(p: LayoutParameters) -> list[str]:
    problems = []
    if p.robots > road_tiles(p):
        problems.append(f"robots: a tier has only {road_tiles(p)} road tiles (given: {p.robots})")
    if p.robots > storage_places(p):
        problems.append(
            f"robots: a tier has only {storage_places(p)} storage locations to rest at "
            f"(given: {p.robots})"
        )
    return problems


def _within(p: LayoutParameters) -> list[str]:
    wanted = sum(group.within for group in p.other_stations.values())
    if wanted > blocks(p):
        return [
            f"other_stations: the storage area has room for {blocks(p)} stations (`within`), one "
            f"per block (given: {wanted})"
        ]
    return []


def _pods(p: LayoutParameters) -> list[str]:
    if math.floor(p.pod_share * storage_places(p)) == 0:
        return [
            f"pod_share: gives no pod with {storage_places(p)} storage locations per tier "
            f"(given: {p.pod_share})"
        ]
    return []


RULES: tuple[tuple[tuple[str, ...], Rule], ...] = (
    ((*AISLES, "two_directional_aisles", "hall_pattern", "single_lane"), _even_aisles),
    (("hall_pattern", "hall_width"), _even_highway),
    (("entry_exit_distance", "single_lane"), _entrance),
    (STATIONS, _some_stations),
    (("tiers", "elevators"), _elevators),
    ((*SIZE, "tiers"), _size),
    ((*AISLES, *STATIONS), _room_at_sides),
    (
        (*SIZE, "entry_exit_distance", "counter_clockwise_ring", "two_directional_aisles"),
        _queues_fit,
    ),
    ((*SIZE, "hall_pattern", "robots"), _robots),
    ((*AISLES, "other_stations"), _within),
    ((*AISLES, "block_length", "pod_share"), _pods),
)
