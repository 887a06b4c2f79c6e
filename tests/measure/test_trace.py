"""The files of a trace: what they hold agrees with the tables, and damage is noticed."""

from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
from pyarrow import parquet

import rmfs
from rmfs.errors import InputError
from rmfs.measure import RunFolder, load_run, write_run
from rmfs.measure.checker import check


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> RunFolder:
    overrides = [
        (["scenario", "warmup_s"], 120.0),
        (["scenario", "duration_s"], 900.0),
        (["scenario", "stock", "initial_share"], 0.5),
    ]
    run = rmfs.simulate("basic", "basic", "default", seed=3, overrides=overrides, trace=True)
    path = tmp_path_factory.mktemp("traced") / "run"
    write_run(run, path, trace=True)
    return load_run(path)


def test_layout_and_motion_can_be_checked_from_the_folder_alone(folder: RunFolder) -> None:
    assert check(folder.layout, folder.trace, until_us=1_020_000_000).ok


def test_stock_at_the_end_follows_from_the_events(folder: RunFolder) -> None:
    events = folder.events
    space = folder.table("skus")["space"].to_numpy()
    sign = events["kind"].map({"stock": 1, "bundle-stored": 1, "unit-picked": -1}).fillna(0)
    change = sign.astype(float) * events["units"] * space[events["sku"]]
    pods = folder.table("pods")
    known = events["pod"] >= 0
    used = np.bincount(events["pod"][known], weights=change[known], minlength=len(pods))
    np.testing.assert_allclose(used, pods["used_end"], atol=1e-9)


def test_counts_agree_with_the_tables(folder: RunFolder) -> None:
    events = folder.events
    measured = events[events["time_us"] >= 120_000_000]["kind"].value_counts()
    footprint = folder.footprint
    assert measured["order-completed"] == footprint["orders_completed"]
    assert measured["unit-picked"] == footprint["units_picked"]
    assert measured["bundle-stored"] == footprint["bundles_stored"]
    orders = folder.table("orders").set_index("order")
    for kind, column in (("order-created", "created_s"), ("order-completed", "completed_s")):
        times = events[events["kind"] == kind].set_index("order")["time_us"] / 1e6
        told = orders[column].dropna()
        np.testing.assert_allclose(times[told.index], told, atol=1e-6)


def test_robots_carry_their_pods_to_the_visits_told(folder: RunFolder) -> None:
    events, motion = folder.events, folder.trace
    started = events[events["kind"] == "visit-started"]
    for visit in started.sample(20, random_state=1).itertuples():
        rows = motion[(motion["robot"] == visit.robot) & (motion["t1_us"] == visit.time_us)]
        assert visit.pod in set(rows["pod"])


def test_a_trace_that_is_missing_is_asked_for(folder: RunFolder, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"events.parquet is missing\); run with --trace"):
        _ = RunFolder(tmp_path, {}).events


@pytest.mark.parametrize("share", [0.0, 0.3, 0.999])
def test_a_trace_that_is_cut_off_is_refused(
    folder: RunFolder, tmp_path: Path, share: float
) -> None:
    whole = (folder.path / "trace.parquet").read_bytes()
    (tmp_path / "trace.parquet").write_bytes(whole[: int(share * len(whole))])
    with pytest.raises(InputError, match="truncated or not a trace"):
        _ = RunFolder(tmp_path, {}).trace


def test_a_trace_of_another_version_is_refused(folder: RunFolder, tmp_path: Path) -> None:
    table = parquet.read_table(folder.path / "trace.parquet")
    later = table.replace_schema_metadata({b"rmfs-format": b"rmfs-trace/3"})
    parquet.write_table(later, tmp_path / "trace.parquet")
    with pytest.raises(InputError, match="format 'rmfs-trace/3', expected 'rmfs-trace/2'"):
        _ = RunFolder(tmp_path, {}).trace


def test_a_strangers_table_is_refused(tmp_path: Path) -> None:
    parquet.write_table(pa.table({"robot": [1, 2]}), tmp_path / "trace.parquet")
    with pytest.raises(InputError, match="not a trace of rmfs"):
        _ = RunFolder(tmp_path, {}).trace


def test_a_trace_without_a_column_is_refused(folder: RunFolder, tmp_path: Path) -> None:
    table = parquet.read_table(folder.path / "trace.parquet").drop_columns(["pod"])
    parquet.write_table(table, tmp_path / "trace.parquet")
    with pytest.raises(InputError, match="column pod missing"):
        _ = RunFolder(tmp_path, {}).trace


def test_following_a_trace_gives_the_whole_of_it() -> None:
    """What `trace_after` tells, put together as it says, is what `trace` says in the end."""
    from rmfs.layout import load
    from rmfs.traffic import Step, Traffic, joined_holds

    layout = load("basic")
    traffic = Traffic(layout, record_trace=True)
    goals = np.flatnonzero(layout.is_storage)[:: layout.robots]
    known, followed = 0, pd.DataFrame()
    for second in range(1, 40):
        if second == 1:
            for robot in range(layout.robots):
                traffic.command(robot, [(Step.DRIVE, int(goals[robot]))])
        while traffic.advance(second * 1_000_000):
            pass
        columns, known = traffic.trace_after(known)
        news = pd.DataFrame(columns)
        if len(followed):
            since = news.groupby("robot")["t0_us"].min().reindex(followed["robot"]).to_numpy()
            followed = followed[~(followed["t0_us"].to_numpy() >= since)]
        followed = pd.concat([followed, news])
    followed = followed.sort_values(["robot", "t0_us"])
    whole = joined_holds({name: followed[name].to_numpy() for name in followed})
    pd.testing.assert_frame_equal(pd.DataFrame(whole), pd.DataFrame(traffic.trace()))


def test_the_trace_of_a_run_with_empty_batteries_is_read(tmp_path: Path) -> None:
    given = {
        "scenario.duration_s": 300.0,
        "scenario.energy.battery.capacity_wh": 2.0,
        "scenario.energy.inductive.power_w": 50.0,
    }
    run = rmfs.simulate("small", "small", "default", set=given, trace=True)
    _, _, events = run.save(tmp_path / "run").replayed()
    levels = events["units"][events["kind"] == "battery-level"]
    assert levels.min() < 0
