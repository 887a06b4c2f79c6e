"""Does `rmfs experiment calibrate` keep its promise? `python -m tests.tools.calibration_coverage`.

On the small site the arrival rate is sought at which a share of orders is on time, again and again,
with seeds of its own each time. The truth is the mean over many further seeds at some rates, joined
by lines; its own error is told, too. Exit code 1 if fewer calibrations than promised are right.
"""

from __future__ import annotations

import argparse
import sys
import time
import warnings
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

import rmfs
from rmfs import layout
from rmfs.experiments.calibration import Goal, calibrate
from rmfs.measure.ended import EndedRun
from rmfs.measure.measures.service import Service

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from rmfs.experiments.calibration import Step
    from rmfs.simulation.result import Run

GIVEN: dict[str, Any] = {
    "scenario.warmup_s": 600,
    "scenario.duration_s": 1200,
    "scenario.demand.initial_orders": 10,
    "scenario.orders.due": {
        "mode": "normal",
        "mean_s": 600.0,
        "sd_s": 200.0,
        "min_s": 200.0,
        "max_s": 1000.0,
    },
    "scenario.stock.initial_share": 0.8,
    "scenario.replenishment": {"mode": "needed", "reorder_below_units": 15},
}
GOAL = Goal(target=0.8, tolerance=0.08, low=120.0, high=400.0)
LAYOUT = layout.load("small", [(["robots"], 6)])
SPACED = 10_000
"""Seeds from one calibration to the next."""


def on_time(rate: float, seeds: Sequence[int]) -> NDArray[np.float64]:
    """Return the on-time share of every seed at an arrival rate, shape (N,)."""
    changes = GIVEN | {"scenario.demand.orders_per_h": rate}
    return np.array(
        [
            _on_time(rmfs.simulate(LAYOUT, "small-arrivals", seed=seed, set=changes))
            for seed in seeds
        ]
    )


def _on_time(run: Run) -> float:
    """Work out this column alone: all of the footprint takes as long as such a short run."""
    measure = next(one for one in run.measures if isinstance(one, Service))
    return float(measure.footprint(EndedRun(run))["on_time_share"])


def quiet(_step: Step) -> None:
    """Say nothing of a step."""


def main(arguments: list[str] | None = None) -> int:
    """Calibrate again and again, and count."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repetitions", type=int, default=100, help="default: 100")
    parser.add_argument("--seeds", type=int, default=200, help="of the truth (default: 200)")
    parser.add_argument("--rates", type=int, default=5, help="of the truth (default: 5)")
    given = parser.parse_args(arguments)
    warnings.simplefilter("ignore")
    begun = time.process_time()
    found = []
    for repetition in range(1, given.repetitions + 1):
        made = calibrate(replace(GOAL, first_seed=SPACED * repetition), on_time, quiet)
        found.append(made)
        print(f"{repetition}: {made.level:g} after {made.runs} runs", flush=True)
    levels = np.array([made.level for made in found])
    spent_s = time.process_time() - begun
    rates = np.linspace(levels.min(), levels.max(), given.rates)
    values = [on_time(rate, range(given.seeds)) for rate in rates]
    truth = np.interp(levels, rates, [one.mean() for one in values])
    off = np.abs(truth - GOAL.target)
    right = int((off <= GOAL.tolerance).sum())
    errors = [one.std(ddof=1) / np.sqrt(len(one)) for one in values]
    for rate, one, error in zip(rates, values, errors, strict=True):
        print(f"truth at {rate:.1f}: {one.mean():.4f} +- {1.96 * error:.4f} ({len(one)} seeds)")
    print(
        f"{right} of {len(found)} within {GOAL.tolerance:g} of {GOAL.target:g} "
        f"(promised: 95 %); {off.mean():.3f} off in the mean, {off.max():.3f} at most; "
        f"{np.mean([made.runs for made in found]):.0f} runs each; {spent_s:.0f} s of processor "
        f"time for all, {time.process_time() - begun - spent_s:.0f} s for the truth"
    )
    return int(right < 0.95 * len(found))


if __name__ == "__main__":
    sys.exit(main())
