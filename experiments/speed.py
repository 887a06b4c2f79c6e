"""Speed of runs, and how their time is spent: `rmfs bench`.

All runs take place in one process, on one core, without checker and trace. Each case (`Case`) is
run several times. The figure to quote is the number of simulated seconds per wall second. A fixed
reference loop is timed before each run: to compare machines, multiply the quoted figure by the
seconds that the reference loop takes.
"""

from __future__ import annotations

import platform
import statistics
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

import pandas as pd

import rmfs
from rmfs.files import write_text

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

RUNS = 5
REFERENCE_STEPS = 2_000_000


@dataclass(frozen=True, slots=True)
class Case:
    """Inputs of a run that is timed.

    Attributes
    ----------
    duration_s
        Simulated seconds. There is no warm-up, so the measured times include computing the first
        tables of travel times, which the search for routes uses.
    """

    layout: str
    scenario: str
    controllers: str
    duration_s: float


CASES = [
    Case(layout, scenario, controllers, duration_s)
    for layout, scenario, controllers in [
        ("study-32", "pp-minimal", "random"),
        ("study-128", "pp-minimal", "random"),
        ("study-tiers", "pp-minimal", "random"),
        ("default-32", "default", "default"),
    ]
    for duration_s in (7_200.0, 28_800.0)
]


def reference_loop() -> float:
    """Return the seconds that a fixed loop of plain Python (a random number generator) takes."""
    begun = time.perf_counter()
    state = 1
    for _ in range(REFERENCE_STEPS):
        state = (state * 1_103_515_245 + 12_345) & 0x7FFF_FFFF
    return time.perf_counter() - begun


def measure(case: Case, seed: int) -> dict[str, float]:
    """Run a case once.

    Returns
    -------
    Wall seconds of the simulation loop (`wall_s`) and, within it, of path planning (`planning_s`)
    and of decisions (`decisions_s`); completed orders (`orders`); peak memory in MB
    (`peak_rss_mb`); and seconds of the reference loop (`reference_loop_s`).
    """
    loop_s = reference_loop()
    overrides = [(["scenario", "duration_s"], case.duration_s), (["scenario", "warmup_s"], 0.0)]
    run = rmfs.simulate(
        case.layout, case.scenario, case.controllers, seed=seed, overrides=overrides
    )
    footprint = run.footprint
    return {
        "wall_s": run.wall_s,
        "planning_s": run.traffic.counters()["planning_s"],
        "decisions_s": float(footprint["decision_wall_s"]),
        "orders": float(footprint["orders_completed"]),
        "peak_rss_mb": float(footprint["peak_rss_mb"]),
        "reference_loop_s": loop_s,
    }


def table(
    cases: Sequence[Case] = CASES,
    runs: int = RUNS,
    tell: Callable[[str], None] = print,
    advance: Callable[[float, float], None] = lambda done, total: None,
) -> pd.DataFrame:
    """Time the cases; return medians over `runs` seeds, one row per case.

    Parameters
    ----------
    tell
        Function called after each case, with a line of text on its speed.
    advance
        Function called at the start and after each run, with the number of finished runs and the
        total number of runs.
    """
    rows = []
    total = len(cases) * runs
    advance(0, total)
    for number, case in enumerate(cases):
        measured = []
        for seed in range(runs):
            measured.append(measure(case, seed))
            advance(number * runs + seed + 1, total)
        middle = {key: statistics.median(row[key] for row in measured) for key in measured[0]}
        wall_s = middle["wall_s"]
        rows.append(
            {
                "layout": case.layout,
                "controllers": case.controllers,
                "simulated_s": case.duration_s,
                "sim_per_wall": case.duration_s / wall_s,
                "planning_share": middle["planning_s"] / wall_s,
                "decisions_share": middle["decisions_s"] / wall_s,
                "rest_share": 1 - (middle["planning_s"] + middle["decisions_s"]) / wall_s,
                "orders": middle["orders"],
                "peak_rss_mb": middle["peak_rss_mb"],
                "reference_loop_s": middle["reference_loop_s"],
            }
        )
        tell(f"{case.layout}, {case.duration_s:.0f} s: {rows[-1]['sim_per_wall']:,.0f}")
    return pd.DataFrame(rows)


def save(frame: pd.DataFrame, folder: Path) -> None:
    """Write the table as CSV and as Markdown; the Markdown file also names the platform."""
    write_text(folder / "speed.csv", frame.to_csv(index=False))
    write_text(folder / "speed.md", f"{to_markdown(frame)}\n\n{platform.platform()}\n")


def to_markdown(frame: pd.DataFrame) -> str:
    """Format the table for the documentation."""
    lines = ["| " + " | ".join(frame.columns) + " |", "|" + "---|" * len(frame.columns)]
    for row in frame.itertuples(index=False):
        lines.append("| " + " | ".join(_shown(value) for value in row) + " |")
    return "\n".join(lines)


def _shown(value: object) -> str:
    if isinstance(value, float):
        return f"{value:.2f}" if abs(value) < 10 else f"{value:,.0f}"
    return str(value)
