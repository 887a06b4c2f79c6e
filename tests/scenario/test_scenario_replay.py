"""Streams under whole runs: exported and replayed, recorded and replayed."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd
import pytest
from scenario_tools import SITE

import rmfs
from rmfs.measure.dictionary import reproducible
from rmfs.observer import Observer
from rmfs.scenario import StreamRecorder, export_stream, load, sku_set, write_stream
from rmfs.scenario.clock import nearest_us
from rmfs.simulation import arrivals

if TYPE_CHECKING:
    from rmfs.simulation.result import Run
    from rmfs.world.orders import Order

pytestmark = pytest.mark.skipif(
    not hasattr(arrivals, "order_intake"), reason="the simulation does not use intakes yet"
)

SEED = 3
SCENARIO = """
format = "rmfs-scenario/1"
name = "replay"
duration_s = {duration_s}
warmup_s = 600
[demand]
{demand}
[replenishment]
mode = "needed"
reorder_below_units = 12
"""
GENERATED = 'mode = "poisson"\norders_per_h = 170\n'
"""For the four pick stations of the default layout."""


def scenario(folder: Path, demand: str, duration_s: float) -> Path:
    path = folder / "replay.toml"
    path.write_text(SCENARIO.format(demand=demand, duration_s=duration_s))
    return path


def simulated(path: Path, *observers: Observer) -> Run:
    return rmfs.simulate("default", path, "default", seed=SEED, observers=observers)


def footprint(run: Run) -> str:
    return run.footprint[reproducible("footprint")].to_csv()


def replayed_alike(folder: Path, orders: int, duration_s: float) -> None:
    generated = scenario(folder, GENERATED, duration_s)
    exported = export_stream(load(generated), "orders", folder / "orders.csv", SITE, SEED)
    assert exported.number >= orders
    first = simulated(generated)
    assert first.world.orders_created == exported.number
    # columns in another order and other decimals are the same stream
    table = pd.read_csv(exported.path)
    table[["due", "quantity", "sku", "order", "time"]].to_csv(exported.path, index=False)
    demand = f'mode = "stream"\nfile = "orders.csv"\ndigest = "{exported.digest}"'
    again = simulated(scenario(folder, demand, duration_s))
    assert again.world.orders_completed > 0.9 * orders
    assert footprint(again) == footprint(first)


def test_an_hour_of_exported_orders_replays_bit_for_bit(tmp_path: Path):
    replayed_alike(tmp_path, orders=600, duration_s=3600)


@pytest.mark.slow
def test_ten_thousand_exported_orders_replay_bit_for_bit(tmp_path: Path):
    replayed_alike(tmp_path, orders=10_000, duration_s=54_000)


class Recording(Observer):
    """Hands what a run was asked for to a recorder."""

    def __init__(self) -> None:
        self.streams = StreamRecorder()

    def order_created(self, order: Order) -> None:
        skus, units = [line.sku for line in order.lines], [line.units for line in order.lines]
        times = nearest_us(order.created_s), nearest_us(order.due_s)
        self.streams.orders.add(*times, skus, units)


def test_the_orders_of_a_backlog_are_recorded_and_replayed(tmp_path: Path):
    recording = Recording()
    path = scenario(tmp_path, 'mode = "backlog"\norders = 50', duration_s=1800)
    run = simulated(path, recording)
    stream = recording.streams.orders.build()
    assert len(stream) == run.world.orders_created > 200
    skus = sku_set(run.scenario.skus)
    digest = write_stream(stream, skus, tmp_path / "orders.parquet")
    demand = f'mode = "stream"\nfile = "orders.parquet"\ndigest = "{digest}"'
    replayed = Recording()
    simulated(scenario(tmp_path, demand, duration_s=1800), replayed)
    again = replayed.streams.orders.build()
    assert write_stream(again, skus, tmp_path / "again.csv") == digest


@pytest.mark.parametrize("name", ["poisson", "letters", "shifts"])
def test_shipped_scenarios_run(name: str):
    overrides = [
        (["scenario", "warmup_s"], 0),
        (["scenario", "duration_s"], 900),
        # the doors of shifts are open, and the letters in stock do not last long
        (["scenario", "time_of_day_s"], 6 * 3600),
        (["scenario", "stock", "initial_share"], 0.01 if name == "letters" else 0.7),
    ]
    run = rmfs.simulate("default", name, "default", seed=1, overrides=overrides)
    assert run.world.orders_completed > 20
    assert run.world.bundles_stored > 0
