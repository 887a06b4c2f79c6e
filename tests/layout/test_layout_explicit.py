"""Explicit layouts: round trip, errors, overrides."""

from __future__ import annotations

import json
from dataclasses import fields

import numpy as np
import pytest
from layout_reference import INSTANCES, needs_reference

from rmfs.errors import InputError
from rmfs.layout import LayoutParameters, generate, load, save_json


def assert_equal(a, b):
    for field in fields(a):
        left, right = getattr(a, field.name), getattr(b, field.name)
        if isinstance(left, np.ndarray):
            assert left.dtype == right.dtype, field.name
            np.testing.assert_array_equal(left, right, err_msg=field.name)
        else:
            assert left == right, field.name


def layouts():
    yield generate(LayoutParameters())
    yield generate(
        LayoutParameters(
            tiers=3,
            elevators={"north": 1, "west": 1},
            pick_stations={"east": 2},
            replenishment_stations={"west": 2},
            robots=5,
        )
    )


@pytest.mark.parametrize("layout", list(layouts()), ids=["default", "three tiers"])
def test_round_trip(layout, tmp_path):
    path = tmp_path / "layout.json"
    save_json(layout, path)
    assert_equal(load(path), layout)
    assert [file.name for file in tmp_path.iterdir()] == ["layout.json"]


@needs_reference
@pytest.mark.parametrize("name", ["pp/3-12-12-96-1650", "demonstrator/fair-2016-4bot"])
def test_round_trip_of_imported_layouts(name, tmp_path):
    layout = load(INSTANCES / f"{name}.xinst")
    save_json(layout, tmp_path / "layout.json")
    assert_equal(load(tmp_path / "layout.json"), layout)


def small_table():
    """Four waypoints in a ring with one place, one station of each kind, a pod and a robot."""
    station = {"radius_m": 0.4, "activation": 1}
    return {
        "format": "rmfs-layout-explicit/1",
        "name": "ring",
        "tiers": [{"length_m": 2.0, "width_m": 2.0}],
        "pod_radius_m": 0.4,
        "robot_kinds": [
            {
                "radius_m": 0.3,
                "acceleration_m_s2": 1.0,
                "deceleration_m_s2": 1,
                "top_speed_m_s": 1.5,
                "full_turn_s": 2.5,
                "pod_transfer_s": 2.2,
            }
        ],
        "pick_stations": [
            {"queue": [1], "order_slots": 2, "unit_transfer_s": 9, "unit_pick_s": 3, **station}
        ],
        "replenishment_stations": [
            {"queue": [2], "capacity": 100, "bundle_transfer_s": 9, **station}
        ],
        "robots": [{"waypoint": 3}],
        "pods": [{"waypoint": 0, "capacity": 100}],
        "waypoints": [
            {"x_m": 0.5, "y_m": 0.5, "to": [1], "storage": True},
            {"x_m": 1.5, "y_m": 0.5, "to": [2]},
            {"x_m": 1.5, "y_m": 1.5, "to": [3]},
            {"x_m": 0.5, "y_m": 1.5, "to": [0]},
        ],
    }


def written(table, tmp_path):
    path = tmp_path / "layout.json"
    path.write_text(json.dumps(table))
    return path


def test_hand_written_layout(tmp_path):
    layout = load(written(small_table(), tmp_path))
    assert (layout.waypoints, layout.pods, layout.robots) == (4, 1, 1)
    assert layout.pick_stations[0].waypoint == 1
    assert layout.is_queue.tolist() == [False, True, True, False]
    assert layout.robot_heading_rad.tolist() == [0.0]


def at(*path):
    """Return a function that sets the value at a path of the table."""

    def change(table, value):
        node = table
        for key in path[:-1]:
            node = node[key]
        node[path[-1]] = value

    return change


@pytest.mark.parametrize(
    ("path", "value", "expected"),
    [
        (("format",), "rmfs-layout/1", "format: Input should be 'rmfs-layout-explicit/1'"),
        (("waypoints", 0, "to"), [9], "waypoints.0.to: there is no waypoint 9 (last: 3)"),
        (("waypoints", 0, "to"), [0], "waypoints.0.to: must not contain the waypoint itself"),
        (("waypoints", 0, "to"), [-1], "waypoints.0.to.0: "),
        (("waypoints", 0, "tier"), 1, "waypoints.0.tier: there is no tier 1"),
        (("waypoints", 0, "x_m"), "left", "waypoints.0.x_m: "),
        (("waypoints", 0, "strage"), True, "unknown key waypoints.0.strage; did you mean storage?"),
        (("pods", 0, "waypoint"), 4, "pods.0.waypoint: there is no waypoint 4"),
        (("robots", 0, "waypoint"), 4, "robots.0.waypoint: there is no waypoint 4"),
        (("robots", 0, "kind"), 1, "robots.0.kind: there is no robot kind 1"),
        (("pick_stations", 0, "queue"), [7], "pick_stations.0.queue: there is no waypoint 7"),
        (("pick_stations", 0, "queue"), [], "pick_stations.0.queue: "),
        (("replenishment_stations", 0, "capacity"), 0, "replenishment_stations.0.capacity: "),
        (("robot_kinds", 0, "top_speed_m_s"), -1, "robot_kinds.0.top_speed_m_s: "),
        (
            ("elevators",),
            [{"queues": [[0], [1]], "rides": [{"origin": 0, "destination": 2, "travel_s": 1}]}],
            "elevators.0.rides.0.destination: 2 is not the first waypoint of one of its queues",
        ),
        (("waypoints",), [], "waypoints: "),
    ],
)
def test_wrong_content_is_named(path, value, expected, tmp_path):
    table = small_table()
    at(*path)(table, value)
    with pytest.raises(InputError) as error:
        load(written(table, tmp_path))
    assert expected in str(error.value)
    assert "layout.json: " in str(error.value)


