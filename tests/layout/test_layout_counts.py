"""Counts of generated layouts against the reference's tables (its section 7)."""

from __future__ import annotations

import numpy as np
import pytest

from rmfs.layout import LayoutParameters, generate, load
from rmfs.layout.generator.extent import road_tiles, storage_places


def one_sided(horizontal, vertical, stations, **more):
    return LayoutParameters(
        horizontal_aisles=horizontal,
        vertical_aisles=vertical,
        pick_stations={"east": stations},
        replenishment_stations={"west": stations},
        robots=4,
        **more,
    )


# storage, pods, waypoints, edges, length, width, queue places
TABLE = {
    "MaTiPico": (one_sided(2, 2, 1), (72, 61, 312, 686, 36, 10, 13)),
    "MaTiNano": (one_sided(4, 4, 2), (200, 170, 672, 1668, 46, 16, 13)),
    "MaTiMicro": (one_sided(6, 6, 3), (392, 333, 1152, 3066, 56, 22, 13)),
    "MaTiMilli": (one_sided(8, 8, 4), (648, 550, 1752, 4880, 66, 28, 13)),
    "MaTiCenti": (one_sided(10, 10, 5), (968, 822, 2472, 7110, 76, 34, 13)),
    "MaTiDeca": (one_sided(12, 12, 6), (1352, 1149, 3312, 9756, 86, 40, 13)),
    "MaTiHecto": (one_sided(14, 14, 7), (1800, 1530, 4272, 12818, 96, 46, 13)),
    "MaTiKilo": (one_sided(16, 16, 8), (2312, 1965, 5352, 16296, 106, 52, 13)),
    "MaTiMega": (one_sided(18, 18, 9), (2888, 2454, 6552, 20190, 116, 58, 13)),
    "MaTiGiga": (one_sided(20, 20, 10), (3528, 2998, 7872, 24500, 126, 64, 13)),
    "MaTiTiny": (one_sided(8, 6, 4), (504, 428, 1472, 3934, 56, 28, 13)),
    "MaTiMedium": (one_sided(12, 14, 6), (1560, 1326, 3712, 11118, 96, 40, 13)),
    "MaTiLarge": (one_sided(14, 18, 7), (2280, 1938, 5192, 15958, 116, 46, 13)),
    "MaTiHuge": (one_sided(16, 22, 8), (3128, 2658, 6912, 21630, 136, 52, 13)),
    "1-4-4-32-550": (one_sided(8, 8, 4, hall_width=4), (648, 550, 1640, 4768, 62, 28, 13)),
    "1-8-8-64-1040": (one_sided(16, 8, 8, hall_width=4), (1224, 1040, 3064, 8976, 62, 52, 13)),
    "1-8-8-96-1502": (one_sided(16, 12, 8, hall_width=4), (1768, 1502, 4104, 12532, 82, 52, 13)),
    "jenkinsinstance2": (one_sided(4, 4, 1), (200, 170, 640, 1630, 46, 16, 13)),
    "1-1-3-48-795": (
        LayoutParameters(
            horizontal_aisles=8,
            vertical_aisles=12,
            entry_exit_distance=5,
            pick_stations={"east": 3},
            replenishment_stations={"east": 1},
        ),
        (936, 795, 2112, 6514, 76, 28, 21),
    ),
    "1-4-16-144-1951": (
        LayoutParameters(
            horizontal_aisles=40,
            vertical_aisles=6,
            pick_stations={"east": 16},
            replenishment_stations={"east": 4},
        ),
        (2296, 1951, 5528, 16452, 46, 124, 13),
    ),
    "1-12-20-128-1965": (
        LayoutParameters(
            horizontal_aisles=16,
            vertical_aisles=16,
            hall_width=4,
            pick_stations={"east": 8, "north": 6, "south": 6},
            replenishment_stations={"west": 8, "north": 2, "south": 2},
        ),
        (2312, 1965, 6088, 17420, 102, 68, 13),
    ),
    "2-8-8-64-1100": (
        one_sided(8, 8, 4, hall_width=4, tiers=2, elevators={"north": 2, "south": 2}),
        (1296, 1100, 4144, 10792, 62, 44, 13),
    ),
    "3-12-12-96-1650": (
        one_sided(8, 8, 4, hall_width=4, tiers=3, elevators={"north": 2, "south": 2}),
        (1944, 1650, 6216, 16200, 62, 44, 13),
    ),
}

