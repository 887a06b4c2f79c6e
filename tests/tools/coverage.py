"""Do the intervals keep their promise? `python -m tests.tools.coverage` reports it.

A synthetic simulator, whose true means are known, stands in for the warehouse: an arm's result is
its mean plus an effect of the seed that all arms share (common random numbers) plus noise of its
own. Each experiment asks whether the interval covered the truth, or whether the test kept quiet.
"""

from __future__ import annotations

import argparse
import gc
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
import pandas as pd

from rmfs.errors import InputError
from rmfs.experiments.extras import optional
from rmfs.experiments.statistics import against, interval, kim_nelson, narrow_enough
from rmfs.files import write_text

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from rmfs.experiments.statistics.intervals import Method

EXPERIMENTS = 2000
SEEDS = (5, 10, 30)
MEAN = 1000.0
SPREAD = 50.0
"""Standard deviation of a run: 5 % of the mean, half of it shared by all arms of a seed."""

MOST = 400
"""Runs after which a sequential experiment is cut off."""

Shape = Literal["normal", "skewed"]


@dataclass(frozen=True)
class Simulator:
    """A simulator that simulates nothing.

    Attributes
    ----------
    means
        True mean of each arm.
    shape
        Distribution of a run: normal, or a shifted exponential (skewness 2).
    """

    means: tuple[float, ...] = (MEAN,)
    shape: Shape = "normal"

    def runs(self, seeds: int, rng: np.random.Generator) -> NDArray[np.float64]:
        """Return results, (seeds, arms)."""
        shared = self._standard(rng, (seeds, 1))
        own = self._standard(rng, (seeds, len(self.means)))
        return np.asarray(np.array(self.means) + SPREAD * np.sqrt(0.5) * (shared + own))

    def _standard(self, rng: np.random.Generator, size: tuple[int, int]) -> NDArray[np.float64]:
        """Draw with mean 0 and variance 1."""
        if self.shape == "normal":
            return rng.standard_normal(size)
        return rng.standard_exponential(size) - 1.0


def fixed(
    seeds: int, method: Method, experiments: int = EXPERIMENTS, shape: Shape = "normal"
) -> float:
    """Return how often the interval of a fixed number of runs covers the true mean."""
    rng = np.random.default_rng([seeds, experiments])
    simulator = Simulator(shape=shape)
    covered = 0
    for _ in range(experiments):
        found = interval(simulator.runs(seeds, rng)[:, 0], 0.95, method)
        covered += found.low <= MEAN <= found.high
    return covered / experiments


def sequential(
    first: int, relative: float = 0.02, experiments: int = EXPERIMENTS, shape: Shape = "normal"
) -> tuple[float, float]:
    """Run until the interval is narrow enough.

    Returns
    -------
    How often the last interval covers the true mean, and how many runs it took on average.
    """
    rng = np.random.default_rng([first, experiments])
    simulator = Simulator(shape=shape)
    covered = taken = 0
    for _ in range(experiments):
        values = simulator.runs(MOST, rng)[:, 0]
        count = first
        while count < MOST and not narrow_enough(values[:count].tolist(), relative):
            count += 1
        found = interval(values[:count])
        covered += found.low <= MEAN <= found.high
        taken += count
    return covered / experiments, taken / experiments


def false_alarms(
    seeds: int, arms: int = 2, experiments: int = EXPERIMENTS, shape: Shape = "normal"
) -> float:
    """Return how often equal arms are called different from the baseline (at 5 %, after Holm)."""
    rng = np.random.default_rng([seeds, arms, experiments])
    simulator = Simulator((MEAN,) * arms, shape)
    alarms = 0
    for _ in range(experiments):
        found = against(tidy(simulator.runs(seeds, rng)), "result", "arm 0")
        alarms += bool((found["direction"] != "unclear").any())
    return alarms / experiments


def right_selections(
    arms: int = 5,
    first: int = 10,
    indifference: float = SPREAD / 2,
    experiments: int = EXPERIMENTS,
) -> tuple[float, float]:
    """Select the best of arms in the hardest case: it is better by just the indifference.

    Returns
    -------
    How often the best arm was selected (promised: 0.95), and the mean number of runs of all arms.
    """
    rng = np.random.default_rng([arms, first, experiments])
    simulator = Simulator((MEAN + indifference, *(MEAN,) * (arms - 1)))
    right = taken = 0
    for _ in range(experiments):
        runs = simulator.runs(MOST, rng)
        samples = {f"arm {number}": runs[:, number].tolist() for number in range(arms)}
        found = kim_nelson(samples, first=first, indifference=indifference)
        right += found.best == "arm 0"
        taken += sum(found.used.values())
    return right / experiments, taken / experiments


