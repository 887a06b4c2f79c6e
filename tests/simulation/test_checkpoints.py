"""A run that is killed goes on from its checkpoint to the same end."""

from __future__ import annotations

import pickle
import signal
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest
from test_stepping import simulation, take, told

import rmfs
from rmfs.errors import InputError
from rmfs.measure import EventLog
from rmfs.measure.dictionary import reproducible
from rmfs.observer import Observer
from rmfs.scenario import StreamRecorder
from rmfs.simulation import saving
from rmfs.simulation.checkpoints import Checkpoints, resumed

SMALL = {"scenario.duration_s": 900}


def small(seed: int = 2, controllers: str = "pile-on") -> rmfs.Simulation:
    return rmfs.Simulation("small", "small", controllers, seed=seed, set=SMALL, pacing="work")


def numbers(run: rmfs.Run) -> pd.Series:
    return run.footprint[reproducible("footprint")]


def test_a_saved_run_goes_on_to_the_same_end(tmp_path: Path) -> None:
    run = small()
    run.run_until(432.1)
    run.save(tmp_path / "run.checkpoint")
    again = rmfs.Simulation.load(tmp_path / "run.checkpoint")
    run.run()
    again.run()
    pd.testing.assert_series_equal(numbers(again.result()), numbers(run.result()))


def test_a_decision_that_waits_is_saved(tmp_path: Path) -> None:
    run = simulation("pps")
    for _ in range(8):
        take(run.step())
    pending = run.step()
    run.save(str(tmp_path / "file"))
    again = rmfs.Simulation.load(str(tmp_path / "file"))
    assert repr(again.decision) == repr(pending)
    for one in (run, again):
        while (decision := one.step()) is not None:
            take(decision)
    assert told(again) == told(run)


def test_checkpoints_are_left_on_the_way_and_removed_at_the_end(tmp_path: Path) -> None:
    file, seen = tmp_path / "file", []
    run = small()

    def look(now_s: float, end_s: float) -> None:
        seen.append((now_s, file.exists()))

    Checkpoints(file, 250.0)(run, look)
    assert [exists for _, exists in seen] == [False, True, True, True]
    assert not file.exists()
    plain = small()
    plain.run()
    pd.testing.assert_series_equal(numbers(plain.result()), numbers(run.result()))


def test_other_inputs_are_refused(tmp_path: Path) -> None:
    run = small()
    run.run_until(100.0)
    run.save(str(tmp_path / "file"))
    with pytest.raises(InputError, match="belongs to a run with another seed;"):
        resumed(tmp_path / "file", small(seed=3))
    with pytest.raises(InputError, match="belongs to a run with another controllers;"):
        resumed(tmp_path / "file", small(controllers="hadgs"))
    assert resumed(tmp_path / "file", small()).now_s == 100.0


def test_a_replay_is_resumed(tmp_path: Path) -> None:
    recorded = small()
    recorded.run()
    recorded.result().save(tmp_path / "run")

    def replay(seed: int = 2) -> rmfs.Simulation:
        replayed = f"replay={tmp_path / 'run'}"
        return rmfs.Simulation("small", "small", "pile-on", seed=seed, set=SMALL, pacing=replayed)

    killed = replay()
    killed.run_until(432.1)
    killed.save(tmp_path / "file")
    again = resumed(tmp_path / "file", replay())
    again.run()
    pd.testing.assert_series_equal(numbers(again.result()), numbers(recorded.result()))
    with pytest.raises(InputError, match="belongs to a run with another pacing;"):
        resumed(tmp_path / "file", small())


class Mine(rmfs.Measure):
    columns = (rmfs.Column("mine", "int64", "", "Nothing"),)