# storage, pods, waypoints, length, width
REPOSITIONING = {
    "RepoSmall": ((8, 10, 4), (792, 673, 1744, 64, 28)),
    "RepoLong": ((8, 22, 4), (1656, 1407, 3424, 124, 28)),
    "RepoWide": ((16, 10, 8), (1496, 1271, 3248, 64, 52)),
    "RepoLarge": ((16, 22, 8), (3128, 2658, 6368, 124, 52)),
}


@pytest.mark.parametrize("name", TABLE)
def test_counts_of_published_layouts(name):
    parameters, expected = TABLE[name]
    layout = generate(parameters)
    rides = sum(len(elevator.travel_s) for elevator in layout.elevators)
    assert (
        int(layout.is_storage.sum()),
        layout.pods,
        layout.waypoints,
        len(layout.edge_target) + rides,
        layout.tiers[0].length_m,
        layout.tiers[0].width_m,
        len(layout.pick_stations[0].queue),
    ) == expected


@pytest.mark.parametrize("name", REPOSITIONING)
def test_counts_of_highway_layouts(name):
    (horizontal, vertical, stations), expected = REPOSITIONING[name]
    layout = generate(
        one_sided(
            horizontal, vertical, stations, hall_pattern="highway", hall_width=2, buffer_width=2
        )
    )
    assert (
        int(layout.is_storage.sum()),
        layout.pods,
        layout.waypoints,
        layout.tiers[0].length_m,
        layout.tiers[0].width_m,
    ) == expected


def test_default_layout():
    layout = load("default-32")
    assert (layout.waypoints, len(layout.edge_target), layout.pods) == (1472, 3934, 428)
    assert (layout.robots, int(layout.is_storage.sum())) == (32, 504)
    assert [len(station.queue) for station in layout.stations] == [13] * 8
    assert [station.activation for station in layout.pick_stations] == [4, 2, 1, 3]
    assert layout.robot_heading_rad.tolist() == [0.0] * 32
    robot = layout.robot_kinds[0]
    assert (robot.acceleration_m_s2, robot.deceleration_m_s2, robot.pod_transfer_s) == (1, 1, 2.2)


def test_waypoints_of_a_tier_have_half_metre_positions_inside_it():
    layout = load("default")
    assert set(layout.x_m % 1) == {0.5}
    assert layout.x_m.min() == 0.5
    assert layout.x_m.max() == layout.tiers[0].length_m - 0.5


def test_elevator_time_is_tier_difference_times_seconds_per_tier():
    layout = generate(TABLE["3-12-12-96-1650"][0])
    for elevator in layout.elevators:
        assert len(elevator.travel_s) == 6  # each ordered pair of three tiers once
        for (a, b), seconds in elevator.travel_s.items():
            assert seconds == 10 * abs(int(layout.tier[a]) - int(layout.tier[b]))


def test_pods_and_robots_stand_where_they_may_and_follow_the_seed():
    first, again = load("default"), load("default")
    other = load("default", [(["seed"], 1)])
    fewer = load("default", [(["robots"], 16)])
    road = ~first.is_storage & ~first.is_queue
    assert first.is_storage[first.pod_waypoint].all()
    assert road[first.robot_waypoint].all()
    assert len(np.unique(first.pod_waypoint)) == first.pods
    assert len(np.unique(first.robot_waypoint)) == first.robots
    assert first.pod_waypoint.tolist() == again.pod_waypoint.tolist()
    assert first.pod_waypoint.tolist() != other.pod_waypoint.tolist()
    assert fewer.robot_waypoint.tolist() == first.robot_waypoint[:16].tolist()
    assert fewer.pod_waypoint.tolist() == first.pod_waypoint.tolist()


def test_tiers_draw_their_own_places():
    layout = generate(TABLE["2-8-8-64-1100"][0])
    first = layout.pod_waypoint[: layout.pods // 2]
    second = layout.pod_waypoint[layout.pods // 2 :] - layout.waypoints // 2
    assert sorted(first) != sorted(second)


@pytest.mark.parametrize("name", TABLE)
def test_road_and_storage_counts_are_known_before_generating(name):
    parameters, _ = TABLE[name]
    layout = generate(parameters)
    road = ~layout.is_storage & ~layout.is_queue
    assert int(road.sum()) == road_tiles(parameters) * parameters.tiers
    assert int(layout.is_storage.sum()) == storage_places(parameters) * parameters.tiers
