"""What the harness costs is measured by real experiments, of runs that simulate or sleep."""

from __future__ import annotations

import pandas as pd
import pytest

from rmfs.errors import InputError
from tests.tools.overhead import Cost, CostAsleep, gaps, main, measure, measure_asleep


def test_overhead_is_what_is_not_simulation():
    # two cores for 42 s, of which 80 s were simulation
    cost = Cost(
        8,
        2,
        wall_s=42.0,
        simulating_s=[10.0] * 8,
        gaps_s=[],
        simulating_cpu_s=40.0,
        harness_cpu_s=1.0,
        memory_mb=[99.0, 120.0, 101.0],
    )
    assert cost.overhead == pytest.approx(0.05)
    assert "overhead: 5.00% of the time of the simulations" in str(cost)
    assert "in processor time: 1.0 s beside 40.0 s of simulation, 2.50%" in str(cost)
    assert "99 MB after a tenth of the time, 120 MB at most, 101 MB at the end" in str(cost)


def test_what_each_run_costs_is_told_apart_from_the_start():
    # the first run ends after 2 + 10 s, each further one 0.1 s late
    gaps_s = [0.1] * 6
    cost = Cost(
        7,
        1,
        wall_s=72.6,
        simulating_s=[10.0] * 7,
        gaps_s=gaps_s,
        simulating_cpu_s=70.0,
        harness_cpu_s=2.6,
        memory_mb=[1.0],
    )
    assert "of that 2.00 s once, 100 ms a run" in str(cost)
    assert "first third costs 100 ms, one of the last 100 ms" in str(cost)


def test_gaps_are_between_the_ends_of_runs():
    rows = pd.DataFrame(
        {
            "finished": [f"2026-01-01T00:00:{s}+00:00" for s in ("10.000", "20.250", "30.500")],
            "wall_s": [9.0, 10.0, 10.0],
        }
    )
    assert gaps(rows) == pytest.approx([0.25, 0.25])


def test_of_sleeping_runs_the_processor_time_counts():
    cost = CostAsleep(10, 5, asleep_s=2.0, wall_s=9.0, cpu_s=1.0, memory_mb=[50.0])
    assert cost.overhead == pytest.approx(0.05)
    assert "processor time: 1.0 s, 100 ms a run" in str(cost)


@pytest.mark.slow
def test_sleeping_runs_go_the_whole_way():
    cost = measure_asleep(5, 0.2, 5)
    assert len(cost.memory_mb) == 6 and min(cost.memory_mb) > 10
    assert cost.wall_s > 0.2 and cost.cpu_s > 0


@pytest.mark.slow
def test_the_memory_of_the_driver_is_flat_although_it_merges_the_files_of_the_runs():
    cost = measure_asleep(300, 0.02, 4)
    assert max(cost.memory_mb[30:]) < 1.05 * cost.memory_mb[30]


@pytest.mark.slow
def test_real_runs_are_done_by_the_command(tmp_path):
    cost = measure(10, 900.0, 1, tmp_path / "runs", tmp_path / "cost.csv")
    figures = pd.read_csv(tmp_path / "cost.csv", index_col=0)["value"]
    assert figures["runs"] == 10
    assert figures["overhead by the clock, %"] == pytest.approx(100 * cost.overhead)
    assert (tmp_path / "cost.csv.provenance.json").is_file()
    assert len(cost.simulating_s) == 10 and len(cost.gaps_s) == 9
    assert 0 < sum(cost.simulating_s) + sum(cost.gaps_s) < cost.wall_s
    with pytest.raises(InputError, match="holds something already"):
        measure(10, 900.0, 1, tmp_path / "runs")


def test_runs_must_be_shared_equally_by_the_arms(capsys):
    assert main(["--runs", "7"]) == 2
    assert main(["--runs", "7", "--asleep", "1"]) == 2
    assert capsys.readouterr().err.count("--runs 7: must be a multiple of 5") == 2
