"""The gain of decisions that consider where robots have recently been delayed.

In the design `congestion`, PSA, and TA by linear assignment, decide by travel times that either
include or ignore the delay expected from congestion. Two sites with quick stations are simulated,
each once with few robots and once with so many that the aisles are full. The study publishes the
changes of units per hour, of the delay per trip and of the distance per unit, paired by seed. It
also publishes the share of trip time that is delay, which is an upper bound on what such decisions
can save, and the share of time for which robots have no task.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from rmfs.experiments.papers.study import command, done, parser
from rmfs.experiments.statistics import interval, paired
from rmfs.experiments.tables import HALF, Table, rows_frame

if TYPE_CHECKING:
    import pandas as pd

SITE, KNOWS = "site", "knows"
NOTHING = "nothing"
COLUMNS = (
    "units_per_h",
    "trip_delay_mean_s",
    "trip_delay_share",
    "distance_per_unit_m",
    "robot_idle_share",
)

Rows = dict[str, dict[tuple[str, str], float]]


def wide(frame: pd.DataFrame, column: str) -> pd.DataFrame:
    """Return a measure of one site, with one row per seed and one column per arm."""
    return frame.pivot_table(index="replication", columns=KNOWS, values=column, sort=False)


def levels(frame: pd.DataFrame) -> Table:
    """Return units per hour and delay of the arms that do not consider congestion, by site.

    Parameters
    ----------
    frame
        One row per run: the levels of the factors `site` and `knows`, the number `replication` of
        the run, and the columns in `COLUMNS`.
    """
    rows: Rows = {}
    for site, runs in frame.groupby(SITE, sort=False):
        of = {column: wide(runs, column) for column in COLUMNS}
        for arm in map(str, of["units_per_h"].columns):
            if not arm.endswith(NOTHING):
                continue
            row: dict[tuple[str, str], float] = {}
            delay_s, share = of["trip_delay_mean_s"][arm], of["trip_delay_share"][arm]
            for name, values in (
                ("units per hour", of["units_per_h"][arm]),
                ("delay per trip, s", delay_s),
                ("delay, % of trip time", 100 * share),
                ("robots without a task, %", 100 * of["robot_idle_share"][arm]),
            ):
                found = interval(values)
                row |= {(name, "mean"): found.mean, (name, HALF): found.half_width}
            rows[f"{site}, {arm.removesuffix(': ' + NOTHING)}"] = row
    decimals = dict.fromkeys(next(iter(rows.values())), 2)
    decimals |= {("units per hour", part): 0 for part in ("mean", HALF)}
    caption = "Means over seeds with 95% confidence intervals (Student's t)."
    return Table(rows_frame(rows, "site and controllers"), decimals, caption)


def gains(frame: pd.DataFrame) -> Table:
    """Return the changes caused by considering congestion, paired by seed, by site and arm."""
    rows: Rows = {}
    for site, runs in frame.groupby(SITE, sort=False):
        of = {column: wide(runs, column) for column in COLUMNS}
        for arm in map(str, of["units_per_h"].columns):
            base = f"{arm.partition(':')[0]}: {NOTHING}"
            if arm == base:
                continue
            row: dict[tuple[str, str], float] = {}
            units, metres = of["units_per_h"], of["distance_per_unit_m"]
            delay_s = of["trip_delay_mean_s"]
            for name, values in (
                ("units per hour, %", 100 * (units[arm] / units[base] - 1)),
                ("delay per trip, s", delay_s[arm] - delay_s[base]),
                ("metres per unit, %", 100 * (metres[arm] / metres[base] - 1)),
            ):
                found = interval(values)
                row |= {(name, "mean"): found.mean, (name, HALF): found.half_width}
            row["p value of units", ""] = float(paired(units[arm], units[base])["p"])
            rows[f"{site}, {arm}"] = row
    decimals = dict.fromkeys(next(iter(rows.values())), 2) | {("p value of units", ""): 3}
    caption = (
        "Changes compared with the same controllers without knowledge of congestion, paired by "
        "seed, with 95% confidence intervals (Student's t); p values of the paired t test, not "
        "corrected."
    )
    return Table(rows_frame(rows, "site, controllers and what they know"), decimals, caption)


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    study = done(parser("congestion", __doc__).parse_args(arguments))
    study.publish(levels(study.frame), "congestion", COLUMNS)
    study.publish(gains(study.frame), "congestion-gains", COLUMNS)


if __name__ == "__main__":
    sys.exit(command(main))
