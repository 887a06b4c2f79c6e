"""The generator against layouts that the reference system generated from the same parameters."""

from __future__ import annotations

from dataclasses import fields, replace

import pytest
from layout_reference import INSTANCES, by_coordinates, needs_reference, read_reference

from rmfs.layout import LayoutParameters, check, generate, load

pytestmark = needs_reference

GENERATED = {
    "a-hallway": "generated/a-hallway.xlayo",
    "b-clockwise-tim": "generated/b-clockwise-tim.xlayo",
    "basic": "basic/BasicInstance.xlayo",
    "c-double-lane": "generated/c-double-lane.xlayo",
    "d-two-directional": "generated/d-two-directional.xlayo",
    "e-four-sides-tim": "generated/e-four-sides-tim.xlayo",
    "f-two-tiers-elevators": "generated/f-two-tiers-elevators.xlayo",
    "fastlane": "fastlane/1-4-4-32-0.85.xlayo",
    "g-small-block2": "generated/g-small-block2.xlayo",
    "reposmall": "repositioning/RepoSmall.xlayo",
}

SHIPPED = {
    "mati/MaTiPico.xinst": {"aisles": (2, 2), "picks": {"east": 1}, "inserts": {"west": 1}},
    "mati/MaTiMilli.xinst": {"aisles": (8, 8), "picks": {"east": 4}, "inserts": {"west": 4}},
    "mati/MaTiTiny.xinst": {"aisles": (8, 6), "picks": {"east": 4}, "inserts": {"west": 4}},
    "pp/1-4-4-32-550.xinst": {
        "aisles": (8, 8),
        "picks": {"east": 4},
        "inserts": {"west": 4},
        "hall_width": 4,
    },
    "pp/1-12-20-128-1965.xinst": {
        "aisles": (16, 16),
        "picks": {"east": 8, "north": 6, "south": 6},
        "inserts": {"west": 8, "north": 2, "south": 2},
        "hall_width": 4,
    },
    "pp/3-12-12-96-1650.xinst": {
        "aisles": (8, 8),
        "picks": {"east": 4},
        "inserts": {"west": 4},
        "hall_width": 4,
        "tiers": 3,
        "elevators": {"north": 2, "south": 2},
    },
}
"""Shipped instances whose parameters follow from their counts (reference, section 7)."""


def assert_same(ours, theirs):
    """Compare piece by piece, so that a difference is shown small."""
    for field in fields(theirs):
        a, b = getattr(ours, field.name), getattr(theirs, field.name)
        if isinstance(b, set):
            assert sorted(a - b)[:5] == [], f"{field.name}: not in the reference"
            assert sorted(b - a)[:5] == [], f"{field.name}: missing"
        else:
            assert a == b, field.name


INTO_CORNER = {"d-two-directional": ((0, 4.5, 0.5), (0, 3.5, 0.5))}
"""Edges that we have in addition: there, nobody can reach a queue that begins at a corner."""


def generated(name):
    """What the generator makes, without that edge."""
    ours = by_coordinates(load(INSTANCES / GENERATED[name]))
    if name in INTO_CORNER:
        ours.edges.remove(INTO_CORNER[name])
    return ours


@pytest.mark.parametrize("name", GENERATED)
def test_generator_meets_reference_edge_by_edge_and_queue_by_queue(name):
    assert_same(generated(name), read_reference(f"generated/{name}.xinst"))


@pytest.mark.parametrize("name", GENERATED)
def test_what_is_generated_is_well_formed(name):
    assert check(load(INSTANCES / GENERATED[name])) == []


@pytest.mark.parametrize("name", SHIPPED)
def test_generator_meets_shipped_instances(name):
    case = dict(SHIPPED[name])
    theirs = read_reference(name)
    horizontal, vertical = case.pop("aisles")
    tiers = case.get("tiers", 1)
    parameters = LayoutParameters(
        horizontal_aisles=horizontal,
        vertical_aisles=vertical,
        pick_stations=case.pop("picks"),
        replenishment_stations=case.pop("inserts"),
        robots=theirs.robots // tiers,
        **case,
    )
    ours = by_coordinates(generate(parameters))
    # these were generated before activation ranks and pick times were written
    if not any(rank for _, rank in theirs.picks):
        ours = replace(
            ours,
            picks=[(queue, 0) for queue, _ in ours.picks],
            replenishments=[(queue, 0) for queue, _ in ours.replenishments],
        )
    assert_same(ours, theirs)


@pytest.mark.parametrize("name", GENERATED)
def test_importer_meets_generator(name):
    imported = by_coordinates(load(INSTANCES / f"generated/{name}.xinst"))
    assert_same(generated(name), imported)


def test_shipped_basic_is_the_regression_layout():
    ours, theirs = load("basic"), load(INSTANCES / "basic/BasicInstance.xlayo")
    assert_same(by_coordinates(ours), by_coordinates(theirs))
    assert ours.robot_kinds == theirs.robot_kinds
    assert ours.pod_capacity.tolist() == theirs.pod_capacity.tolist()
    station, other = ours.pick_stations[0], theirs.pick_stations[0]
    assert replace(station, queue=(), waypoint=0) == replace(other, queue=(), waypoint=0)
