"""The cost of charging: robots needed with each kind of battery recovery; rules of CA compared.

The study simulates fleets of different sizes. It uses the design `charging` at the default site
(layout `default`) or, with `--large`, the design `charging-large` at the large site (layout
`large`). There are four cases: robots without batteries, plug-in chargers, swap stations, and queue
waypoints that charge waiting robots. The study publishes units per hour and the number of robots
needed for 95 % of the capacity of the pick stations (interpolated between fleets, seed by seed). It
also publishes by how many percent this number exceeds the number needed without batteries.

With `--rules`, a single fleet size is simulated, with charge assignment (CA) by each of the rules
and by the optimiser. The study then publishes differences from runs without batteries and from runs
under the rule `threshold`, paired by seed. The design is `charging-rules` or, with `--demand`,
`charging-demand`, in which periods of high and low demand alternate.

For comparison, Zou et al. (2018, doi 10.1016/j.ejor.2017.12.008) report that the number of robots
is underestimated by more than 15 % if battery recovery is ignored, and that swapping shortens the
retrieval time by at most 4.88 %, compared with plug-in charging.
"""

from __future__ import annotations

import sys
from math import nan
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from rmfs.experiments.papers.benefit import completed
from rmfs.experiments.papers.study import Study, command, done, parser, station_units_per_h
from rmfs.experiments.statistics import interval
from rmfs.experiments.tables import HALF, Table, differences, means, rows_frame

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

ROBOTS, RECOVERY, RULE = "layout.robots", "recovery", "rule"
NONE = "none"
_FIGURES = [(column, part) for column in ("robots", "more, %") for part in ("mean", HALF)]
ENOUGH = 0.95
"""Share of the stations' capacity that a fleet should reach."""

COLUMNS = ("units_per_h", "station_share", "order_throughput_time_median_s", "energy_wh_per_unit")
OF_BATTERIES = (
    *("charging_share", "charge_task_share", "energy_charged_kwh"),
    *("battery_level_least_share", "robots_stranded"),
)
RULE_COLUMNS = ("units_per_h", "order_turnover_mean_s", "battery_gain_kwh")
START_RULE = "threshold"


def robots_for(robots: Sequence[float], share: Sequence[float], enough: float = ENOUGH) -> float:
    """Return the fleet size that reaches a share of the stations' capacity, by interpolation.

    Parameters
    ----------
    robots
        Sizes of fleets, ascending.
    share
        Share of the capacity that each fleet reaches. Its running maximum is used, so that noise
        cannot make the share decrease with the fleet size.
    enough
        Share to be reached.

    Returns
    -------
    The fleet size; nan if the smallest fleet already reaches this share, or no fleet does.
    """
    reached: NDArray[np.float64] = np.maximum.accumulate(np.asarray(share, np.float64))
    if reached[0] >= enough or reached[-1] < enough:
        return nan
    more = int(np.argmax(reached >= enough))
    part = (enough - reached[more - 1]) / (reached[more] - reached[more - 1])
    return float(robots[more - 1] + part * (robots[more] - robots[more - 1]))


def needed(frame: pd.DataFrame, enough: float = ENOUGH) -> Table:
    """Return the number of robots needed with each kind of battery recovery.

    The table also shows by how many percent this number exceeds the one needed without batteries.

    Parameters
    ----------
    frame
        Runs with `layout.robots`, `recovery`, `replication` and `station_share`.
    """
    found_for = [
        {
            RECOVERY: recovery,
            "replication": seed,
            "robots": robots_for(runs[ROBOTS].tolist(), runs["station_share"].tolist(), enough),
        }
        for (recovery, seed), runs in frame.sort_values(ROBOTS).groupby([RECOVERY, "replication"])
    ]
    each = pd.DataFrame(found_for).pivot_table(
        index="replication", columns=RECOVERY, values="robots", dropna=False
    )
    rows: dict[str, dict[tuple[str, str], float]] = {}
    for recovery in frame[RECOVERY].unique():
        row = dict.fromkeys(_FIGURES, nan)
        # without the seeds that no fleet is enough for, the mean would be too small
        if each[recovery].notna().all():
            row |= _figures("robots", each[recovery])
        if recovery != NONE and each[[recovery, NONE]].notna().all(axis=None):
            row |= _figures("more, %", 100 * (each[recovery] / each[NONE] - 1))
        rows[str(recovery)] = row | {("seeds", ""): float(each[recovery].count())}
    decimals = {
        **{("robots", "mean"): 2, ("robots", HALF): 2, ("more, %", "mean"): 1},
        **{("more, %", HALF): 1, ("seeds", ""): 0},
    }
    caption = (
        f"Robots needed for {enough:.0%} of the pick stations' capacity, interpolated between "
        "fleets and paired by seed, and how many more these are than without batteries; 95% "
        "confidence intervals (Student's t); no figure if, for some seed, no fleet of the "
        "design reaches this capacity or all fleets do."
    )
    return Table(rows_frame(rows, "recovery"), decimals, caption)


def _figures(column: str, values: pd.Series) -> dict[tuple[str, str], float]:
    """Return the entries of a row for a mean and its interval."""
    found = interval(values)
    return {(column, "mean"): found.mean, (column, HALF): found.half_width}


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish its results."""
    options = parser("charging", __doc__)
    options.add_argument("--large", action="store_true", help="use the large site instead")
    options.add_argument("--rules", action="store_true", help="compare the rules of CA instead")
    options.add_argument("--demand", action="store_true", help="with --rules: use changing demand")
    given = options.parse_args(arguments)
    if given.demand and not given.rules:
        options.error("--demand: only with --rules")
    if given.rules:
        name = "charging-demand" if given.demand else "charging-rules"
        given.design = name
        _publish_rules(done(given), name)
        return
    name = given.design = "charging-large" if given.large else given.design
    study = done(given)
    frame = completed(study.frame, station_units_per_h(study))
    study.publish(means(frame, COLUMNS), name, COLUMNS)
    batteries = _real(frame[frame[RECOVERY] != NONE])
    study.publish(means(batteries, OF_BATTERIES), f"{name}-batteries", OF_BATTERIES)
    study.publish(needed(frame), f"{name}-needed", ("station_share",))


def _publish_rules(study: Study, name: str) -> None:
    """Publish the means of each rule, and differences from no batteries and the start rule."""
    gained = study.frame["energy_charged_kwh"].astype("float64") - study.frame["energy_kwh"]
    frame = study.frame.assign(battery_gain_kwh=gained)
    shown = ("units_per_h", "order_turnover_mean_s", *OF_BATTERIES, "decision_wall_s")
    batteries = frame[frame[RULE] != "no batteries"]
    study.publish(means(_real(batteries), shown, by=RULE), name, shown)
    table = differences(frame, RULE_COLUMNS[:2], "no batteries", by=RULE)
    study.publish(table, f"{name}-differences", RULE_COLUMNS[:2])
    table = differences(batteries, RULE_COLUMNS, START_RULE, by=RULE)
    study.publish(table, f"{name}-optimiser", RULE_COLUMNS)


def _real(frame: pd.DataFrame) -> pd.DataFrame:
    """Return the frame with counts as real numbers, so that means can be taken."""
    return frame.astype(dict.fromkeys(OF_BATTERIES, "float64"))


if __name__ == "__main__":
    sys.exit(command(main))
