"""Tables shared by the studies on the benefit of joint decisions by solvers."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import numpy as np

from rmfs.experiments.papers.study import FAILED
from rmfs.experiments.statistics import interval
from rmfs.experiments.tables import HALF, Table, digits, rows_frame

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd

    from rmfs.experiments.papers.study import Study

CONTROLLERS, RULES = "controllers", "rules"
RATES = ("units_per_h", "lines_per_h", "orders_per_h")
EFFORT = ("units_per_visit", "orders_per_visit", "distance_per_unit_m", "distance_per_order_m")
SHARES = tuple(f"{kind}_decision_share" for kind in ("optimiser", "heuristic", "stale", "failed"))
COLUMNS = (*RATES, "station_share", *EFFORT, "order_turnover_median_s")
START = ", start rule"
"""Suffix of the names of arms in which the start rule of an optimiser decides, without a solver."""
DECISION_S = "optimiser_wall_median_s"
LEAST_SHARE = 0.9
"""Minimum `optimiser_decision_share` of a run with an optimiser; less is refused."""


def completed(frame: pd.DataFrame, station_units_per_h: float) -> pd.DataFrame:
    """Return the runs with two additional measures.

    Parameters
    ----------
    frame
        Results of a design.
    station_units_per_h
        Capacity of a pick station: 3600 s divided by the time per unit.

    Returns
    -------
    The frame with `distance_per_order_m`, the metres that all robots together drive per completed
    order, and `station_share`, units per hour as a share of the capacity of all pick stations. If
    the design has a factor `rules`, the column `controllers` shows the levels of this factor.
    """
    limit = frame["pick_stations"] * station_units_per_h
    if RULES in frame:
        frame = frame.assign(**{CONTROLLERS: frame[RULES]})
    return frame.assign(
        distance_per_order_m=frame["distance_m"] / frame["orders_completed"],
        station_share=frame["units_per_h"] / limit,
    )


def overview(frame: pd.DataFrame, groups: Sequence[str], columns: Sequence[str] = COLUMNS) -> Table:
    """Return a table of means over seeds, with one row for each group of runs.

    The means of `columns` are shown with confidence intervals. Further columns, without intervals,
    show the means of the optimisers' decision time, of the four columns `*_decision_share` of the
    footprint, and of the bound on units per hour.

    Parameters
    ----------
    frame
        As `completed` returns it.
    groups
        Names of columns; runs with the same values in all these columns form a group.
    columns
        Measures shown with intervals.
    """
    rows: dict[str, dict[tuple[str, str], float]] = {}
    for levels, runs in frame.groupby(list(groups), sort=False):
        row = {("seeds", ""): float(len(runs))}
        for column in columns:
            found = interval(runs[column])
            row[column, "mean"], row[column, HALF] = found.mean, found.half_width
        for column in (DECISION_S, *SHARES, "units_per_h_bound"):
            row[column, ""] = float(runs[column].mean())
        rows[", ".join(str(level) for level in levels)] = row
    made = rows_frame(rows, ", ".join(groups))
    decimals = {("seeds", ""): 0, (DECISION_S, ""): 3, ("units_per_h_bound", ""): 0}
    decimals |= {(column, ""): 3 for column in SHARES}
    for column in columns:
        shown = digits(made[column, HALF], made[column, "mean"])
        decimals |= {(column, "mean"): shown, (column, HALF): shown}
    caption = (
        "Means over seeds with 95% confidence intervals (Student's t). station_share: units "
        "per hour as a share of the pick stations' capacity. Decisions: shares by their "
        "source, of all decisions for which optimisers were asked. units_per_h_bound: proven "
        "for every controller."
    )
    return Table(made, decimals, caption)


def gains(
    frame: pd.DataFrame,
    groups: Sequence[str],
    baseline: str,
    columns: Sequence[str] = (*RATES, *EFFORT),
) -> Table:
    """Return the differences between all controllers and the baseline, in percent, paired by seed.

    Parameters
    ----------
    frame
        As `completed` returns it.
    groups
        Names of columns. Controllers are compared separately for each combination of the values of
        these columns.
    baseline
        Level of the column `controllers` with which all other levels are compared.
    """
    rows: dict[str, dict[tuple[str, str], float]] = {}
    for levels, runs in frame.groupby(list(groups), sort=False):
        where = ", ".join(str(level) for level in levels)
        for controllers in runs[CONTROLLERS].unique():
            if controllers == baseline:
                continue
            rows[f"{where}, {controllers}"] = _percent(runs, controllers, baseline, columns)
    made = rows_frame(rows, ", ".join((*groups, CONTROLLERS)))
    caption = (
        f"Difference to {baseline} in percent, paired by seed, with 95% confidence intervals "
        "(Student's t)."
    )
    return Table(made, {(c, part): 1 for c in columns for part in ("mean", HALF)}, caption)


def of_optimiser(
    frame: pd.DataFrame, groups: Sequence[str], columns: Sequence[str] = (*RATES, *EFFORT)
) -> Table:
    """Return the differences between optimisers and their start rules, in percent, paired by seed.

    Parameters
    ----------
    frame
        As `completed` returns it. Each level of its column `controllers` is compared with the level
        of the same name plus the suffix `START`; levels without such a counterpart are left out.
    groups
        Names of columns. Controllers are compared separately for each combination of the values of
        these columns.
    columns
        Measures to compare.
    """
    rows: dict[str, dict[tuple[str, str], float]] = {}
    for levels, runs in frame.groupby(list(groups), sort=False):
        where = ", ".join(str(level) for level in levels)
        for controllers in runs[CONTROLLERS].unique():
            start = f"{controllers}{START}"
            if not (runs[CONTROLLERS] == start).any():
                continue
            rows[f"{where}, {controllers}"] = _percent(runs, controllers, start, columns)
    caption = (
        "Gain of the optimiser over its own start rule, which is the same controller without "
        "a solver: difference in percent, paired by seed, with 95% confidence intervals "
        "(Student's t)."
    )
    made = rows_frame(rows, ", ".join((*groups, CONTROLLERS)))
    return Table(made, {(c, part): 1 for c in columns for part in ("mean", HALF)}, caption)


def publish_added(
    study: Study,
    frame: pd.DataFrame,
    groups: Sequence[str],
    name: str,
    columns: Sequence[str] = (*RATES, *EFFORT),
) -> None:
    """Publish the table that `of_optimiser` returns, under the name `{name}-optimiser`.

    Nothing is published if no level of the column `controllers` is a start rule.
    """
    if frame[CONTROLLERS].str.endswith(START).any():
        study.publish(of_optimiser(frame, groups, columns), f"{name}-optimiser", columns)


def _percent(
    runs: pd.DataFrame, controllers: str, other: str, columns: Sequence[str]
) -> dict[tuple[str, str], float]:
    """Return the differences between two levels of `controllers` in percent, with intervals.

    A difference is NaN if the other level has a value of 0 with some seed.
    """
    row: dict[tuple[str, str], float] = {}
    for column in columns:
        wide = runs.pivot_table(index="replication", columns=CONTROLLERS, values=column)
        base = wide[other].to_numpy(float)
        found = interval(100 * (wide[controllers] / base - 1) if base.all() else [np.nan])
        row[column, "mean"], row[column, HALF] = found.mean, found.half_width
    return row


def too_few(frame: pd.DataFrame) -> list[str]:
    """Return the names of arms with a run in which optimisers made too few decisions.

    Too few means that `optimiser_decision_share` is below `LEAST_SHARE`. Runs without an optimiser
    are skipped.
    """
    asked = frame[frame["optimiser_calls"] > 0]
    return sorted(asked.loc[asked["optimiser_decision_share"] < LEAST_SHARE, "arm"].unique())


def require_optimised(study: Study, shown: pd.DataFrame | None = None) -> None:
    """End the study with an error if optimisers made too few decisions in a run.

    With the option `--smoke`, runs are too short for many decisions, so there is only a warning.

    Parameters
    ----------
    study
        The study.
    shown
        The runs on which the results are based. Default: all.

    Raises
    ------
    SystemExit
        If a run has too few decisions by optimisers to show their benefit.
    """
    if few := too_few(study.frame if shown is None else shown):
        print(f"too few decisions by optimisers: {'; '.join(few)}", file=sys.stderr)
        if not study.smoke:
            raise SystemExit(FAILED)