@pytest.mark.parametrize(
    ("saved", "resumed_with", "told"),
    [
        ({}, {"trace": True}, "choice of trace"),
        ({"trace": True}, {}, "choice of trace"),
        ({}, {"measures": [Mine]}, "choice of measures"),
    ],
)
def test_what_was_not_recorded_until_the_checkpoint_is_refused(
    tmp_path: Path, saved, resumed_with, told
) -> None:
    """At once, not when the run has ended."""
    file = tmp_path / "file"
    rmfs.Simulation("small", "small", set=SMALL, **saved).save(file)
    assert not resumed(file, rmfs.Simulation("small", "small", set=SMALL, **saved)).ended
    with pytest.raises(InputError, match=f"another {told};"):
        resumed(file, rmfs.Simulation("small", "small", set=SMALL, **resumed_with))


@pytest.mark.parametrize(
    "given",
    [{"observers": [Observer()]}, {"events": EventLog()}, {"streams": StreamRecorder()}],
    ids=lambda given: next(iter(given)),
)
def test_a_resumed_run_takes_nothing_that_it_would_not_notify(tmp_path: Path, given) -> None:
    file, begun = tmp_path / "file", rmfs.Simulation("small", "small", set=SMALL, **given)
    begun.run_until(1.0)
    begun.save(file)
    with pytest.raises(InputError, match="takes no observers, events or streams"):
        rmfs.simulate("small", "small", set=SMALL, resume=file, **given)


def test_files_that_are_no_checkpoints_are_refused(tmp_path: Path, monkeypatch) -> None:
    file = tmp_path / "file"
    with pytest.raises(InputError, match="there is no checkpoint to resume from"):
        resumed(file, small())
    for content, reason in [
        (b"", "is not a checkpoint"),
        (b"{}\n", "is not a checkpoint"),
        (pickle.dumps({"a": 1}), "is not a checkpoint"),
        (b'{"format": "rmfs-checkpoint/1", "code": "0"}\n', "damaged"),
    ]:
        file.write_bytes(content)
        with pytest.raises(InputError, match=reason):
            rmfs.Simulation.load(file)
    run = small()
    run.run_until(10.0)
    run.save(file)
    whole = file.read_bytes()
    file.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(InputError, match="damaged"):
        rmfs.Simulation.load(file)
    file.write_bytes(whole)
    monkeypatch.setattr(saving, "code_hash", lambda: "other")
    with pytest.raises(InputError, match="was written by another version"):
        rmfs.Simulation.load(file)


def test_results_come_at_the_end() -> None:
    run = small()
    run.run_until(10.0)
    with pytest.raises(InputError, match="the run is at 10 s of 900 s"):
        run.result()


COMMAND = [
    *(sys.executable, "-m", "rmfs", "run", "--layout", "small", "--scenario", "small-arrivals"),
    *("--controllers", "pile-on", "--pacing", "work", "--set", "scenario.duration_s=1500"),
]


@pytest.mark.slow
@pytest.mark.parametrize("number", range(20))
def test_a_killed_run_goes_on(tmp_path: Path, number: int) -> None:
    """SIGKILL at twenty moments: the same table."""
    whole, killed = tmp_path / "whole", tmp_path / "killed"
    seed = ["--seed", str(number)]
    subprocess.run([*COMMAND, *seed, "--out", whole], check=True, capture_output=True)
    doomed = subprocess.Popen(
        [*COMMAND, *seed, "--out", killed, "--checkpoint-every", "40"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    file = tmp_path / "killed.checkpoint"
    while not file.exists():
        time.sleep(0.01)
    time.sleep(0.07 * number)
    doomed.send_signal(signal.SIGKILL)
    doomed.wait()
    assert not killed.exists()
    again = subprocess.run([*COMMAND, *seed, "--out", killed, "--resume"], capture_output=True)
    assert again.returncode == 0, again.stderr
    columns = reproducible("footprint")
    one, other = (pd.read_csv(folder / "footprint.csv")[columns] for folder in (whole, killed))
    pd.testing.assert_frame_equal(one, other)
    assert not file.exists()
