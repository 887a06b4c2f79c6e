"""The number of robots that a warehouse needs: throughput by fleet size, and gain per robot.

The design `fleet-size` simulates six fleet sizes, each with two storage rules. The study publishes
units per hour of every fleet; the gain per additional robot from one fleet to the next larger one,
paired by seed; and the Pareto front, that is, the arms that no other arm dominates in units per
hour and number of robots.
"""

from __future__ import annotations

import sys
from itertools import pairwise
from typing import TYPE_CHECKING

import pandas as pd

from rmfs.experiments.figures import pareto
from rmfs.experiments.figures.pareto import front
from rmfs.experiments.figures.style import saving
from rmfs.experiments.papers.study import command, done, parser
from rmfs.experiments.statistics import interval, per_arm
from rmfs.experiments.tables import HALF, Table, digits, means

if TYPE_CHECKING:
    from pathlib import Path

    from rmfs.experiments.papers.study import Study

ROBOTS, RULE = "layout.robots", "controllers.psa"
UNITS = "units_per_h"
COLUMNS = (UNITS, "distance_per_unit_m", "robot_queueing_share", "pick_station_idle_share")


def added(frame: pd.DataFrame, rule: str = RULE, column: str = UNITS) -> Table:
    """Return the gain per additional robot from each fleet to the next larger one, paired by seed.

    Parameters
    ----------
    frame
        Results of a design with two factors, one of which is `layout.robots`.
    rule
        The other factor; fleets are compared separately at each of its levels.
    column
        The measure whose gain is computed.

    Returns
    -------
    One row per level of `rule` and pair of fleets, named `LEVEL, FEWER to MORE robots`: the mean
    gain per additional robot, the half width of its confidence interval, and the number of seeds.
    """
    rows: dict[str, dict[tuple[str, str], float]] = {}
    for level, runs in frame.groupby(rule, sort=False):
        wide = runs.pivot_table(index="replication", columns=ROBOTS, values=column)
        fleets = [int(fleet) for fleet in sorted(wide.columns)]
        for fewer, more in pairwise(fleets):
            found = interval((wide[more] - wide[fewer]).dropna() / (more - fewer))
            rows[f"{level}, {fewer} to {more} robots"] = {
                (column, "mean"): found.mean,
                (column, HALF): found.half_width,
                ("seeds", ""): float(found.count),
            }
    columns = [(column, "mean"), (column, HALF), ("seeds", "")]
    made = pd.DataFrame(list(rows.values()), index=pd.Index(list(rows), name="step"))
    made.columns = pd.MultiIndex.from_tuples(columns)
    shown = digits(made[column, HALF], made[column, "mean"])
    caption = (
        f"Gain in {column} per additional robot, from each fleet to the next, paired by seed, "
        "with 95% confidence intervals (Student's t)."
    )
    decimals = {(column, "mean"): shown, (column, HALF): shown, ("seeds", ""): 0}
    return Table(made, decimals, caption)


def unbeaten(frame: pd.DataFrame, column: str = UNITS) -> Table:
    """Return a table of the arms on the Pareto front, from the smallest to the largest fleet.

    An arm is on the front if no other arm dominates it in number of robots and `column`.
    """
    robots = per_arm(frame, "robots")["mean"]
    best = front(robots, per_arm(frame, column)["mean"], "less", "more")
    chosen = frame.set_index("arm").loc[best].reset_index()
    table = means(chosen, ["robots", *(c for c in COLUMNS if c in frame)])
    caption = f"Arms that no other arm dominates in robots and {column}. {table.caption}"
    return Table(table.frame, table.decimals, caption)


def picture(study: Study) -> Path:
    """Plot units per hour over the number of robots for every arm, and the Pareto front."""
    path = study.place("fleet-size.png")
    with saving(path, 6.4, 4.2) as figure:
        pareto(study.frame, "robots", UNITS, figure.subplots())
    study.record(path, ["robots", UNITS], kind="pareto", confidence=0.95)
    return path


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    study = done(parser("fleet-size", __doc__).parse_args(arguments))
    study.publish(means(study.frame, COLUMNS), "fleet-size", COLUMNS)
    study.publish(added(study.frame), "fleet-size-added", [UNITS])
    study.publish(unbeaten(study.frame), "fleet-size-front", COLUMNS)
    print(picture(study))


if __name__ == "__main__":
    sys.exit(command(main))
