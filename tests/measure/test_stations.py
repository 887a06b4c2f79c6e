"""The table of stations once more: split orders from the events, chargers from the visits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest

import rmfs
from rmfs.measure.events import Happening

WARMUP_S, END_S = 900.0, 2400.0

CHARGED = """
format = "rmfs-layout/1"
name = "charged"
robots = 12

[pick_stations]
east = 4

[replenishment_stations]
west = 4

[other_stations.charger]
kind = "charger"
north = 3

[other_stations.charger.parameters]
power_w = 600.0
"""


@pytest.fixture(scope="module")
def split() -> Any:
    """Orders arrive so seldom that stations are sometimes without any."""
    keys = {
        "scenario.warmup_s": WARMUP_S,
        "scenario.duration_s": END_S - WARMUP_S,
        "scenario.demand.orders_per_h": 60.0,
        "controllers.poa.split_orders": 10**6,
    }
    return rmfs.simulate("small", "small-arrivals", "pile-on-split", seed=4, set=keys, trace=True)


@pytest.fixture(scope="module")
def charged(tmp_path_factory: pytest.TempPathFactory) -> Any:
    layout = tmp_path_factory.mktemp("layouts") / "charged.toml"
    layout.write_text(CHARGED, encoding="utf-8")
    keys = {
        "scenario.warmup_s": 1800,
        "scenario.duration_s": 1800,
        "scenario.energy.battery": {"capacity_wh": 150, "initial_least_share": 0.3},
        "controllers.ca": {"name": "threshold", "below_share": 0.35, "until_share": 0.8},
    }
    return rmfs.simulate(str(layout), "default", set=keys)


def events_of(run: Any) -> pd.DataFrame:
    frame = pd.DataFrame(run.events.columns())
    return frame.assign(time_s=frame["time_us"] / 1e6)


def test_a_station_has_work_while_an_order_or_a_part_of_one_is_there(split: Any) -> None:
    """Second by second, from the events."""
    came, gone = Happening.ORDER_ASSIGNED, (Happening.PART_COMPLETED, Happening.ORDER_COMPLETED)
    there: dict[int, set[int]] = {0: set(), 1: set()}
    empty_s = dict.fromkeys(there, 0.0)
    parts, before_s = 0, WARMUP_S
    for event in events_of(split).itertuples():
        if event.time_s > before_s:
            for station, orders in there.items():
                empty_s[station] += 0.0 if orders else event.time_s - before_s
            before_s = event.time_s
        if event.kind == came:
            there[event.station].add(event.order)
        elif event.kind in gone:
            there[event.station].discard(event.order)
            parts += event.kind == Happening.PART_COMPLETED
    for station, orders in there.items():
        empty_s[station] += 0.0 if orders else END_S - before_s
    assert parts > 10
    shares = split.table("stations")["without_work_share"]
    for station, seconds in empty_s.items():
        assert shares[station] == pytest.approx(seconds / (END_S - WARMUP_S), abs=1e-6)
        assert 0.01 < shares[station] < 0.99


def test_chargers_are_busy_while_robots_charge_up_to_the_end(charged: Any) -> None:
    stations, visits = charged.table("stations"), charged.table("visits")
    chargers = stations[stations["kind"] == "charger"]
    mine = visits[visits["station"].isin(chargers["station"])]
    assert mine["end_s"].isna().any()
    # a robot leaves as soon as its way is free
    charging_s = charged.table("robots")["charging_s"].sum()
    assert chargers["busy_s"].sum() == pytest.approx(charging_s, abs=5.0)


def test_visits_to_chargers_that_ended_in_the_warm_up_do_not_count(charged: Any) -> None:
    stations, visits = charged.table("stations").set_index("station"), charged.table("visits")
    early = 0
    for number in stations.index[stations["kind"] == "charger"]:
        own = visits[visits["station"] == number]
        early += (own["begin_s"] < charged.warmup_s).sum()
        assert stations["visits"][number] == len(own)
        mean_s = np.mean([row.end_s - row.begin_s for row in own.dropna().itertuples()])
        assert stations["visit_time_mean_s"][number] == pytest.approx(mean_s)
    assert early > 0
