"""Estimates the duration of an experiment from finished runs, or from short pilot runs."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rmfs.errors import InputError
from rmfs.experiments.design import resolve
from rmfs.measure.footprints import some_tables
from rmfs.simulation.loop import StalledError
from rmfs.simulation.run import simulate

if TYPE_CHECKING:
    from rmfs.experiments.design.planning import Plan
    from rmfs.experiments.running.job import Job
    from rmfs.experiments.store import Store

ARMS = 4
"""Number of arms that get a pilot run, evenly spread over the design."""

SHARE = 0.05
"""Share of a run's duration that a pilot run simulates."""

LEAST_S, MOST_S = 600.0, 7200.0
"""Minimum and maximum simulated time of a pilot run, in s."""

ENOUGH = 8
"""Number of finished runs that makes pilot runs unnecessary."""


@dataclass(frozen=True)
class Estimate:
    """Estimated duration of runs.

    Attributes
    ----------
    run_s
        Mean wall time of a run, in s.
    longest_s
        Mean wall time of a run of the slowest arm, in s.
    runs
        Number of runs on which the estimate is based.
    source
        Origin of the estimate, as text for messages.
    """

    run_s: float
    longest_s: float
    runs: int
    source: str

    def total_s(self, runs: int, processes: int) -> float:
        """Return the wall time in s that `runs` runs take with `processes` parallel processes."""
        return self.run_s * runs / max(1, min(processes, runs))


def estimate(plan: Plan, store: Store) -> Estimate | None:
    """Estimate the duration of a run; None if pilot runs are needed and none of them succeeds."""
    from rmfs.experiments.results import assigned

    known = assigned(plan, store)
    if len(known) >= ENOUGH:
        by_arm = known.groupby("arm")["elapsed_s"].mean()
        return Estimate(
            float(by_arm.mean()), float(by_arm.max()), len(known), f"{len(known)} finished runs"
        )
    chosen = np.unique(np.linspace(0, len(plan.arms) - 1, ARMS).round().astype(int))
    replication = plan.design.seeds_of(plan.design.all_stages()[0])[0]
    times: list[float] = []
    for number in chosen:
        try:
            times.append(_tried(plan.job(plan.arms[number], replication)))
        except (InputError, StalledError):
            continue  # the run itself will tell
    if not times:
        return None
    return Estimate(
        float(np.mean(times)), max(times), len(times), f"{len(times)} short runs of as many arms"
    )


def _tried(job: Job) -> float:
    """Simulate the beginning of a run; return the estimated wall time of the whole run, in s."""
    begun = time.perf_counter()
    inputs = resolve.load(job.inputs, job.overrides)
    whole_s = inputs.scenario.warmup_s + inputs.scenario.duration_s
    part_s = min(whole_s, max(LEAST_S, min(MOST_S, SHARE * whole_s)))
    overrides = [
        *job.overrides,
        (["scenario", "warmup_s"], 0.0),
        (["scenario", "duration_s"], part_s),
    ]
    scenario = resolve.load(job.inputs, overrides).scenario
    run = simulate(
        inputs.layout,
        scenario,
        inputs.controllers,
        seed=job.seed,
        pacing=job.pacing,
        overrides=resolve.of_pacing(job.overrides),
        allow_not_well_formed=job.allow_not_well_formed,
        measures=job.measures,
    )
    some_tables(run, job.keep)
    around_s = time.perf_counter() - begun - run.wall_s
    return around_s + run.wall_s * whole_s / part_s
