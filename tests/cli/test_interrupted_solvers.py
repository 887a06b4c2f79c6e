"""Ctrl-C in runs that ask CP-SAT, whose solves could take the signal for themselves."""

import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from ortools.sat.python import cp_model

from rmfs.cli import main
from rmfs.solvers.models.backends import cp_sat
from rmfs.solvers.models.solution import NO_LIMITS

ROOT = Path(__file__).resolve().parents[2]

TELLING = """
import sys
from ortools.sat.python import cp_model
from rmfs.cli import main
solve, done = cp_model.CpSolver.solve, []
def told(self, *given):
    status = solve(self, *given)
    done.append(status)
    print("solved", len(done), flush=True)
    return status
cp_model.CpSolver.solve = told
sys.exit(main(sys.argv[1:]))
"""
"""Says of each solve that it has ended."""

RUN = ["run", "--layout", "small", "--scenario", "small", "--controllers", "pile-on-split"]


def started(out, *more):
    return subprocess.Popen(
        [sys.executable, "-c", TELLING, *RUN, "--out", out, *more],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )


def wait_for(process, solves):
    for line in process.stdout:
        if line == f"solved {solves}\n":
            return
    raise AssertionError(process.stderr.read())


@pytest.mark.parametrize(("solves", "later_s"), [(1, 0.0), (1, 0.3), (5, 0.01), (30, 0.1)])
def test_ctrl_c_after_a_solve_ends_with_130_and_leaves_nothing(
    tmp_path, monkeypatch, solves, later_s
):
    monkeypatch.chdir(tmp_path)
    process = started("deep/run", "--set", "scenario.duration_s=4000000")
    try:
        wait_for(process, solves)
        time.sleep(later_s)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=20)
    finally:
        process.kill()
    assert process.returncode == 130
    assert errors.splitlines()[-1] == "rmfs: interrupted"
    assert "Traceback" not in errors
    assert list(tmp_path.iterdir()) == []


def test_the_next_run_sweeps_what_a_killed_one_has_left(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    process = started("first", "--set", "scenario.duration_s=4000000")
    wait_for(process, 1)
    process.kill()
    process.communicate()
    assert any(path.name.startswith(".first.partial-") for path in tmp_path.iterdir())
    assert main([*RUN, "--out", "second", "--set", "scenario.duration_s=20"]) == 0
    assert [path.name for path in tmp_path.iterdir()] == ["second"]


def test_ctrl_c_in_a_search_ends_it():
    """A search of minutes: the signal comes after a second, and the answer soon after it."""
    model = cp_model.CpModel()
    draw = [(17 * i * i + 29 * i) % 991 + 7 for i in range(400)]
    use = [[model.new_bool_var("") for _ in range(6)] for _ in draw]
    for row in use:
        model.add(sum(row) <= 1)
    for knapsack in range(6):
        for turn in range(5):
            weights = [(turn + 3) * size % 787 + 5 for size in draw]
            model.add(sum(w * row[knapsack] for w, row in zip(weights, use, strict=True)) <= 9001)
    model.maximize(sum(size * sum(row) for size, row in zip(draw, use, strict=True)))
    solver = cp_model.CpSolver()
    cp_sat.configure(solver, NO_LIMITS, 0)
    solver.parameters.max_time_in_seconds = 60.0
    begun = time.monotonic()
    timer = threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        cp_sat.run(solver, model)
    assert time.monotonic() - begun < 30
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
