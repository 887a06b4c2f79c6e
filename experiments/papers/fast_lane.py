"""The default rules compared with those of RAWSim-O over 48 h, with and without the fast lane.

The inputs correspond to RAWSim-O's instances `fastlane`: layout and controllers are the same, and
SKUs have the same distribution. Means over ten seeds are compared with two runs of RAWSim-O, one
with the fast lane and one without. RAWSim-O plans paths by FAR (flow annotation replanning), and
its robots wait for the next step of the simulation before every straight drive, lift and set-down.
Here, both settings of the fast lane are run in three variants of driving: with the planner
`time-windows`; with FAR; and with FAR and longer times for turning and lifting, which include the
mean of this wait. The comparison of the variants separates the effect of the rules from that of
driving.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from rmfs.experiments.papers.study import command, done, parser
from rmfs.experiments.statistics import interval
from rmfs.experiments.tables import HALF, Table, digits, rows_frame

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd

LANE, DRIVING = "controllers.poa.fast_lane", "driving"
COLUMNS = ("orders_completed", "units_picked", "units_per_visit", "distance_m")
THEIRS = {
    True: (23314.0, 38232.0, 4.17, 719_100.0),
    False: (22383.0, 36856.0, 3.92, 740_300.0),
}
"""Values of `COLUMNS` measured in RAWSim-O with seed 0, with fast lane (True) and without."""


def beside(frame: pd.DataFrame) -> Table:
    """Return the means of every arm, and their differences from RAWSim-O's values in percent."""
    rows: dict[str, dict[tuple[str, str], float]] = {}
    for (driving, lane), runs in frame.groupby([DRIVING, LANE], sort=False):
        row = {("seeds", ""): float(len(runs))}
        for column, theirs in zip(COLUMNS, THEIRS[bool(lane)], strict=True):
            found = interval(runs[column])
            row[column, "mean"], row[column, HALF] = found.mean, found.half_width
            row[f"{column} against RAWSim-O, %", ""] = 100 * (found.mean / theirs - 1)
        rows[f"{driving}, {'with' if lane else 'without'} fast lane"] = row
    made = rows_frame(rows, "robots and rule")
    decimals = {key: 1 for row in rows.values() for key in row} | {("seeds", ""): 0}
    for column in COLUMNS:
        shown = digits(made[column, HALF], made[column, "mean"])
        decimals |= {(column, "mean"): shown, (column, HALF): shown}
    caption = "Means over seeds of 48 h with 95% confidence intervals (Student's t)."
    return Table(made, decimals, caption)


def gain(frame: pd.DataFrame, columns: Sequence[str] = COLUMNS) -> Table:
    """Return the gain from the fast lane in each measure, in percent, paired by seed."""
    rows: dict[str, dict[tuple[str, str], float]] = {}
    for driving, runs in frame.groupby(DRIVING, sort=False):
        row: dict[tuple[str, str], float] = {}
        for column in columns:
            wide = runs.pivot_table(index="replication", columns=LANE, values=column)
            gains = 100 * (wide[True] / wide[False] - 1)
            found = interval(gains)
            row[column, "mean"], row[column, HALF] = found.mean, found.half_width
            # Student's t interval of the next run, in place of that of the mean
            row[f"{column} of one run, +-", ""] = found.half_width * (len(gains) + 1) ** 0.5
        rows[str(driving)] = row
    pairs = zip(columns, THEIRS[True], THEIRS[False], strict=True)
    rows["RAWSim-O (one run)"] = {
        (column, "mean"): 100 * (with_lane / without - 1) for column, with_lane, without in pairs
    }
    made = rows_frame(rows, "gain of the fast lane, %")
    caption = (
        "Gain of the fast lane, paired by seed, in percent with 95% confidence intervals of "
        "the mean. With a probability of 95%, the gain in a single further run differs from the "
        "mean by no more than the value under one run."
    )
    return Table(made, dict.fromkeys(next(iter(rows.values())), 2), caption)


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    study = done(parser("fast-lane", __doc__).parse_args(arguments))
    study.publish(beside(study.frame), "fast-lane-beside-rawsim-o", COLUMNS)
    study.publish(gain(study.frame), "fast-lane-gain", COLUMNS)


if __name__ == "__main__":
    sys.exit(command(main))
