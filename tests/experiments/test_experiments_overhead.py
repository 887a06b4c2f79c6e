"""What the harness costs is measured by a real experiment of runs that sleep."""

from __future__ import annotations

import pytest

from experiments.overhead import Cost, main, measure
from rmfs.errors import InputError


def test_overhead_is_what_is_beyond_the_runs_themselves():
    # seven runs, two at a time: four rounds of 10 s
    cost = Cost(runs=7, jobs=2, asleep_s=10.0, wall_s=42.0, cpu_s=0.7, memory_mb=[100.0, 101.0])
    assert cost.overhead == pytest.approx(0.05)
    assert "overhead: 5.00% of the time of the runs" in str(cost)
    assert "processor time: 100 ms a run" in str(cost)
    assert "100 MB after a tenth of the runs, 101 MB at the end" in str(cost)


@pytest.mark.slow
def test_sleeping_runs_go_the_whole_way():
    cost = measure(5, 0.2, 5)
    assert len(cost.memory_mb) == 5 and min(cost.memory_mb) > 10
    assert cost.wall_s > 0.2 and cost.cpu_s > 0


def test_runs_must_be_shared_equally_by_the_arms(capsys):
    with pytest.raises(InputError, match="must be a multiple of 5"):
        measure(7, 1.0, 1)
    assert main(["--runs", "7"]) == 2
    assert "--runs 7: must be a multiple of 5" in capsys.readouterr().err
