"""The demonstration of `make demo`: the default warehouse, three seeds, a table and a picture.

The trace of every run is checked before its results are shown. The run folders and the picture are
written to `results/demo`.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from scipy import stats

from rmfs.errors import InputError
from rmfs.measure import load_run, write_run
from rmfs.simulation.run import simulate

if TYPE_CHECKING:
    from rich.console import Group

SEEDS = (1, 2, 3)
TARGET = Path("results") / "demo"
FIGURES = {
    "units_per_h": ("units per hour", "{:,.1f}"),
    "orders_per_h": ("orders per hour", "{:,.1f}"),
    "units_per_visit": ("units per pod visit", "{:.3f}"),
    "distance_per_unit_m": ("distance per unit, m", "{:,.2f}"),
    "pick_station_idle_share": ("pick stations idle, share", "{:.4f}"),
    "sim_per_wall": ("simulated seconds per wall second", "{:,.0f}"),
}
"""Column of the footprint, label and format of each measure shown."""


def interval(values: pd.Series, confidence: float = 0.95) -> tuple[float, float]:
    """Return the mean of independent runs and half the width of its confidence interval.

    Parameters
    ----------
    confidence
        Probability that intervals made this way cover the true mean, if runs are normally
        distributed (Student's t).
    """
    count = len(values)
    quantile = stats.t.ppf((1 + confidence) / 2, count - 1)
    return float(values.mean()), float(quantile * values.std(ddof=1) / np.sqrt(count))


def run(seed: int) -> pd.DataFrame:
    """Simulate one seed, check the trace, write the run folder and return the footprint."""
    done = simulate("default", "default", "default", seed=seed, trace=True)
    report = done.check()
    if not report.ok:
        raise SystemExit(f"seed {seed}: {report.summary()}")
    write_run(done, TARGET / f"seed{seed}", report=report)
    say(f"seed {seed}: {done.end_s:,.0f} s in {done.wall_s:.2f} s; {report.summary()}")
    return load_run(TARGET / f"seed{seed}").table("footprint")


def table(footprints: pd.DataFrame) -> Group:
    """Return a table with the mean of each measure over the seeds and its confidence interval."""
    from rich import box
    from rich.console import Group
    from rich.table import Table

    first = footprints.iloc[0]
    title = (
        f"{first['robots']} robots, {first['pods']} pods, {first['pick_stations']} pick and "
        f"{first['replenishment_stations']} replenishment stations, "
        f"{first['duration_s'] / 3600:g} h, {len(footprints)} seeds"
    )
    shown = Table("", "mean", "95 % interval", box=box.SIMPLE_HEAD)
    for column in shown.columns[1:]:
        column.justify = "right"
    for name, (label, form) in FIGURES.items():
        mean, half = interval(footprints[name])
        shown.add_row(label, form.format(mean), f"± {form.format(half)}")
    return Group(title, shown)


def picture(path: Path) -> None:
    """Draw a heat map: how often robots passed or stopped at each waypoint, summed over seeds."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    from rmfs.files import replacing
    from rmfs.measure.plots import heat

    frames = [load_run(TARGET / f"seed{seed}").table("heat") for seed in SEEDS]
    together = frames[0].assign(visits=sum(frame["visits"] for frame in frames))
    figure, axes = plt.subplots(figsize=(11, 6), layout="constrained")
    heat(together, axes)
    axes.set_title(f"Default layout, {len(SEEDS)} seeds")
    with replacing(path) as temporary:
        figure.savefig(temporary, format="png", dpi=150)
    plt.close(figure)


def say(text: str) -> None:
    """Print a message about the progress of the demonstration."""
    print(text, flush=True)


def main() -> int:
    """Run the demonstration and return the exit code."""
    from rich.console import Console

    began = time.perf_counter()
    try:
        footprints = pd.concat([run(seed) for seed in SEEDS], ignore_index=True)
        picture(TARGET / "heat.png")
    except InputError as error:
        print(f"demo: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("demo: interrupted", file=sys.stderr)
        return 130
    Console(highlight=False).print(table(footprints))
    say(f"Run folders and heat map are in {TARGET}; {time.perf_counter() - began:.1f} s in all.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
