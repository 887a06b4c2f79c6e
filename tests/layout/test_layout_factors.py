"""Factors of experiments: shares of stations and robots per station, on any kind of layout."""

from __future__ import annotations

import pytest

import rmfs
from rmfs.errors import InputError
from rmfs.layout import load
from rmfs.layout.explicit import save_json


@pytest.mark.parametrize("explicit", [False, True])
def test_stations_that_come_first_are_kept_and_robots_follow(tmp_path, explicit: bool):
    name = "default"
    if explicit:
        name = str(tmp_path / "explicit.json")
        save_json(load("default"), tmp_path / "explicit.json")
    before = load(name)
    after = load(
        name,
        [
            (["pick_station_share"], 0.5),
            (["replenishment_station_share"], 0.3),
            (["robots_per_pick_station"], 5),
        ],
    )
    first = sorted(before.pick_stations, key=lambda station: station.activation)[:2]
    assert set(after.pick_stations) == set(first)
    assert len(after.replenishment_stations) == 1  # of four, rounded down
    assert after.robots == 10
    dropped = {place for s in before.stations for place in s.queue}
    dropped -= {place for s in after.stations for place in s.queue}
    assert dropped
    assert not after.is_queue[sorted(dropped)].any()


@pytest.mark.parametrize("share", [0, 1.5, "half"])
def test_a_share_is_between_nothing_and_all(share):
    with pytest.raises(InputError, match="pick_station_share"):
        load("default", [(["pick_station_share"], share)])


def test_half_the_stations_run():
    overrides = [
        (["layout", "pick_station_share"], 0.5),
        (["scenario", "warmup_s"], 0),
        (["scenario", "duration_s"], 600),
    ]
    run = rmfs.simulate("default", "default", "default", seed=1, overrides=overrides)
    assert run.footprint["pick_stations"] == 2
    assert run.footprint["units_picked"] > 50
