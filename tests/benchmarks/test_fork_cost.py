"""What a fork costs, in processor time, at 8, 32 and 128 robots."""

from __future__ import annotations

from time import process_time

import pytest

import rmfs

SITES = {
    8: ("small", "small", {"layout.robots": 8}),
    32: ("study-32", "default", {"layout.pod_capacity": 500.0}),
    128: ("study-128", "default", {"layout.pod_capacity": 500.0}),
}


@pytest.mark.benchmark(group="fork", timer=process_time)
@pytest.mark.parametrize("robots", SITES)
def test_fork(benchmark, robots: int) -> None:
    layout, scenario, given = SITES[robots]
    run = rmfs.Simulation(layout, scenario, seed=1, set={**given, "scenario.duration_s": 3600})
    run.run_until(600.0)
    fork = benchmark.pedantic(run.fork, rounds=15, warmup_rounds=1)
    assert len(fork.world.robots) == robots
