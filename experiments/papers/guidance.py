"""The gain of guidance, which adds costs to edges so that planners prefer certain paths.

The design `guidance` simulates sites with quick stations at normal and at high density of robots,
without guidance and with several guidance files. The study publishes the changes of units per hour,
of the delay per trip and of the distance per unit, paired by seed, with p values corrected by
Holm's method. For the runs without guidance, it also publishes the share of trip time that is
delay (guidance cannot save more than this) and the share of time for which robots have no task
(during which shorter trips would gain nothing).

The same layouts, robots and guidance are also simulated with random trips instead of orders, so
that every robot always has a trip. For these simulations, the study publishes the change of trips
per hour.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from math import nan
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from rmfs.experiments.papers.study import command, done, parser
from rmfs.experiments.running.code import code
from rmfs.experiments.statistics import interval, paired
from rmfs.experiments.statistics.paired import holm
from rmfs.experiments.tables import HALF, Table, rows_frame
from rmfs.experiments.traffic.guide_tasks import Trips

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rmfs.experiments.papers.study import Study

CASE = "case"
NOTHING = "none"
COLUMNS = (
    "units_per_h",
    "trip_delay_mean_s",
    "trip_delay_share",
    "distance_per_unit_m",
    "robot_idle_share",
)

TRIPS = ("trips_per_h", "trip_delay_mean_s", "labels_per_plan")
"""Columns of runs with random trips."""

Rows = dict[str, dict[tuple[str, str], float]]


def sites(
    frame: pd.DataFrame, columns: Sequence[str] = COLUMNS
) -> Iterator[tuple[str, dict[str, pd.DataFrame]]]:
    """Yield each site with a table per measure: a row for each seed, a column for each guidance.

    Parameters
    ----------
    frame
        Runs with the columns `case` ("site: guidance") and `replication`, and those in `columns`.
    """
    parts = frame[CASE].str.partition(": ")
    for site, runs in frame.assign(site=parts[0], guidance=parts[2]).groupby("site", sort=False):
        yield (
            str(site),
            {
                column: runs.pivot_table(
                    index="replication", columns="guidance", values=column, sort=False
                )
                for column in columns
            },
        )


def levels(frame: pd.DataFrame) -> Table:
    """Return the results without guidance, by site: units per hour and delay."""
    rows: Rows = {}
    for site, of in sites(frame):
        delay_s, share = of["trip_delay_mean_s"][NOTHING], of["trip_delay_share"][NOTHING]
        row: dict[tuple[str, str], float] = {}
        for name, values in (
            ("units per hour", of["units_per_h"][NOTHING]),
            ("delay per trip, s", delay_s),
            ("delay, % of trip time", 100 * share),
            ("robots without a task, %", 100 * of["robot_idle_share"][NOTHING]),
        ):
            found = interval(values)
            row |= {(name, "mean"): found.mean, (name, HALF): found.half_width}
        rows[site] = row
    decimals = dict.fromkeys(next(iter(rows.values())), 2)
    decimals |= {("units per hour", part): 0 for part in ("mean", HALF)}
    caption = "Without guidance: means over seeds with 95% confidence intervals (Student's t)."
    return Table(rows_frame(rows, "site"), decimals, caption)


def gains(frame: pd.DataFrame) -> Table:
    """Return the effects of guidance, paired by seed, with one row per site and guidance."""
    rows: Rows = {}
    p_units, p_delay = ("p of units", "Holm"), ("p of delay", "Holm")
    for site, of in sites(frame):
        units, metres = of["units_per_h"], of["distance_per_unit_m"]
        delay_s = of["trip_delay_mean_s"]
        for arm in map(str, units.columns):
            if arm == NOTHING:
                continue
            row: dict[tuple[str, str], float] = {}
            for name, values in (
                ("units per hour, %", 100 * (units[arm] / units[NOTHING] - 1)),
                ("delay per trip, s", delay_s[arm] - delay_s[NOTHING]),
                ("metres per unit, %", 100 * (metres[arm] / metres[NOTHING] - 1)),
            ):
                found = interval(values)
                row |= {(name, "mean"): found.mean, (name, HALF): found.half_width}
            row[p_units] = float(paired(units[arm], units[NOTHING])["p"])
            row[p_delay] = float(paired(delay_s[arm], delay_s[NOTHING])["p"])
            rows[f"{site}, {arm}"] = row
    for key in (p_units, p_delay):
        corrected = holm(pd.Series({name: row[key] for name, row in rows.items()}))
        for name, row in rows.items():
            row[key] = float(corrected[name])
    decimals = dict.fromkeys(next(iter(rows.values())), 2) | {p_units: 3, p_delay: 3}
    caption = (
        "Changes compared with the same site without guidance, paired by seed, with 95% confidence "
        "intervals (Student's t); p values of the paired t test, corrected for the comparisons in "
        "all rows by Holm's method, separately for units and delay."
    )
    return Table(rows_frame(rows, "site and guidance"), decimals, caption)


def random_trips(study: Study) -> pd.DataFrame:
    """Simulate random trips with the layout, robots and guidance of every arm, for every seed.

    Returns
    -------
    One row per run, with the columns of `TRIPS`.
    """
    warmup_s, duration_s = (60.0, 120.0) if study.smoke else (300.0, 900.0)
    rows = []
    for arm in study.plan.arms:
        own = {".".join(keys): value for keys, value in arm.overrides if keys[0] == "layout"}
        files = [Path(value) for keys, value in arm.overrides if keys[-1] == "guidance"]
        task = Trips(arm.inputs["layout"], set=own, warmup_s=warmup_s, duration_s=duration_s)
        for seed in sorted(set(study.frame["replication"])):
            run = task.run(int(seed), *files)
            counters = run.traffic.counters()
            rows.append(
                {
                    "run": f"{arm.digest[:16]}-{seed}",
                    "arm": arm.name,
                    CASE: arm.levels[CASE],
                    "replication": int(seed),
                    "trips_per_h": run.trips_per_h,
                    "trip_delay_mean_s": float(run.delays_s.mean()),
                    "labels_per_plan": counters["expansions"]
                    / max(counters["plans"] + counters["replans"], 1),
                    **code(),
                }
            )
    return pd.DataFrame(rows)


def trip_gains(frame: pd.DataFrame) -> Table:
    """Return trips per hour, and the effects of guidance on them, paired by seed.

    Parameters
    ----------
    frame
        Results of the simulations, as `random_trips` returns them.
    """
    rows: Rows = {}
    p_trips = ("p of trips", "Holm")
    for site, of in sites(frame, TRIPS):
        trips, labels = of["trips_per_h"], of["labels_per_plan"].mean()
        delay_s = of["trip_delay_mean_s"]
        for arm in map(str, trips.columns):
            row: dict[tuple[str, str], float] = {
                ("trips per hour", "mean"): float(trips[arm].mean()),
                ("labels per plan", "mean"): float(labels[arm]),
            }
            if arm != NOTHING:
                for name, values in (
                    ("trips, %", 100 * (trips[arm] / trips[NOTHING] - 1)),
                    ("delay per trip, s", delay_s[arm] - delay_s[NOTHING]),
                ):
                    found = interval(values)
                    row |= {(name, "mean"): found.mean, (name, HALF): found.half_width}
                row[p_trips] = float(paired(trips[arm], trips[NOTHING])["p"])
            rows[f"{site}, {arm}"] = row
    known = {name: row[p_trips] for name, row in rows.items() if p_trips in row}
    corrected = holm(pd.Series(known))
    for case in known:
        rows[case][p_trips] = float(corrected[case])
    columns = [
        *[("trips per hour", "mean"), ("labels per plan", "mean")],
        *[(name, part) for name in ("trips, %", "delay per trip, s") for part in ("mean", HALF)],
        p_trips,
    ]
    full = {name: {key: row.get(key, nan) for key in columns} for name, row in rows.items()}
    decimals = dict.fromkeys(columns, 2)
    decimals |= {("trips per hour", "mean"): 0, ("labels per plan", "mean"): 0, p_trips: 3}
    caption = (
        "Random trips without orders: means over seeds, and changes compared with the same site "
        "without guidance, paired by seed, with 95% confidence intervals (Student's t); p values "
        "of the paired t test, corrected for the comparisons in all rows by Holm's method."
    )
    return Table(rows_frame(full, "site and guidance"), decimals, caption)


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    study = done(parser("guidance", __doc__).parse_args(arguments))
    study.publish(levels(study.frame), "guidance", COLUMNS)
    study.publish(gains(study.frame), "guidance-gains", COLUMNS)
    alone = replace(study, frame=random_trips(study))
    alone.publish(trip_gains(alone.frame), "guidance-trips", TRIPS)


if __name__ == "__main__":
    sys.exit(command(main))
