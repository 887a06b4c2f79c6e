"""The cost of planning time: how units per hour depend on the time that a path plan takes.

The design `price-of-planning` varies the time that it takes to plan the path of a robot's trip, for
five fleets: three on one layout and two on another. There is one planner for all robots or, in arms
whose labels end in ", each", one for each robot. In further arms, the time of a plan is computed
from the work of the search, plans are made only when a robot could depart (label "lazy"), or
planning begins only every five seconds. The study publishes the change of units per hour compared
with plans that take no time, paired by seed. For each fleet, it also publishes the shortest time
per plan that costs throughput.
"""

from __future__ import annotations

import sys
from math import nan
from typing import TYPE_CHECKING

from rmfs.experiments.figures.style import saving
from rmfs.experiments.papers.study import command, done, parser
from rmfs.experiments.statistics import interval
from rmfs.experiments.tables import HALF, Table, rows_frame

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.experiments.papers.study import Study
    from rmfs.experiments.statistics import Interval

FLEET, PLANNING = "fleet", "planning"
INSTANT = "instant"
COLUMNS = ("units_per_h", "planning_charged_s", "plan_wait_s")

Rows = dict[str, dict[tuple[str, str], float]]


def wide(frame: pd.DataFrame, fleet: str, column: str = "units_per_h") -> pd.DataFrame:
    """Return a measure of one fleet, with a row per seed and a column per level of `planning`."""
    own = frame[frame[FLEET] == fleet]
    return own.pivot_table(index="replication", columns=PLANNING, values=column, sort=False)


def changes(frame: pd.DataFrame, fleet: str) -> dict[str, Interval]:
    """Return the change of a fleet's units per hour for each level of `planning`, in percent.

    The change is relative to plans that take no time.
    """
    units = wide(frame, fleet)
    return {
        planning: interval(100 * (units[planning] / units[INSTANT] - 1))
        for planning in map(str, units)
        if planning != INSTANT
    }


def losses(frame: pd.DataFrame) -> Table:
    """Return a table of `changes`, with a row per level of `planning` and a column per fleet.

    Parameters
    ----------
    frame
        One row per run: `fleet`, `planning`, `replication` and the columns in `COLUMNS`.
    """
    rows: Rows = {}
    fleets = list(frame[FLEET].unique())
    for fleet in fleets:
        for planning, change in changes(frame, fleet).items():
            row = rows.setdefault(planning, {})
            row |= {(fleet, "mean"): change.mean, (fleet, HALF): change.half_width}
    decimals = {(fleet, part): 1 for fleet in fleets for part in ("mean", HALF)}
    caption = (
        "Change of units per hour compared with plans that take no time, in percent, paired by "
        "seed, with 95% confidence intervals (Student's t). Seconds: per plan."
    )
    return Table(rows_frame(rows, "planning"), decimals, caption)


def seconds(planning: str) -> float:
    """Return the constant time per plan, in s, from the label of a level; nan if it has none."""
    number, _, rest = planning.removesuffix(", each").partition(" ")
    return float(number) if rest == "s" else nan


def begins(frame: pd.DataFrame, fleet: str, *, each: bool) -> tuple[float, float]:
    """Return the shortest time per plan that costs throughput, and the next shorter time, in s.

    Only times in the design are considered. A time costs throughput if, for this time and for all
    longer ones, the confidence interval of the change of units per hour is below zero. If no time
    costs throughput, the first value is nan, and the second is the longest time. If all times cost
    throughput, the second value is nan.

    Parameters
    ----------
    each
        Whether to consider only levels with a separate planner for each robot, instead of only
        levels with one planner for all robots.
    """
    found = changes(frame, fleet)
    levels = sorted(
        (seconds(one), one) for one in found if one.endswith(", each") == each and seconds(one) > 0
    )
    begin = before = nan
    for time_s, planning in reversed(levels):
        change = found[planning]
        if not change.mean + change.half_width < 0:
            before = time_s
            break
        begin = time_s
    return begin, before


def thresholds(frame: pd.DataFrame) -> Table:
    """Return a table of the shortest time per plan that costs throughput (`begins`), by fleet."""
    rows: Rows = {}
    for fleet in frame[FLEET].unique():
        units = interval(wide(frame, fleet)[INSTANT])
        plans = wide(frame, fleet, "plans")[INSTANT] / wide(frame, fleet, "duration_s")[INSTANT]
        one = begins(frame, fleet, each=False)
        rows[fleet] = {
            ("units per hour", "mean"): units.mean,
            ("units per hour", HALF): units.half_width,
            ("plans per hour", ""): 3600 * float(plans.mean()),
            ("busy at, s", ""): 1 / float(plans.mean()),
            ("no loss shown up to, s", ""): one[1],
            ("loss from, s", ""): one[0],
        }
        if frame[PLANNING].str.endswith(", each").any():
            each = begins(frame, fleet, each=True)
            rows[fleet] |= {
                ("each: no loss shown up to, s", ""): each[1],
                ("each: loss from, s", ""): each[0],
            }
    decimals = {("units per hour", part): 0 for part in ("mean", HALF)}
    decimals |= {("plans per hour", ""): 0}
    decimals |= {column: 1 for row in rows.values() for column in row if ", s" in column[0]}
    caption = (
        "When planning begins to cost throughput. Units and plans per hour are those of plans "
        "that take no time; busy at: 3600 s divided by the plans per hour, that is, the time per "
        "plan at which a single planner would never be idle. Loss from: the shortest time per "
        "plan, of those studied, from which on fewer units per hour are picked (the 95% "
        "confidence interval of the paired change lies below zero); one planner serves all "
        "robots. each: every robot has its own planner."
    )
    return Table(rows_frame(rows, "fleet"), decimals, caption)


def picture(study: Study) -> None:
    """Plot units per hour, in percent of those without planning time, over the time per plan."""
    path = study.place("price-of-planning.png")
    with saving(path, 6.0, 4.0) as figure:
        ax = figure.subplots()
        for colour, fleet in enumerate(study.frame[FLEET].unique()):
            found = changes(study.frame, fleet)
            for style, each in (("-", False), (":", True)):
                own = [one for one in found if one.endswith(", each") == each and seconds(one) > 0]
                if not own:
                    continue
                points = sorted((seconds(one), 100 + found[one].mean) for one in own)
                label = None if each else fleet
                xs, ys = zip(*points, strict=True)
                ax.plot(xs, ys, style, marker=".", color=f"C{colour}", label=label)
        ax.set_xscale("log")
        ax.set_xlabel("time per plan (s); dotted: a planner for each robot")
        ax.set_ylabel("units/h, % of instant planning")
        ax.legend(fontsize=8)
    study.record(path, ["units_per_h"], kind="lines", confidence=0.95)


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    study = done(parser("price-of-planning", __doc__).parse_args(arguments))
    study.publish(thresholds(study.frame), "price-of-planning", COLUMNS)
    study.publish(losses(study.frame), "price-of-planning-change", COLUMNS[:1])
    picture(study)


if __name__ == "__main__":
    sys.exit(command(main))
