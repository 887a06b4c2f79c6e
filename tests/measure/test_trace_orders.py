"""What the events of a trace say of orders: lines, due times, pods brought for them."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from pyarrow import parquet

import rmfs
from rmfs.measure import RunFolder, load_run, write_run

OF = ["order", "sku", "pod", "robot", "station"]


def recorded(path: Path) -> RunFolder:
    overrides = [
        (["scenario", "warmup_s"], 0.0),
        (["scenario", "duration_s"], 900.0),
        (["scenario", "stock", "initial_share"], 0.6),
    ]
    run = rmfs.simulate("basic", "basic", "default", seed=3, overrides=overrides, trace=True)
    write_run(run, path, trace=True)
    return load_run(path)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> RunFolder:
    return recorded(tmp_path_factory.mktemp("orders") / "run")


def units(events: pd.DataFrame, kind: str) -> pd.Series:
    return events[events["kind"] == kind].groupby(OF)["units"].sum()


def test_lines_and_due_times_are_those_of_the_orders(folder: RunFolder) -> None:
    events, orders = folder.events, folder.table("orders").set_index("order")
    lines = events[events["kind"] == "order-line"].groupby("order")["units"].agg(["size", "sum"])
    due = events[events["kind"] == "order-due"].set_index("order")["units"]
    assert len(orders) > 50
    assert (lines.loc[orders.index, "size"] == orders["lines"]).all()
    assert (lines.loc[orders.index, "sum"] == orders["units"]).all()
    np.testing.assert_allclose(due[orders.index], orders["due_s"], atol=0.5)


def test_a_unit_is_picked_from_the_pod_that_was_brought_for_it(folder: RunFolder) -> None:
    events = folder.events
    picked = units(events, "unit-picked")
    left = units(events, "units-bound").sub(picked, fill_value=0)
    left = left.sub(units(events, "units-unbound"), fill_value=0)
    assert len(picked) > 100
    assert (left >= 0).all()
    # what is left at the end are the units of tasks that are not over
    assert 0 < left.sum() < 100
    bound = events[events["kind"] == "units-bound"].groupby(OF)["time_us"].min()
    first = events[events["kind"] == "unit-picked"].groupby(OF)["time_us"].min()
    assert (bound[first.index] <= first).all()


def test_parts_of_orders_have_lines_and_leave_their_slots(tmp_path: Path) -> None:
    short = {"scenario.duration_s": 900, "layout.robots": 6, "controllers.poa.split": True}
    made = rmfs.simulate("small", "small", "pile-on-split", seed=3, set=short, trace=True)
    write_run(made, tmp_path / "run", trace=True)
    _, _, events = load_run(tmp_path / "run").replayed()
    parts = events[(events["kind"] == "order-line") & (events["station"] >= 0)]
    assert parts["order"].nunique() > 5
    # a part that was picked empty has left the station at which its lines were
    left = events[events["kind"] == "part-completed"].merge(parts, on=["order", "station"])
    assert left["order"].nunique() > 5
    picked = events[events["kind"] == "unit-picked"].groupby(["order", "sku", "station"])["units"]
    wanted = left.drop_duplicates(["order", "sku_y", "station"])
    keys = list(zip(wanted["order"], wanted["sku_y"], wanted["station"], strict=True))
    assert (picked.sum().loc[keys].to_numpy() == wanted["units_y"].to_numpy()).all()


def test_events_of_the_first_format_are_read(folder: RunFolder, tmp_path: Path) -> None:
    table = parquet.read_table(folder.path / "events.parquet")
    old = table.replace_schema_metadata({b"rmfs-format": b"rmfs-events/1"})
    parquet.write_table(old, tmp_path / "events.parquet")
    assert len(RunFolder(tmp_path, {}).events) == len(folder.events)
