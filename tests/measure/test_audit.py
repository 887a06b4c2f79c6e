"""The audit of a run: clean runs pass, and whatever is spoilt in their files is noticed."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
from pyarrow import parquet

import rmfs
from rmfs.cli import main
from rmfs.errors import InputError
from rmfs.measure import load_run
from rmfs.measure.audit import audit
from rmfs.measure.checker import check
from tests.tools.proof import drawn

Frame = pd.DataFrame
Spoil = Callable[[Frame], Frame]


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run with split orders, slow robots, cut orders and replenishment."""
    given = {
        "scenario.duration_s": 900,
        "scenario.warmup_s": 100,
        "layout.robots": 8,
        "controllers.poa.split": True,
        "scenario.disturbances.slow": {"every_s": 30, "lasting_s": 60, "speed_share": 0.5},
    }
    run = rmfs.simulate("small", "small", "pile-on-split", seed=3, set=given, trace=True)
    return run.save(tmp_path_factory.mktemp("audited") / "whole").path


@pytest.fixture
def run(whole: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(whole, tmp_path / "run"))


def rewrite(path: Path, how: Spoil) -> None:
    metadata = parquet.read_schema(path).metadata
    table = pa.Table.from_pandas(how(parquet.read_table(path).to_pandas()), preserve_index=False)
    parquet.write_table(table.replace_schema_metadata(metadata), path)


def test_a_clean_run_passes(whole: Path, capsys) -> None:
    assert main(["check", str(whole)]) == 0
    lines = capsys.readouterr().out.splitlines()
    names = ["motion", "stock", "visits", "orders", "slots", "bundles", "tasks", "tables"]
    assert [line.partition(":")[0] for line in lines] == names
    assert lines[0].startswith("motion: trace is safe")
    assert all(line.endswith(": ok") for line in lines[1:])


def test_as_documented_without_an_end(whole: Path) -> None:
    """`check(run.layout, run.trace)`: slow robots, and turns at the end, are no findings."""
    run = load_run(whole)
    assert run.told.slow_robots
    for other in (run, load_run(whole)):
        report = check(other.layout, other.trace)
        assert report.ok, report.summary()


@pytest.mark.parametrize("seed", range(8))
def test_clean_runs_need_no_end(seed: int) -> None:
    run = rmfs.simulate("small", "small", seed=seed, set={"scenario.duration_s": 97.3}, trace=True)
    report = check(run.layout, run.trace)
    assert report.ok, report.summary()


def test_inputs_are_checked_as_before(capsys) -> None:
    assert main(["check"]) == 0
    assert capsys.readouterr().out.splitlines() == ["default, default, default: ok"]


def of(kind: str, number: int = 0) -> Callable[[Frame], int]:
    return lambda frame: int(np.flatnonzero(frame["kind"] == kind)[number])


def cell(row: Callable[[Frame], int], name: str, to: object) -> Spoil:
    def spoil(frame: Frame) -> Frame:
        frame = frame.copy()
        at = row(frame)
        old = frame.loc[at, name]
        frame.loc[at, name] = to(old) if callable(to) else to
        return frame

    return spoil


def without(row: Callable[[Frame], int]) -> Spoil:
    return lambda frame: frame.drop(index=row(frame)).reset_index(drop=True)


def twice(row: Callable[[Frame], int]) -> Spoil:
    def spoil(frame: Frame) -> Frame:
        at = row(frame)
        parts = [frame.iloc[: at + 1], frame.iloc[at : at + 1], frame.iloc[at + 1 :]]
        return pd.concat(parts, ignore_index=True)

    return spoil


def swapped(one: Callable[[Frame], int], other: Callable[[Frame], int]) -> Spoil:
    """Two rows take each other's place, but for their times."""

    def spoil(frame: Frame) -> Frame:
        rows = np.arange(len(frame))
        a, b = one(frame), other(frame)
        rows[[a, b]] = rows[[b, a]]
        return frame.iloc[rows].reset_index(drop=True).assign(time_us=frame["time_us"].to_numpy())

    return spoil


