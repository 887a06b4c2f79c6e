"""A small experiment from its design to its table: run, interrupted, resumed, compared."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import experiments

DESIGN = Path(__file__).resolve().parents[2] / "experiments" / "designs" / "smoke.toml"


def rmfs(*arguments):
    command = [sys.executable, "-m", "rmfs", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def table(folder):
    done = rmfs("experiment", "table", DESIGN)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The folder of an experiment that nobody interrupted."""
    folder = tmp_path_factory.mktemp("whole")
    os.chdir(folder)
    done = rmfs("experiment", "run", DESIGN, "--jobs", "2")
    assert done.returncode == 0, done.stderr
    return folder


def test_one_row_a_run(whole):
    """Four arms, two seeds; the same seed meets the same number of SKUs and pods in every arm."""
    frame = experiments.load(whole / "results" / "smoke")
    assert len(frame) == 8
    assert (frame["units_picked"] > 0).all()


def test_finished_runs_are_not_repeated(whole, monkeypatch):
    monkeypatch.chdir(whole)
    files = sorted((whole / "results/smoke/runs").glob("*.parquet"))
    before = [file.stat().st_mtime_ns for file in files]
    assert rmfs("experiment", "run", DESIGN).returncode == 0
    assert [file.stat().st_mtime_ns for file in files] == before


def test_interrupted_and_resumed_gives_the_same_table(whole, tmp_path, monkeypatch):
    """SIGINT of the driver in the middle; the rest is done by a second call."""
    monkeypatch.chdir(whole)
    expected = table(whole)
    monkeypatch.chdir(tmp_path)
    driver = subprocess.Popen(
        [sys.executable, "-m", "rmfs", "experiment", "run", str(DESIGN), "--jobs", "1"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    for _ in range(600):
        if list(tmp_path.glob("results/smoke/runs/*.parquet")):
            break
        time.sleep(0.05)
    driver.send_signal(signal.SIGINT)
    driver.wait(timeout=60)
    assert rmfs("experiment", "run", DESIGN).returncode == 0
    assert table(tmp_path) == expected


def test_a_design_with_problems_is_refused(tmp_path, monkeypatch):
    """Every problem is named, nothing is written."""
    monkeypatch.chdir(tmp_path)
    text = DESIGN.read_text("utf-8").replace("layout.robots", "layout.robtos")
    (tmp_path / "bad.toml").write_text(text)
    done = rmfs("experiment", "run", "bad.toml")
    assert done.returncode == 2
    assert "robtos" in done.stderr
    assert not (tmp_path / "results").exists()
