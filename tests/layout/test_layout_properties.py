"""Properties of all generated layouts, on small random parameters."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from rmfs.layout import LayoutParameters, check, generate
from rmfs.layout.generator.compass import SIDES
from rmfs.layout.generator.extent import aisles_at
from rmfs.layout.generator.sites import sites

SIDE_NAMES = ("west", "east", "south", "north")
GROUPS = ("pick_stations", "replenishment_stations", "elevators")


@st.composite
def parameters(draw):
    two_directional = draw(st.booleans())
    pattern = draw(st.sampled_from(["tim", "highway"]))
    odd = two_directional and pattern == "tim"
    aisles = st.integers(2, 6) if odd else st.sampled_from([2, 4, 6])
    across, along = draw(aisles), draw(aisles)
    room = dict.fromkeys(("west", "east"), across // 2) | dict.fromkeys(
        ("south", "north"), along // 2
    )
    tiers = draw(st.integers(1, 3))
    return LayoutParameters(
        tiers=tiers,
        robots=3,
        two_directional_aisles=two_directional,
        single_lane=draw(st.booleans()),
        counter_clockwise_ring=draw(st.booleans()),
        hall_pattern=pattern,
        horizontal_aisles=across,
        vertical_aisles=along,
        block_length=draw(st.sampled_from([2, 4])),
        hall_width=draw(st.integers(2, 6) if pattern == "tim" else st.sampled_from([2, 4])),
        buffer_width=draw(st.integers(2, 4)),
        entry_exit_distance=draw(st.sampled_from([1, 3] if two_directional else [1, 3, 5])),
        **draw(stations(room, GROUPS if tiers > 1 else GROUPS[:2])),
    )


@st.composite
def stations(draw, room, groups):
    """At least one of each group, and no more on a side than there is room for."""
    counts = {group: dict.fromkeys(SIDE_NAMES, 0) for group in GROUPS}
    free = dict(room)
    for group, side in zip(groups, draw(st.permutations(SIDE_NAMES)), strict=False):
        counts[group][side] += 1
        free[side] -= 1
    for group in groups:
        for side in SIDE_NAMES:
            more = draw(st.integers(0, min(1, free[side])))
            counts[group][side] += more
            free[side] -= more
    return counts


@settings(max_examples=80, deadline=None)
@given(parameters())
def test_generated_layouts_pass_the_check(p):
    assert check(generate(p)) == []


@settings(max_examples=40, deadline=None)
@given(parameters())
def test_generated_layouts_are_sound_arrays(p):
    layout = generate(p)
    assert layout.edge_start[0] == 0
    assert layout.edge_start[-1] == len(layout.edge_target)
    for v in range(layout.waypoints):
        heads = layout.edge_target[layout.edge_start[v] : layout.edge_start[v + 1]]
        assert (np.diff(heads) > 0).all()
        assert (layout.tier[heads] == layout.tier[v]).all()
    assert not (layout.is_storage & layout.is_queue).any()
    length = p.entry_exit_distance * p.buffer_width + 1
    for station in layout.stations:
        assert len(station.queue) == length
        assert station.queue[0] == station.waypoint
        assert layout.is_queue[list(station.queue)].all()
    for stations, per_tier in (
        (layout.pick_stations, p.pick_stations),
        (layout.replenishment_stations, p.replenishment_stations),
    ):
        assert len(stations) == per_tier.total * p.tiers
        assert sorted(s.activation for s in stations) == list(range(1, len(stations) + 1))
    assert len(layout.elevators) == p.elevators.total


@settings(max_examples=40, deadline=None)
@given(parameters())
def test_stations_take_the_middle_places_of_a_side(p):
    for side in SIDES:
        found = sites(p, side)
        positions = [site.exit for site in found]
        assert positions == sorted(set(positions))
        assert len(found) <= aisles_at(p, side) // 2
        kinds = [site.kind for site in found]
        order = {"pick": 0, "replenishment": 1, "elevator": 2}
        assert kinds == sorted(kinds, key=order.__getitem__)