def last_of_its_order(kind: str) -> Callable[[Frame], int]:
    """The row of that kind of an order that is completed."""

    def find(frame: Frame) -> int:
        done = set(frame.loc[frame["kind"] == "order-completed", "order"])
        mine = (frame["kind"] == kind) & frame["order"].isin(done)
        if kind == "order-line":
            mine &= frame["station"] < 0  # as it was ordered, and not of a part
        return int(np.flatnonzero(mine)[-1])

    return find


def one(old: int) -> int:
    return old + 1


EVENTS: dict[str, Spoil] = {
    "less stock": cell(of("stock"), "units", lambda old: old - 1),
    "more stock": cell(of("stock"), "units", lambda old: old + 10_000),
    "no stock of a pod that is picked": lambda frame: frame[
        ~((frame["kind"] == "stock") & (frame["pod"] == frame["pod"][of("unit-picked")(frame)]))
    ].reset_index(drop=True),
    "a pick left out": without(last_of_its_order("unit-picked")),
    "a pick twice": twice(last_of_its_order("unit-picked")),
    "a pick from another pod": cell(of("unit-picked", 9), "pod", lambda old: (old + 1) % 100),
    "a pick of another SKU": cell(of("unit-picked", 9), "sku", lambda old: (old + 1) % 100),
    "a pick for another order": cell(of("unit-picked", 9), "order", one),
    "a pick at another station": cell(of("unit-picked", 9), "station", lambda old: 1 - old),
    "a pick by another robot": cell(of("unit-picked", 9), "robot", lambda old: (old + 1) % 8),
    "a pick of three units": cell(of("unit-picked", 9), "units", 3),
    "a visit without a start": without(of("visit-started", 4)),
    "a visit without an end": without(of("visit-ended", 4)),
    "a visit of another pod": cell(of("visit-started", 4), "pod", lambda old: (old + 1) % 100),
    "a visit of another robot": cell(of("visit-started", 4), "robot", lambda old: (old + 1) % 8),
    "a visit elsewhere": cell(of("visit-started", 4), "station", lambda old: (old + 1) % 4),
    "an order that never came": without(of("order-created", 3)),
    "an order that came twice": twice(of("order-created", 3)),
    "a line of more units": cell(last_of_its_order("order-line"), "units", one),
    "an order done twice": twice(of("order-completed", 3)),
    "an order that is not done": without(of("order-completed", 3)),
    "an order with no units": cell(of("order-completed", 3), "units", 0),
    "another order is done": cell(of("order-completed", 3), "order", one),
    "an order without a station": without(last_of_its_order("order-assigned")),
    "an order at another station": cell(
        last_of_its_order("order-assigned"), "station", lambda old: 1 - old
    ),
    "another order at the station": cell(of("order-assigned", 3), "order", lambda old: old + 500),
    "a part that never leaves": without(of("part-completed", 2)),
    "a part that leaves twice": twice(of("part-completed", 2)),
    "a part of no order": cell(of("part-completed", 2), "order", 10_000),
    "a bundle that never came": without(of("bundle-created")),
    "a bundle stored twice": twice(of("bundle-stored")),
    "a bundle in another pod": cell(of("bundle-stored"), "pod", lambda old: (old + 1) % 100),
    "a bundle of more units": cell(of("bundle-stored"), "units", one),
    "a bundle without a station": without(of("bundle-assigned")),
    "units bound to another pod": cell(of("units-bound", 5), "pod", lambda old: (old + 1) % 100),
    "units not bound": without(of("units-bound", 5)),
    "a station switched off": cell(of("station-switched"), "units", lambda old: 1 - old),
    "picked before it was assigned": swapped(of("order-assigned"), of("unit-picked")),
}


def moved(frame: Frame, kind: int, number: int = 5) -> int:
    return int(np.flatnonzero(frame["kind"] == kind)[number])


def at(kind: int, number: int = 5) -> Callable[[Frame], int]:
    return lambda frame: moved(frame, kind, number)


def longer(frame: Frame) -> Frame:
    """A robot is told to begin later what it does."""
    frame = frame.copy()
    row = moved(frame, 2)
    frame.loc[row, "t0_us"] += 1_000_000
    frame.loc[row - 1, "t1_us"] += 1_000_000
    return frame


