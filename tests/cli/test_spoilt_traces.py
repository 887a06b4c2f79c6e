"""Traces that cannot be: one line each, from the viewer and from the checker."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pyarrow as pa
import pytest
from pyarrow import parquet

from rmfs.cli import main
from rmfs.errors import InputError
from rmfs.measure import load_run

Frame = pd.DataFrame


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runs") / "one"
    settings = ["--set", "scenario.duration_s=120", "--set", "scenario.warmup_s=0"]
    run = ["run", "--layout", "small", "--scenario", "small", "--trace", *settings]
    assert main([*run, "--out", str(folder)]) == 0
    return folder


@pytest.fixture
def run(whole: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(whole, tmp_path / "run"))


def change(path: Path, how: Callable[[Frame], Frame | None]) -> None:
    """Change the rows of a table; the file's own metadata stay."""
    metadata = parquet.read_schema(path).metadata
    frame = parquet.read_table(path).to_pandas()
    new = how(frame)
    table = pa.Table.from_pandas(frame if new is None else new, preserve_index=False)
    parquet.write_table(table.replace_schema_metadata(metadata), path)


def found_safe(run: Path) -> bool:
    try:
        return load_run(run).check().ok
    except InputError:
        return False


def cell(name: str, value: object, row: int = 5) -> Callable[[Frame], Frame]:
    return lambda frame: frame.assign(
        **{name: [value if at == row else old for at, old in enumerate(frame[name])]}
    )


MOTION: dict[str, tuple[Callable[[Frame], Frame | None], str]] = {
    "a robot that is not": (cell("robot", 10), "row 5: robot must be from 0 to 9 (given: 10)"),
    "a place that is not": (cell("to_wp", 10**6), "to_wp must be from"),
    "a negative place": (cell("from_wp", -1), "from_wp must be from"),
    "a kind that is not": (cell("kind", 7), "kind must be from 0 to 6 (given: 7)"),
    "a pod that is not": (cell("pod", 100), "pod must be from -1 to 99 (given: 100)"),
    "a time before the start": (cell("t0_us", -1), "t0_us must be from"),
    "an end before its begin": (cell("t1_us", 0), "ends (t1_us) before it starts"),
    "no heading": (cell("heading0_rad", float("nan")), "heading0_rad: a value is missing"),
    "a heading without end": (cell("heading1_rad", float("inf")), "heading1_rad must be from"),
    "a gap": (lambda frame: frame.drop(index=5), "t0_us must equal t1_us of the robot"),
    "rows turned round": (lambda frame: frame[::-1], "rows are not sorted by robot"),
    "a robot left out": (lambda frame: frame[frame["robot"] != 3], "there are no rows for robot 3"),
    "no rows": (lambda frame: frame[:0], "there are no rows for robot 0"),
    "words for numbers": (lambda frame: frame.astype({"robot": str}), "robot must hold whole num"),
    "a missing number": (
        lambda frame: frame.assign(pod=frame["pod"].astype("Int32").mask(frame["t0_us"] > 0)),
        "a value is missing",
    ),
    "no column": (lambda frame: frame.drop(columns="pod"), "column pod missing"),
}
EVENTS: dict[str, tuple[Callable[[Frame], Frame | None], str]] = {
    "a kind that is not": (cell("kind", "explosion"), "row 5: kind must be one of stock, task"),
    "a time before the start": (cell("time_us", -1), "time_us must be from"),
    "a time after the end": (cell("time_us", 10**12), "time_us must be from"),
    "a time before the row before": (
        lambda frame: frame.assign(time_us=frame["time_us"].to_numpy()[::-1]),
        "time_us is less than in the row before",
    ),
    "a station that is not": (cell("station", 99), "station must be from -1 to 3 (given: 99)"),
    "a SKU that is not": (cell("sku", 100), "sku must be from -1 to 99 (given: 100)"),
    "units below none": (cell("units", -4), "units must be from"),
    "numbers for words": (lambda frame: frame.assign(kind=1), "kind must hold words"),
}
FILES = {"trace.parquet": MOTION, "events.parquet": EVENTS}


@pytest.mark.parametrize(("file", "what"), [(f, what) for f in FILES for what in FILES[f]])
def test_what_cannot_be(file: str, what: str, run: Path, tmp_path: Path, capsys) -> None:
    how, message = FILES[file][what]
    change(run / file, how)
    page = tmp_path / "page.html"
    assert main(["view", str(run), "--export", str(page)]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert f"{run / file}: " in line and message in line
    assert not page.exists()
    if what != "rows turned round":  # rows are sorted by the checker itself
        assert not found_safe(run) or file == "events.parquet"


def test_what_can_be(run: Path, tmp_path: Path) -> None:
    """What nobody has touched is shown and proven safe; a robot in another's place is neither."""
    assert load_run(run).check().ok
    change(run / "trace.parquet", lambda frame: frame)
    change(run / "events.parquet", lambda frame: frame)
    assert main(["view", str(run), "--export", str(tmp_path / "page.html")]) == 0


TOLD: dict[str, tuple[object, str]] = {
    "layout": ("small", "layout: Input should be"),
    "scenario": ({"name": 3}, "scenario.name"),
    "seed": (-1, "seed"),
    "warmup_s": ("0", "warmup_s"),
    "duration_s": (1e300, "duration_s"),
    "slow_robots": ([[1, 2]], "slow_robots.0"),
    "measures": ([{"columns": [{"name": "x"}]}], "measures.0.columns.0"),
}


@pytest.mark.parametrize("key", TOLD)
def test_what_a_run_cannot_tell_of_itself(key: str, run: Path, capsys) -> None:
    value, message = TOLD[key]
    told = json.loads((run / "run.json").read_text())
    (run / "run.json").write_text(json.dumps({**told, key: value}))
    assert main(["report", str(run)]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "run.json: corrupted" in line and message in line
    assert not (run / "report.html").exists()
