"""The cost of motions that begin late, and the benefit of repairing plans.

In the design `late-motions`, robots at the default site (layout `default`) begin some of their
motions late. Each motion is late with a probability of 0.0005, 0.005 or 0.02. Late motions begin
either 1 to 10 s or 10 to 200 s late. These values span the range of published benchmarks, if one of
their time units is taken as one second. In this study, lateness is the time by which motions begin
late; under perfect execution, no motion begins late. With repair, robots that have to wait for a
late robot get new plans; each combination is run with and without repair.

The study publishes the change of units per hour compared with perfect execution, and the effect of
repair, both paired by seed. A figure shows units per hour over the lateness per robot and hour.
"""

from __future__ import annotations

import sys
from math import nan
from typing import TYPE_CHECKING

from rmfs.experiments.figures.style import saving
from rmfs.experiments.papers.study import command, done, parser
from rmfs.experiments.statistics import interval, paired
from rmfs.experiments.tables import HALF, Table, rows_frame

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.experiments.papers.study import Study

ROBOTS, LATE = "layout.robots", "late"
NEVER = "never"
COLUMNS = ("units_per_h", "late_motions", "lateness_s", "plans_repaired")

Rows = dict[str, dict[tuple[str, str], float]]


def wide(frame: pd.DataFrame, robots: int, column: str = "units_per_h") -> pd.DataFrame:
    """Return a measure for one fleet: a row for each seed, a column for each level of `late`."""
    fleet = frame[frame[ROBOTS] == robots]
    return fleet.pivot_table(index="replication", columns=LATE, values=column, sort=False)


def losses(frame: pd.DataFrame) -> Table:
    """Return units per hour, their change in percent, total lateness, and number of repairs.

    The table has one row per fleet and level of `late`. The change is relative to perfect
    execution; it is negative if fewer units are picked.

    Parameters
    ----------
    frame
        One row per run: `layout.robots`, `late`, `replication` and the columns in `COLUMNS`.
    """
    rows: Rows = {}
    for robots in frame[ROBOTS].unique():
        units = wide(frame, robots)
        lateness_s = wide(frame, robots, "lateness_s").mean()
        repaired = wide(frame, robots, "plans_repaired").mean()
        for late in units.columns:
            reached = interval(units[late])
            row = {("units per hour", "mean"): reached.mean}
            row |= {("units per hour", HALF): reached.half_width}
            row |= dict.fromkeys([("change, %", "mean"), ("change, %", HALF)], nan)
            if late != NEVER:
                change = interval(100 * (units[late] / units[NEVER] - 1))
                row |= {("change, %", "mean"): change.mean, ("change, %", HALF): change.half_width}
            row |= {("lateness, s", ""): lateness_s[late], ("repairs", ""): repaired[late]}
            rows[f"{robots} robots, {late}"] = row
    decimals = {("units per hour", part): 0 for part in ("mean", HALF)}
    decimals |= {("change, %", part): 1 for part in ("mean", HALF)}
    decimals |= {("lateness, s", ""): 0, ("repairs", ""): 0}
    caption = (
        "Units per hour, and their change compared with perfect execution, paired by seed, "
        "with 95% confidence intervals (Student's t); lateness of all motions, and plans "
        "repaired."
    )
    return Table(rows_frame(rows, "robots and lateness"), decimals, caption)


def gains(frame: pd.DataFrame) -> Table:
    """Return the change of units per hour that repair causes, in percent, paired by seed."""
    rows: Rows = {}
    for robots in frame[ROBOTS].unique():
        units = wide(frame, robots)
        for late in units.columns:
            without = late.replace(", repair", ", no repair")
            if without == late or without not in units:
                continue
            found = interval(100 * (units[late] / units[without] - 1))
            apart = paired(units[late], units[without])
            rows[f"{robots} robots, {late.removesuffix(', repair')}"] = {
                ("repair, %", "mean"): found.mean,
                ("repair, %", HALF): found.half_width,
                ("p value", ""): float(apart["p"]),
            }
    decimals = {("repair, %", "mean"): 1, ("repair, %", HALF): 1, ("p value", ""): 3}
    caption = (
        "Change of units per hour by repair, paired by seed, with 95% confidence intervals "
        "(Student's t); p values of the paired t test, not corrected."
    )
    return Table(rows_frame(rows, "robots and lateness"), decimals, caption)


def per_robot_and_hour(frame: pd.DataFrame) -> pd.Series:
    """Return the total lateness of motions per robot and hour, in s, for each run."""
    hours = frame["duration_s"].astype(float) / 3600
    return frame["lateness_s"].astype(float) / frame[ROBOTS].astype(float) / hours


def picture(study: Study) -> None:
    """Plot units per hour, in percent of perfect execution, over lateness per robot and hour."""
    frame = study.frame.assign(lateness=per_robot_and_hour(study.frame))
    path = study.place("late-motions.png")
    with saving(path, 6.0, 4.0) as figure:
        ax = figure.subplots()
        for robots in frame[ROBOTS].unique():
            units = wide(frame, robots)
            share = units.div(units[NEVER], axis=0).mean()
            lateness_s = wide(frame, robots, "lateness").mean()
            for repair, style in ((True, "-"), (False, ":")):
                ends = ", repair" if repair else ", no repair"
                arms = [late for late in map(str, units) if late == NEVER or late.endswith(ends)]
                points = sorted((lateness_s[late], 100 * share[late]) for late in arms)
                label = f"{robots} robots, {ends.removeprefix(', ')}"
                ax.plot(*zip(*points, strict=True), style, marker=".", label=label)
        ax.set_xscale("symlog", linthresh=0.1)
        ax.set_xlabel("lateness of a robot's motions (s in an hour)")
        ax.set_ylabel("units/h, % of perfect execution")
        ax.legend(fontsize=8)
    study.record(path, ["units_per_h"], kind="lines", confidence=0.95)


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    study = done(parser("late-motions", __doc__).parse_args(arguments))
    study.publish(losses(study.frame), "late-motions", COLUMNS)
    study.publish(gains(study.frame), "late-motions-repair", COLUMNS[:1])
    picture(study)


if __name__ == "__main__":
    sys.exit(command(main))
