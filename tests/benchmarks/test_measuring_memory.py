"""How much memory a long run with all measures needs."""

from __future__ import annotations

import subprocess
import sys

import pytest

PROGRAM = """
import sys
from pathlib import Path
from rmfs.measure import write_run
from rmfs.measure.memory import peak_rss_mb
from rmfs.simulation.run import simulate

duration_s, target = float(sys.argv[1]), Path(sys.argv[2])
overrides = [(["scenario", "warmup_s"], 0), (["scenario", "duration_s"], duration_s)]
write_run(simulate("study-128", "pp-minimal", "random", seed=1, overrides=overrides), target)
print(peak_rss_mb())
"""

LIMIT_MB = 1000.0
TWO_DAYS_S = 172_800.0


def peak_mb(duration_s: float, folder) -> float:
    """Peak memory of a process that simulates and writes the tables, in MB."""
    arguments = [sys.executable, "-c", PROGRAM, str(duration_s), str(folder / "run")]
    done = subprocess.run(arguments, capture_output=True, text=True, check=True)
    return float(done.stdout)


@pytest.mark.slow
def test_two_days_with_128_robots_stay_under_1_gb(tmp_path):
    assert peak_mb(TWO_DAYS_S, tmp_path) < LIMIT_MB
