"""The number of robots that stations need: rules compared with joint decisions on orders and pods.

The study runs fleets of different sizes at the small site (the shipped layout `small`), with a
backlog, and measures the first hour. It shows units per hour and their proven bound by fleet size,
and the smallest fleet with which each controller reaches 95 % of the capacity of the pick stations.
The study takes about 0.3 CPU hours, with or without `--later`.

A small fleet initially picks stock that it has no time to replenish. Therefore, `--later` uses
other runs: some measure the third hour with a backlog, the others the first hour with orders that
arrive over time.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import pandas as pd

from rmfs.experiments.figures.lines import lines
from rmfs.experiments.figures.style import saving
from rmfs.experiments.papers.benefit import (
    CONTROLLERS,
    START,
    completed,
    overview,
    publish_added,
    require_optimised,
)
from rmfs.experiments.papers.study import command, done, parser, station_units_per_h
from rmfs.experiments.statistics import interval
from rmfs.experiments.tables import HALF, Table, rows_frame

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from rmfs.experiments.papers.study import Study

ROBOTS = "layout.robots"
ENOUGH = 0.95
"""Share of the stations' capacity that a fleet should reach."""

DEMAND = "demand"
COLUMNS = (
    "units_per_h",
    "station_share",
    "units_per_visit",
    "distance_per_unit_m",
    "bundles_per_h",
    "inventory_share_mean",
)


def needed(frame: pd.DataFrame, groups: Sequence[str], enough: float = ENOUGH) -> Table:
    """Return the smallest fleet that reaches a share of the stations' capacity, for each group.

    Parameters
    ----------
    frame
        Results of the runs, as `completed` returns them.
    groups
        Names of columns; runs with the same values in all these columns form a group.
    enough
        Share of the stations' capacity that the fleet must reach.

    Returns
    -------
    One row per group: the number of robots of this fleet, and the share of the stations' capacity
    that it reaches. Both are nan if no fleet of the design suffices.
    """
    rows: dict[str, dict[tuple[str, str], float]] = {}
    for levels, runs in frame.groupby(list(groups), sort=False):
        row = dict.fromkeys([("robots", ""), ("share", "mean"), ("share", HALF)], float("nan"))
        for robots, fleet in runs.groupby(ROBOTS):
            found = interval(fleet["station_share"])
            if found.mean >= enough:
                row |= {("robots", ""): float(str(robots))}
                row |= {("share", "mean"): found.mean, ("share", HALF): found.half_width}
                break
        rows[", ".join(str(level) for level in levels)] = row
    caption = (
        f"Smallest fleet of the design that reaches {enough:.0%} of the pick stations' capacity."
    )
    decimals = {("robots", ""): 0, ("share", "mean"): 3, ("share", HALF): 3}
    return Table(rows_frame(rows, ", ".join(groups)), decimals, caption)


def picture(
    study: Study,
    frame: pd.DataFrame,
    limit: float,
    name: str = "fewer-robots.png",
    clairvoyant: Mapping[int, float] | None = None,
) -> Path:
    """Draw units per hour over the fleet size, with upper bounds.

    Parameters
    ----------
    clairvoyant
        Upper bounds on units per hour, by fleet size, that hold even for controllers that know all
        future orders. If None, the bounds in `frame` are drawn instead.
    """
    path = study.place(name)
    with saving(path, 6.0, 4.0) as figure:
        ax = figure.subplots()
        lines(frame, ROBOTS, "units_per_h", "controllers", ax)
        bound, label = frame.groupby(ROBOTS)["units_per_h_bound"].max(), "proven bound"
        if clairvoyant is not None:
            bound, label = pd.Series(clairvoyant), "clairvoyant bound"
        ax.plot(bound.index, bound, color="black", linestyle=":", label=label)
        ax.axhline(
            ENOUGH * limit, color="0.5", linewidth=0.8, label=f"{ENOUGH:.0%} of the stations"
        )
        ax.set_xlabel("robots")
        ax.set_ylim(bottom=0)
        ax.legend(fontsize=8)
    study.record(path, ["units_per_h", "units_per_h_bound"], kind="lines", confidence=0.95)
    return path


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    options = parser("fewer-robots", __doc__)
    options.add_argument(
        "--later",
        action="store_true",
        help="use the third hour and orders that arrive over time instead",
    )
    given = options.parse_args(arguments)
    if given.later:
        given.design = "fewer-robots-later"
    study = done(given)
    each = station_units_per_h(study)
    frame = completed(study.frame, each)
    groups = (DEMAND, CONTROLLERS) if DEMAND in frame else (CONTROLLERS,)
    name = study.plan.design.name
    study.publish(overview(frame, (*groups, ROBOTS), COLUMNS), name, COLUMNS)
    study.publish(needed(frame, groups), f"{name}-needed", ("station_share",))
    publish_added(study, frame, (*groups[:-1], ROBOTS), name)
    solved = frame[~frame[CONTROLLERS].str.endswith(START)]
    if DEMAND not in frame:
        print(picture(study, solved, each * frame["pick_stations"].iloc[0]))
    # fleets far too small keep no plan: they are shown, and nothing is claimed of them
    require_optimised(study, frame[frame["station_share"] >= ENOUGH])


if __name__ == "__main__":
    sys.exit(command(main))
