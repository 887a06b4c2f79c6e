"""The command line with the real simulation: errors of every part, repeatability, interruption."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest

from rmfs.cli import main
from rmfs.measure import load_run
from rmfs.measure.dictionary import TABLES, reproducible

SHORT = ["run", "--layout", "basic", "--scenario", "basic", "--set", "scenario.duration_s=300"]
ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_run_is_safe_and_writes_everything(capsys):
    assert main([*SHORT, "--check", "--trace"]) == 0
    run = load_run(Path("results/basic-basic-default-scenario.duration_s=300-seed0"))
    assert run.footprint["collisions"] == 0
    assert run.footprint["units_picked"] > 0
    assert len(run.trace) > 500
    assert run.parameters["overrides"] == {"scenario.duration_s": 300}
    assert run.parameters["scenario"]["parameters"]["duration_s"] == 300
    assert run.parameters["layout"]["parameters"]["robots"] == 16
    for name in TABLES:
        # no optimisers, no files of orders, no packing, no pickers, and planning takes no time
        empty = name in (
            *("answers", "order_lines", "bundle_lines", "parcels", "totes", "pickers", "plans"),
        )
        assert bool(len(run.table(name))) != empty, name
    assert "orders completed" in capsys.readouterr().out


def test_the_same_seed_gives_the_same_bytes():
    for name in ("one", "other"):
        assert main([*SHORT, "--seed", "3", "--out", name]) == 0
    for table in TABLES:
        columns = reproducible(table)
        one, other = (load_run(Path(name)).table(table)[columns] for name in ("one", "other"))
        assert one.to_csv(index=False) == other.to_csv(index=False), table


def test_another_seed_gives_another_run():
    for seed in ("3", "4"):
        assert main([*SHORT, "--seed", seed, "--out", seed]) == 0
    orders = [load_run(Path(seed)).table("orders") for seed in ("3", "4")]
    assert not orders[0].equals(orders[1])


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ("--layout nowhere.toml", "nowhere.toml: no such file"),
        ("--layout defalt", "did you mean default?"),
        ("--scenario missing", "shipped:"),
        ("--controllers missing", "shipped:"),
        ("--set layout.robts=3", "unknown key robts; did you mean robots?"),
        ("--set scenario.duration_s=long", "duration_s"),
        ("--set controllers.psa.name=neerest", "neerest"),
        ("--set layout.robots=5000", "robots"),
        ("--set robots=16", "must begin with layout., scenario., controllers. or pacing."),
        ("--pacing fast", "valid: instant"),
    ],
)
def test_wrong_input_is_one_line_and_leaves_nothing(capsys, folder, arguments, text):
    assert main(["run", *arguments.split()]) == 2
    told = capsys.readouterr()
    assert told.out == ""
    (line,) = told.err.splitlines()
    assert line.startswith("rmfs: ")
    assert text in line
    assert list(folder.iterdir()) == []


def test_a_table_that_is_no_toml_is_named(capsys, folder):
    Path("broken.toml").write_text("robots = = 3")
    assert main(["run", "--layout", "broken.toml"]) == 2
    assert "broken.toml: not valid TOML" in capsys.readouterr().err


@pytest.mark.skipif(os.name == "nt", reason="signals are a POSIX matter")
@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_ends_with_130_and_leaves_nothing(folder, sent):
    arguments = ["-m", "rmfs", "run", "--set", "scenario.duration_s=4000000", "--out", "deep/run"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    process = subprocess.Popen(
        [sys.executable, *arguments], stderr=subprocess.PIPE, text=True, env=environment
    )
    try:
        assert process.stderr is not None
        assert "simulating" in process.stderr.readline()
        time.sleep(0.5)
        process.send_signal(sent)
        _, errors = process.communicate(timeout=20)
    finally:
        process.kill()
    assert process.returncode == 130
    assert errors.splitlines() == ["rmfs: interrupted"]
    assert list(folder.iterdir()) == []


def test_figures_can_be_worked_out_from_the_tables():
    """The footprint again, from the written tables alone."""
    assert main([*SHORT, "--set", "scenario.warmup_s=100", "--out", "run"]) == 0
    run = load_run(Path("run"))
    footprint = run.footprint
    orders, stations = run.table("orders"), run.table("stations")
    trips, robots = run.table("trips"), run.table("robots")
    series, skus, pods = run.table("series"), run.table("skus"), run.table("pods")
    done = orders[orders["completed_s"].notna()]
    begin, end = 100.0, 400.0
    assert footprint["orders_completed"] == len(done) == stations["orders_completed"].sum()
    for name in ("units_picked", "lines_picked", "bundles_stored"):
        total = footprint[name]
        assert total == stations[name].sum() == series[name].sum() == skus[name].sum()
    assert footprint["units_picked"] == pods["units_picked"].sum() == robots["units_picked"].sum()
    assert footprint["units_per_h"] == pytest.approx(footprint["units_picked"] * 12)
    assert (
        footprint["order_turnover_median_s"] == (done["completed_s"] - done["created_s"]).median()
    )
    picks = stations[stations["kind"] == "pick"]
    assert footprint["pick_station_idle_share"] == pytest.approx(
        1 - picks["busy_s"].sum() / (len(picks) * 300)
    )
    assert footprint["trips"] == len(trips)
    assert footprint["trip_time_mean_s"] == pytest.approx(
        (trips["end_s"] - trips["start_s"]).mean()
    )
    assert footprint["distance_m"] == pytest.approx(robots["distance_m"].sum())
    assert footprint["distance_m"] == pytest.approx(series["distance_m"].sum())
    waiting = orders["assigned_s"].fillna(end).clip(begin, end) - orders["created_s"].clip(begin)
    assert footprint["backlog_orders_mean"] == pytest.approx(waiting.sum() / 300)


@pytest.mark.parametrize("warmup_s", [0, 100])
def test_the_robots_times_add_up_to_the_measured_time(warmup_s):
    assert main([*SHORT, "--set", f"scenario.warmup_s={warmup_s}", "--out", "run"]) == 0
    run = load_run(Path("run"))
    states = ("moving", "turning", "waiting", "served", "transfer", "riding", "idle")
    together = sum(run.table("robots")[f"{state}_s"] for state in states)
    assert together.to_numpy() == pytest.approx(300.0)
    assert (run.table("trips")["distance_m"] >= 0).all()


def test_stock_at_the_end_is_what_the_world_holds():
    from rmfs.simulation.run import simulate

    overrides = [(["scenario", "duration_s"], 300)]
    run = simulate("basic", "basic", "default", seed=1, overrides=overrides)
    inventory = run.world.inventory
    share = inventory.stored_space / inventory.total_capacity
    assert run.series["inventory_share"].iloc[-1] == pytest.approx(share, abs=1e-12)
    assert run.footprint["units_picked"] == run.world.units_picked
    assert run.footprint["orders_completed"] == run.world.orders_completed
    assert isinstance(run.decisions, pd.DataFrame)


def test_recorded_streams_replay_the_run(tmp_path):
    short = ["--set", "scenario.warmup_s=0", "--set", "scenario.duration_s=600", "--seed", "4"]
    first, again = tmp_path / "first", tmp_path / "again"
    streams = tmp_path / "streams"
    assert main(["run", *short, "--out", str(first), "--record", str(streams)]) == 0
    replay = [f'scenario.demand={{mode="stream",file="{streams / "orders.csv"}"}}']
    replay += [f'scenario.replenishment={{mode="stream",file="{streams / "bundles.csv"}"}}']
    options = [word for key in replay for word in ("--set", key)]
    assert main(["run", *short, *options, "--out", str(again)]) == 0
    one, other = (load_run(folder).table("orders") for folder in (first, again))
    columns = ["order", "lines", "units", "created_s", "due_s"]
    assert one[columns].equals(other[columns])
    assert len(one) > 100


def test_a_file_of_rawsimo_says_what_is_different(tmp_path, capsys):
    controllers = tmp_path / "far.xconf"
    controllers.write_text(
        '<ControlConfiguration xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">'
        "<Name>far</Name><Old/>"
        '<PathPlanningConfig xsi:type="FARPathPlanningConfiguration">'
        "<RuntimeLimitPerAgent>0.1</RuntimeLimitPerAgent></PathPlanningConfig>"
        "</ControlConfiguration>"
    )
    short = ["--set", "scenario.warmup_s=0", "--set", "scenario.duration_s=60"]
    arguments = ["run", "--controllers", str(controllers), *short, "--out", str(tmp_path / "run")]
    assert main(arguments) == 0
    told = capsys.readouterr().err
    assert "Old unknown, left out" in told
    assert "rmfs limits searches by counted work" in told
    assert load_run(tmp_path / "run").footprint["controllers"] == "far"
