"""What measuring costs in a real run; run with `make bench`."""

from __future__ import annotations

import time

import pytest

from rmfs import control, layout, scenario
from rmfs.measure import Recorder, tables
from rmfs.simulation.kernel import Kernel

pytestmark = pytest.mark.benchmark

DURATION_S = 28_800.0


def simulated(recorder: Recorder | None) -> float:
    """Processor time of a run with or without a recorder, in s."""
    run = Kernel(
        layout.load("default"),
        scenario.load("pp-minimal", [(["duration_s"], DURATION_S)]),
        control.load("random"),
        seed=1,
        observers=[] if recorder is None else [recorder],
    )
    begin = time.process_time()
    run.run()
    return time.process_time() - begin


def tabled(recorder: Recorder) -> float:
    """Processor time of making all tables from what a recorder wrote down, in s."""
    begin = time.process_time()
    logs = tables.Logs(recorder)
    for make in tables.MAKERS.values():
        make(logs)
    return time.process_time() - begin


def test_all_tables_together_cost_less_than_15_percent():
    recorders = [Recorder() for _ in range(5)]
    off, on = zip(*((simulated(None), simulated(one)) for one in recorders), strict=True)
    made = min(tabled(one) for one in recorders)
    print(f"off {min(off):.3f} s, on {min(on):.3f} s, tables {made:.3f} s")
    assert min(on) + made < 1.15 * min(off)