def test_edges_between_tiers_are_refused(tmp_path):
    table = small_table()
    table["tiers"].append({"length_m": 2.0, "width_m": 2.0})
    table["waypoints"][1]["tier"] = 1
    with pytest.raises(InputError, match="waypoint 1 is on another tier; use an elevator"):
        load(written(table, tmp_path))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", "not valid JSON"),
        ("{", "not valid JSON"),
        ("[]", "expected an object"),
        ('{"format": 1, "format": 2}', "key format occurs twice"),
        ("[" * 100_000, "not valid JSON"),
        ('{"format": "rmfs-layout-explicit/1"}', "waypoints: Field required"),
    ],
)
def test_broken_files_are_refused_in_one_line(text, expected, tmp_path):
    path = tmp_path / "layout.json"
    path.write_text(text)
    with pytest.raises(InputError) as error:
        load(path)
    assert expected in str(error.value)
    assert "\n" not in str(error.value)


def test_binary_file_is_refused(tmp_path):
    path = tmp_path / "layout.json"
    path.write_bytes(b"\xff\xfe\x00\x80")
    with pytest.raises(InputError, match="not valid JSON"):
        load(path)


def test_many_problems_are_counted(tmp_path):
    table = small_table()
    table["pods"] = [{"waypoint": 99, "capacity": 1}] * 30
    with pytest.raises(InputError, match=r"and 20 more$"):
        load(written(table, tmp_path))


def test_unwritable_folder(tmp_path):
    blocked = tmp_path / "file"
    blocked.write_text("")
    with pytest.raises(InputError, match="cannot be written"):
        save_json(generate(LayoutParameters()), blocked / "layout.json")


# --- overrides on explicit layouts ---------------------------------------------------------------


@pytest.fixture(scope="module")
def default_json(tmp_path_factory):
    path = tmp_path_factory.mktemp("explicit") / "default.json"
    save_json(generate(LayoutParameters()), path)
    return path


def test_overrides_of_stations_robots_and_pods(default_json):
    layout = load(
        default_json,
        [
            (["order_slots"], 7),
            (["unit_transfer_s"], 8.0),
            (["unit_pick_s"], 2),
            (["bundle_transfer_s"], 6.0),
            (["replenishment_station_capacity"], 55.0),
            (["pod_capacity"], 250.0),
            (["top_speed_m_s"], 2.0),
            (["acceleration_m_s2"], 0.5),
            (["deceleration_m_s2"], 0.6),
            (["full_turn_s"], 3.0),
            (["pod_transfer_s"], 4.0),
        ],
    )
    station = layout.pick_stations[2]
    assert (station.order_slots, station.unit_transfer_s, station.unit_pick_s) == (7, 8.0, 2)
    inserted = layout.replenishment_stations[1]
    assert (inserted.bundle_transfer_s, inserted.capacity) == (6.0, 55.0)
    assert set(layout.pod_capacity) == {250.0}
    kind = layout.robot_kinds[0]
    assert (kind.top_speed_m_s, kind.acceleration_m_s2, kind.deceleration_m_s2) == (2.0, 0.5, 0.6)
    assert (kind.full_turn_s, kind.pod_transfer_s, kind.radius_m) == (3.0, 4.0, 0.35)


@pytest.mark.parametrize("robots", [1, 16, 96])
def test_other_numbers_of_robots(default_json, robots):
    layout = load(default_json, [(["robots"], robots)])
    road = ~layout.is_storage & ~layout.is_queue
    assert layout.robots == robots
    assert len(set(layout.robot_waypoint.tolist())) == robots
    assert road[layout.robot_waypoint].all()
    again = load(default_json, [(["robots"], robots)])
    assert again.robot_waypoint.tolist() == layout.robot_waypoint.tolist()


@pytest.mark.parametrize(
    ("override", "expected"),
    [
        ((["robots"], 10_000), "robots: tier 0 has only 840 waypoints"),
        ((["robots"], "many"), "robots: Input should be a valid integer"),
        ((["robts"], 3), "unknown key robts; did you mean robots?"),
        ((["hall_width"], 4), "(an explicit layout): unknown key hall_width; valid: "),
        ((["unit_pick_s"], 0.0), "unit_pick_s: Input should be greater than 0"),
    ],
)
def test_wrong_overrides_are_named(default_json, override, expected):
    with pytest.raises(InputError) as error:
        load(default_json, [override])
    assert expected in str(error.value)
