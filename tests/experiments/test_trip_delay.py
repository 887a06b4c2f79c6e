"""The share of trip time that is delay, beside the trips of a run."""

from __future__ import annotations

import pytest

import rmfs
from rmfs.experiments.papers.trip_delay import TripDelay


def test_trips_to_stations_are_left_out() -> None:
    given = {"scenario.duration_s": 900, "scenario.warmup_s": 100, "layout.robots": 8}
    run = rmfs.simulate("small", "small", seed=2, set=given, measures=[TripDelay])
    delayed = lasted = 0.0
    for trip in run.table("trips").itertuples():
        if trip.kind != "to_station":
            lasted += trip.end_s - trip.start_s
            delayed += trip.end_s - trip.start_s - trip.unhindered_s
    assert 0.0 < delayed < lasted
    assert float(run.footprint["trip_delay_share"]) == pytest.approx(delayed / lasted)
