"""Stations within the storage area: spread, reached by all, and in nobody's way."""

from __future__ import annotations

import numpy as np
import pytest

from rmfs.errors import InputError
from rmfs.layout import check, load

TWO_LANES = [(["single_lane"], False)]
HIGHWAY = [(["hall_pattern"], "highway")]


def with_chargers(within, name="default", more=()):
    table = {"kind": "charger", "within": within}
    return load(name, [*more, (["other_stations", "charger"], table)])


@pytest.mark.parametrize(
    ("within", "more"),
    [(1, ()), (7, ()), (63, ()), (9, TWO_LANES), (4, [(["hall_pattern"], "highway")])],
)
def test_pockets_are_well_formed(within, more):
    layout = with_chargers(within, more=more)
    assert [str(violation) for violation in check(layout)] == []
    assert len(layout.other_stations) == within
    waypoints = np.array([station.waypoint for station in layout.other_stations])
    assert len(np.unique(waypoints)) == within
    assert not layout.is_storage[waypoints].any()
    for waypoint in waypoints:
        ways = layout.edge_target[layout.edge_start[waypoint] : layout.edge_start[waypoint + 1]]
        assert len(ways) == 1  # out to the aisle, and nowhere else
        assert not layout.is_storage[ways[0]]


def test_each_takes_the_place_of_a_storage_place():
    assert load("default").is_storage.sum() - with_chargers(5).is_storage.sum() == 5


def test_they_are_spread_over_the_area():
    layout = with_chargers(9)
    waypoints = [station.waypoint for station in layout.other_stations]
    assert np.ptp(layout.x_m[waypoints]) > 0.4 * np.ptp(layout.x_m[layout.is_storage])
    assert np.ptp(layout.y_m[waypoints]) > 0.6 * np.ptp(layout.y_m[layout.is_storage])


def test_tiers_have_their_own():
    layout = with_chargers(3, "study-tiers")
    tiers = [int(layout.tier[station.waypoint]) for station in layout.other_stations]
    assert tiers == sorted(tiers)
    assert all(tiers.count(tier) == 3 for tier in range(len(layout.tiers)))
    assert check(layout) == []


def test_more_than_there_are_blocks_are_refused():
    with pytest.raises(InputError, match=r"room for 63 stations .*, one per block"):
        with_chargers(64)
