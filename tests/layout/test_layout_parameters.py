"""Parameters: defaults, single errors, conditions between values, all problems at once."""

from __future__ import annotations

import tomllib

import pytest

from rmfs.config import validate
from rmfs.errors import InputError
from rmfs.layout import LayoutParameters, load
from rmfs.layout.toml import to_toml


def problem(**table):
    """Return the one line that a table of parameters is refused with."""
    with pytest.raises(InputError) as error:
        validate(LayoutParameters, table, "file.toml")
    message = str(error.value)
    assert "\n" not in message
    assert message.startswith("file.toml: ")
    return message


def test_defaults_are_those_of_the_reference():
    parameters = LayoutParameters()
    assert (parameters.robots, parameters.tiers, parameters.order_slots) == (16, 1, 12)
    assert (parameters.acceleration_m_s2, parameters.deceleration_m_s2) == (1.0, 1.0)
    assert (parameters.top_speed_m_s, parameters.full_turn_s, parameters.pod_transfer_s) == (
        1.5,
        2.5,
        2.2,
    )
    assert parameters.pick_stations.east == 4
    assert parameters.replenishment_stations.west == 4


@pytest.mark.parametrize(
    ("table", "expected"),
    [
        ({"seed": "x"}, "seed: Input should be a valid integer (given: 'x')"),
        ({"seed": -1}, "seed: Input should be greater than or equal to 0"),
        ({"robots": "16"}, "robots: Input should be a valid integer"),
        ({"robots": True}, "robots: Input should be a valid integer"),
        ({"robots": 0}, "robots: Input should be greater than or equal to 1"),
        ({"robot_radius_m": 0.5}, "robot_radius_m: Input should be less than 0.5"),
        ({"pod_share": 1.0}, "pod_share: Input should be less than 1"),
        ({"top_speed_m_s": float("nan")}, "top_speed_m_s: "),
        ({"unit_pick_s": float("inf")}, "unit_pick_s: "),
        ({"block_length": 3}, "block_length: Input should be a multiple of 2"),
        ({"buffer_width": 1}, "buffer_width: Input should be greater than or equal to 2"),
        ({"hall_width": 1}, "hall_width: Input should be greater than or equal to 2"),
        ({"hall_pattern": "tom"}, "hall_pattern: Input should be 'tim' or 'highway'"),
        ({"format": "rmfs-scenario/1"}, "format: Input should be 'rmfs-layout/1'"),
        ({"rbots": 3}, "unknown key rbots; did you mean robots?"),
        ({"pick_stations": {"est": 1}}, "unknown key pick_stations.est; did you mean"),
        ({"pick_stations": {"east": -1}}, "pick_stations.east: "),
        ({"horizontal_aisles": 7}, "horizontal_aisles: one-way aisles need an even number"),
        ({"vertical_aisles": 5}, "vertical_aisles: one-way aisles need an even number"),
        ({"entry_exit_distance": 2}, "entry_exit_distance: must be odd and at most 5 (given: 2)"),
        ({"entry_exit_distance": 7}, "entry_exit_distance: must be odd and at most 5 (given: 7)"),
        ({"hall_pattern": "highway", "hall_width": 5}, 'hall_width: the "highway" pattern needs'),
        ({"tiers": 2}, "elevators: 2 tiers need at least one"),
        ({"elevators": {"north": 1}}, "elevators: must be 0 with one tier (given: 1)"),
        ({"pick_stations": {}}, "pick_stations: at least one is needed"),
        ({"replenishment_stations": {}}, "replenishment_stations: at least one is needed"),
        (
            {"pick_stations": {"east": 5}},
            "the east side has room for 4, half the number of its aisles",
        ),
        ({"robots": 841}, "robots: a tier has only 840 road tiles (given: 841)"),
        ({"robots": 505}, "robots: a tier has only 504 storage locations to rest at (given: 505)"),
        ({"pod_share": 0.001}, "pod_share: gives no pod with 504 storage locations"),
        ({"horizontal_aisles": 10**9}, "less than or equal to 1000"),
        (
            {
                "two_directional_aisles": True,
                "entry_exit_distance": 5,
            },
            "entry_exit_distance: a queue on the west side would start outside",
        ),
        (
            {
                "two_directional_aisles": True,
                "hall_pattern": "highway",
                "vertical_aisles": 5,
            },
            'vertical_aisles: "highway" halls around single-lane aisles need an even number',
        ),
    ],
)
def test_wrong_values_are_named(table, expected):
    assert expected in problem(**table)


def test_all_problems_are_reported_at_once():
    message = problem(
        seed="x", rbots=3, horizontal_aisles=7, entry_exit_distance=4, tiers=2, robots=10_000
    )
    for part in ("seed", "rbots", "horizontal_aisles", "entry_exit_distance", "elevators", "10000"):
        assert part in message


def test_a_file_of_another_kind_is_not_told_key_by_key():
    message = problem(format="rmfs-scenario/1", duration_s=60, skus={"count": 10})
    assert message.count(";") == 0 and "unknown key" not in message
    assert "Input should be 'rmfs-layout/1' (given: 'rmfs-scenario/1')" in message


def test_a_wrong_value_does_not_cause_second_hand_problems():
    message = problem(horizontal_aisles="many")
    assert message.count(";") == 0


@pytest.mark.parametrize("robots", [32, 64, 96, 504])
def test_default_layout_takes_more_robots(robots):
    assert load("default", [(["robots"], robots)]).robots == robots


def test_two_directional_aisles_may_be_odd():
    LayoutParameters(two_directional_aisles=True, horizontal_aisles=9, vertical_aisles=5)


def test_written_parameters_are_read_back():
    parameters = LayoutParameters(
        name='a "quoted" näme',
        hall_pattern="highway",
        two_directional_aisles=True,
        pod_share=0.7,
        pick_stations={"north": 2, "east": 1},
    )
    text = to_toml(parameters)
    assert validate(LayoutParameters, tomllib.loads(text), "file.toml") == parameters
    assert "# acceleration of robots, m/s2" in text


def test_default_file_is_the_default():
    from rmfs.config import read_toml
    from rmfs.instances import locate

    table = read_toml(locate("layouts", "default"))
    assert validate(LayoutParameters, table, "default") == LayoutParameters(name="default")
    # a file without other kinds of station has no table of them
    assert set(table) == set(LayoutParameters.model_fields) - {"other_stations"}
