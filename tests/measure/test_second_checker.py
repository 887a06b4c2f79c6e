"""Two checkers that share no code say the same: of lawful traces, and of spoilt ones."""

from __future__ import annotations

import ast
import shutil
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
import second_checker
from mutations import started_earlier, swapped, waits
from pyarrow import parquet

from rmfs import simulate
from rmfs.measure import load_run

Trace = dict[str, np.ndarray]


@pytest.fixture(scope="module", params=["one tier", "three tiers"])
def folder(request, tmp_path_factory: pytest.TempPathFactory) -> Path:
    given = {"scenario.duration_s": 600, "scenario.warmup_s": 0}
    if request.param == "one tier":
        run = simulate("small", "small-arrivals", set=given, seed=4, trace=True)
    else:
        slow = {"slow": {"every_s": 20, "lasting_s": 60, "speed_share": 0.5}}
        rule = {"name": "random", "prefer_same_tier": False}
        more = {"layout.robots": 8, "controllers.psa": rule, "scenario.disturbances": slow}
        run = simulate("study-tiers", "pp-minimal", set={**given, **more}, seed=4, trace=True)
        assert run.slow_robots
        assert (run.trace["kind"] == second_checker.RIDE).any()
    return run.save(tmp_path_factory.mktemp("runs") / "run").path


def test_it_knows_nothing_of_the_program() -> None:
    tree = ast.parse(Path(second_checker.__file__).read_text("utf-8"))
    for node in ast.walk(tree):
        names = [node.module or ""] if isinstance(node, ast.ImportFrom) else []
        names += [one.name for one in node.names] if isinstance(node, ast.Import) else []
        for name in names:
            root = name.split(".")[0]
            assert root in ("numpy", "pyarrow") or root in sys.stdlib_module_names


def test_a_lawful_trace(folder: Path) -> None:
    assert second_checker.problems(folder) == []
    assert load_run(folder).check().ok


def both(folder: Path, trace: Trace, tmp_path: Path) -> tuple[bool, bool]:
    """Whether each of the two finds something wrong."""
    target = tmp_path / "run"
    shutil.rmtree(target, ignore_errors=True)
    shutil.copytree(folder, target)
    metadata = parquet.read_schema(target / "trace.parquet").metadata
    table = pa.Table.from_pandas(pd.DataFrame(trace), preserve_index=False)
    parquet.write_table(table.replace_schema_metadata(metadata), target / "trace.parquet")
    return bool(second_checker.problems(target)), not load_run(target).check().ok


def trace_of(folder: Path) -> Trace:
    return {str(name): column.to_numpy() for name, column in load_run(folder).trace.items()}


@pytest.mark.parametrize("by_s", [0.3, 2.0])
def test_starts_too_early_are_judged_alike(by_s: float, folder: Path, tmp_path: Path) -> None:
    trace = trace_of(folder)
    rows = np.random.default_rng(7).permutation(waits(trace, by_s + 0.1))[:6]
    verdicts = [both(folder, started_earlier(trace, int(row), by_s), tmp_path) for row in rows]
    assert [one for one, _ in verdicts] == [other for _, other in verdicts]


def changed(trace: Trace, name: str, row: int, value: float) -> Trace:
    columns = {one: column.copy() for one, column in trace.items()}
    columns[name][row] = value
    return columns


def spoilt(trace: Trace, what: str) -> Trace:
    kind, pod = trace["kind"], trace["pod"]
    run = int(np.flatnonzero(kind == second_checker.RUN)[5])
    match what:
        case "too fast":
            columns = changed(trace, "t1_us", run, trace["t1_us"][run] - 100_000)
            columns["t0_us"][run + 1] -= 100_000
            return columns
        case "through the racks":
            columns = changed(trace, "to_wp", run, 0)
            columns["from_wp"][run + 1] = 0
            return columns
        case "another heading":
            return changed(trace, "heading0_rad", run, trace["heading0_rad"][run] + 0.1)
        case "another pod":
            lift = int(np.flatnonzero(kind == second_checker.LIFT)[0])
            return changed(trace, "pod", lift, (pod[lift] + 1) % (pod.max() + 1))
        case "a pod dropped under way":
            loaded = int(np.flatnonzero((kind == second_checker.RUN) & (pod >= 0))[3])
            return changed(trace, "pod", loaded, -1)
        case "two robots exchanged":
            return swapped(trace, 1, 2, 300.0)
    raise AssertionError(what)


@pytest.mark.parametrize(
    "what",
    [
        *("too fast", "through the racks", "another heading", "another pod"),
        *("a pod dropped under way", "two robots exchanged"),
    ],
)
def test_both_find_what_is_spoilt(what: str, folder: Path, tmp_path: Path) -> None:
    assert both(folder, spoilt(trace_of(folder), what), tmp_path) == (True, True)