MOTION: dict[str, Spoil] = {
    "a robot told as another": lambda frame: (
        frame.assign(robot=(frame["robot"] + 1) % 8)
        .sort_values(["robot", "t0_us"], kind="stable")
        .reset_index(drop=True)
    ),
    "a run to another place": cell(at(2), "to_wp", one),
    "a run from another place": cell(at(2), "from_wp", one),
    "a run that begins late": longer,
    "a run faster than the robot": cell(at(2), "top_speed_m_s", lambda old: 2 * old),
    "a slow run told as fast": lambda frame: frame.assign(
        top_speed_m_s=np.where(frame["kind"] == 2, frame["top_speed_m_s"].max(), 0.0)
    ),
    "a run at no speed": cell(at(2), "top_speed_m_s", 0.0),
    "a run at an infinite speed": cell(at(2), "top_speed_m_s", np.inf),
    "a turn the wrong way": cell(at(1), "heading1_rad", lambda old: old + 1.0),
    "a heading that is none": cell(at(1), "heading1_rad", np.nan),
    "a lift of another pod": cell(at(4, 3), "pod", lambda old: (old + 1) % 100),
    "a lift told as standing": cell(at(4, 3), "kind", 0),
    "a pod that vanishes": cell(at(2, 40), "pod", lambda old: -1 if old >= 0 else 3),
    "a robot left out": lambda frame: frame[frame["robot"] != 3].reset_index(drop=True),
    "a robot cut short": lambda frame: frame[
        (frame["robot"] != 3) | (frame["t0_us"] < 400_000_000)
    ].reset_index(drop=True),
    "robot 999": cell(at(2), "robot", 999),
    "waypoint -5": cell(at(2), "to_wp", -5),
    "kind 77": cell(at(2), "kind", 77),
}
FILES = {"events.parquet": EVENTS, "trace.parquet": MOTION}
KINDS = [(file, what) for file, kinds in FILES.items() for what in kinds]


def test_there_are_enough_kinds() -> None:
    assert len(KINDS) >= 46


@pytest.mark.parametrize(("file", "what"), KINDS)
def test_what_is_spoilt_is_noticed(file: str, what: str, run: Path, capsys) -> None:
    rewrite(run / file, FILES[file][what])
    assert main(["check", str(run)]) in (1, 2)
    told = capsys.readouterr()
    assert "Traceback" not in told.err
    assert (
        "faults found" in told.out or "not safe" in told.out or "cannot be" in told.err or told.err
    )


def test_an_order_with_all_its_units_is_completed(run: Path, capsys) -> None:
    rewrite(run / "events.parquet", without(of("order-completed", 3)))
    assert main(["check", str(run)]) == 1
    (line,) = [one for one in capsys.readouterr().out.splitlines() if "got its last unit" in one]
    assert line.endswith("is not completed")


@pytest.mark.parametrize("name", ["units_picked", "orders_completed", "bundles_stored"])
def test_figures_that_did_not_happen(name: str, run: Path, capsys) -> None:
    frame = pd.read_parquet(run / "footprint.parquet")
    frame[name] += 1
    frame.to_parquet(run / "footprint.parquet", index=False)
    assert main(["check", str(run)]) == 1
    assert f"footprint: {name}" in capsys.readouterr().out


def test_a_run_without_a_trace(tmp_path: Path, capsys) -> None:
    run = rmfs.simulate("small", "small", seed=1, set={"scenario.duration_s": 30})
    run.save(tmp_path / "run")
    assert main(["check", str(tmp_path / "run")]) == 2
    assert "run with --trace" in capsys.readouterr().err


def fuzzed(number: int, folder: Path) -> None:
    case = drawn(number)
    case["set"] |= {"scenario.duration_s": 400.0, "scenario.warmup_s": 50.0}
    run = rmfs.simulate(**case, trace=True)
    found = audit(run.save(folder / "run", force=True))
    assert found.ok, found.summary()


@pytest.mark.parametrize("number", [1, 4, 20, 29])
def test_runs_of_all_sorts(number: int, tmp_path: Path) -> None:
    fuzzed(number, tmp_path)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("number", range(5_000, 5_200))
def test_200_fuzzed_runs(number: int, tmp_path: Path) -> None:
    try:
        fuzzed(number, tmp_path)
    except InputError as error:
        raise AssertionError(f"case {number} cannot run: {error}") from None