def tidy(runs: NDArray[np.float64]) -> pd.DataFrame:
    """Return results as a frame with the columns `arm`, `replication` and `result`."""
    seeds, arms = runs.shape
    return pd.DataFrame(
        {
            "arm": np.tile([f"arm {number}" for number in range(arms)], seeds),
            "replication": np.repeat(np.arange(seeds), arms),
            "result": runs.ravel(),
        }
    )


def table(experiments: int = EXPERIMENTS, seeds: Sequence[int] = SEEDS) -> pd.DataFrame:
    """Return the coverage of every kind of interval, a row per shape and number of runs."""
    rows = []
    shapes: tuple[Shape, ...] = ("normal", "skewed")
    for shape in shapes:
        for count in seeds:
            reached, taken = sequential(count, experiments=experiments, shape=shape)
            rows.append(
                {
                    "runs": shape,
                    "seeds": count,
                    "t": fixed(count, "t", experiments, shape),
                    "bootstrap": fixed(count, "bootstrap", experiments, shape),
                    "sequential": reached,
                    "sequential, seeds taken": taken,
                    "false alarms, 1 arm": false_alarms(count, 2, experiments, shape),
                    "false alarms, 5 arms": false_alarms(count, 6, experiments, shape),
                }
            )
            print(f"{shape}, {count} seeds", file=sys.stderr, flush=True)
    return pd.DataFrame(rows)


def page(experiments: int = EXPERIMENTS) -> str:
    """Return the page of the documentation that reports all this."""
    optional("tabulate", "experiments", "a Markdown table")
    # statsmodels collects garbage at every correction: what is here already need not be looked at
    gc.freeze()
    right, taken = right_selections(experiments=experiments)
    return PAGE.format(
        experiments=experiments,
        table=table(experiments).to_markdown(index=False, floatfmt=FORMATS),
        right=right,
        taken=taken,
    )


FORMATS = ("", "", ".3f", ".3f", ".3f", ".1f", ".3f", ".3f")
"""Of the columns of the table."""

PAGE = """\
# Do the intervals contain the true value?

<!-- written by python -m tests.tools.coverage --page docs/coverage.md -->

This page tests the statistics of rmfs on a synthetic simulator whose true means are known. The
result of a run is the mean of its arm, plus an effect of the seed, plus independent noise. The
effect of a seed is the same for all arms (common random numbers). The standard deviation of the sum
of effect and noise is 5 % of the mean. In the rows *normal* of the table below, both are normally
distributed; in the rows *skewed*, both have exponential distributions, shifted to mean 0. Each
figure comes from {experiments:,} experiments.

- **t**, **bootstrap**: share of the 95 % intervals that cover the true mean if the number of seeds
  is fixed.
- **sequential**: share of the 95 % intervals that cover the true mean if the number of seeds is not
  fixed. An experiment starts with the number in the column *seeds*; seeds are added until the half
  width of the interval is at most 0.02 / 1.02 of the mean, which limits the relative error to 2 %.
  The next column is the mean number of seeds that were needed.
- **false alarms**: share of the experiments in which an arm is found to differ from the baseline at
  the 5 % level although all arms have the same mean. One arm or five arms are compared with the
  baseline by paired t tests; with five arms, Holm's correction is applied.

{table}

With few seeds, bootstrap intervals (BCa) are too narrow, for normal and for skewed runs alike. Use
them only with at least 30 seeds. A sequential procedure tends to stop when the sample happens to
vary little. Its interval therefore covers the true mean slightly less often than stated; begin with
ten seeds rather than five.

The selection of the best of five arms (procedure KN of Kim and Nelson) was tested in its hardest
case: the best arm is better than each of the others by exactly the smallest difference worth
detecting. The selection was correct in {right:.3f} of the experiments (nominal: 0.95). On average,
it took {taken:.0f} runs in total, with all five arms counted.
"""


def main(arguments: list[str] | None = None) -> int:
    """Print the page, or write it to a file."""
    parser = argparse.ArgumentParser(prog="python -m tests.tools.coverage")
    parser.add_argument("--experiments", type=int, default=EXPERIMENTS, help="of each kind")
    parser.add_argument("--page", type=Path, help="the .md file to write (default: print it)")
    given = parser.parse_args(arguments)
    try:
        text = page(given.experiments)
        if given.page is None:
            print(text)
        else:
            write_text(given.page, text)
    except InputError as error:
        print(f"coverage: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
