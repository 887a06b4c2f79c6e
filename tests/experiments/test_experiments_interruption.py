"""Real runs, killed in the middle and resumed: the same table, byte for byte."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import psutil
import pytest

from rmfs import experiments
from rmfs.experiments.results import to_csv

FACTORS = {"layout.robots": [8, 16], "controllers.psa": ["nearest", "random"]}


PATIENCE_S = 600.0
"""When something hangs; a busy machine may take minutes to do what takes seconds."""


def command(path: Path, out: Path, *more: str) -> list[str]:
    given = ["experiment", "run", str(path), "--out", str(out), *more]
    return [sys.executable, "-m", "rmfs.cli", *given]


def finished(out: Path) -> int:
    return len(list((out / "runs").glob("[!.]*.parquet")))


def workers(driver: psutil.Process) -> list[psutil.Process]:
    """The processes that simulate: grandchildren of the driver, children of the fork server."""
    try:
        return [grandchild for child in driver.children() for grandchild in child.children()]
    except psutil.NoSuchProcess:
        return []


def until(condition, what: str):
    end = time.monotonic() + PATIENCE_S
    while time.monotonic() < end:
        if found := condition():
            return found
        time.sleep(0.005)
    raise AssertionError(f"{what}: not within {PATIENCE_S} s")


def interrupted(path: Path, out: Path, more: list[str], total: int) -> tuple[int, str]:
    """Start the experiment, kill a worker, interrupt the driver; return its session and words."""
    words = path.with_suffix(".stderr")
    with (
        words.open("w") as stream,
        subprocess.Popen(
            command(path, out, *more),
            stderr=stream,
            start_new_session=True,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        ) as driver,
    ):
        process = psutil.Process(driver.pid)
        try:
            until(lambda: finished(out) >= 1, "a first run")
            until(lambda: killed(process, words), "the end of a killed worker")
            until(lambda: finished(out) >= min(3, total // 3), "more runs")
            driver.send_signal(signal.SIGINT)
            driver.wait(timeout=PATIENCE_S)
        finally:
            driver.kill()
    assert driver.returncode == 130, words.read_text()
    assert finished(out) < total
    return driver.pid, words.read_text()


def killed(driver: psutil.Process, words: Path) -> bool:
    """Kill a worker; whether the driver has told of one (it may have done its run just before)."""
    if "killed by SIGKILL; begun again" in words.read_text():
        return True
    with suppress(psutil.NoSuchProcess, IndexError):
        workers(driver)[0].kill()
    time.sleep(0.2)
    return False


def check(path: Path, tmp_path: Path, total: int, jobs: int = 2) -> None:
    out, whole = tmp_path / "out", tmp_path / "whole"
    session, told = interrupted(path, out, ["--jobs", str(jobs)], total)
    assert told.splitlines()[-1] == "rmfs: interrupted"
    assert "Traceback" not in told
    until(lambda: not left_over(session), "the end of all workers")
    before = finished(out)
    done = experiments.run(experiments.plan(path), out, processes=jobs)
    assert (done.ran, done.finished, done.failed) == (total - before, total, [])
    experiments.run(experiments.plan(path), whole, processes=jobs)
    for folder in (out, whole):
        to_csv(experiments.load(folder), folder / "table.csv")
    assert (out / "table.csv").read_bytes() == (whole / "table.csv").read_bytes()
    assert len((out / "table.csv").read_text().splitlines()) == total + 1


def left_over(session: int) -> list[int]:
    """Processes of the driver's session that still run."""
    found = []
    for pid in psutil.pids():
        with suppress(ProcessLookupError):
            if os.getsid(pid) == session:
                found.append(pid)
    return found


def test_a_killed_experiment_is_resumed(design, tmp_path):
    base = {"layout": "basic", "scenario": "basic", "controllers": "default"}
    path = design(base={**base, "scenario.duration_s": 900}, factors=FACTORS, seeds=[1, 2])
    check(path, tmp_path, 8)


@pytest.mark.slow
def test_a_study_of_24_arms_is_killed_and_resumed(design, tmp_path):
    factors = {
        "layout.robots": [8, 12, 16, 20],
        "controllers.psa": ["nearest", "random"],
        "controllers.poa": ["pod-match", "random"],
        "controllers.rps": ["emptiest", "random"],
    }
    base = {"layout": "basic", "scenario": "basic", "controllers": "default"}
    path = design(
        base={**base, "scenario.duration_s": 3600},
        factors=factors,
        exclude=[{"layout.robots": 20, "controllers.poa": ["pod-match", "random"]}],
        seeds=[1, 2, 3, 4, 5],
    )
    check(path, tmp_path, 120)
