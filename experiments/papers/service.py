"""Orders on time: rules compared with an optimiser that considers due times.

The study uses the small site (layout `small`) with tight, medium and slack due times. The optimiser
is TA planning with tardiness in its objective (`late_s`). It is simulated in two ways: its answers
take no time, or they take simulated time in proportion to their computation (pacing `work`).

The study publishes means, and the optimiser's gains in on-time share over several baselines, in
percentage points and paired by seed. The baselines are:

- the best of the rules, which is favoured because it is selected from the same runs,
- the optimiser's start rule, and
- TA planning that ignores due times (only if answers take no time).

`--priorities` uses three classes of orders with different weights, and shows gains for the first
class (urgent) and for the two other classes together (ordinary).
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from rmfs.experiments.papers.benefit import CONTROLLERS, overview, require_optimised
from rmfs.experiments.papers.study import command, done, parser
from rmfs.experiments.statistics import interval
from rmfs.experiments.tables import HALF, Table, rows_frame

if TYPE_CHECKING:
    import pandas as pd

DUE, DECIDED, SHARE = "due", "decided", "on_time_share"
OPTIMISER = "optimiser"
OTHERS = ("optimiser, work", "start rule", "without due times", "equal weights")
"""Arms that, like the optimiser itself, cannot be the best rule."""

COLUMNS = (
    *(SHARE, "lateness_p95_s", "late_by_mean_s", "orders_overdue_end"),
    *("orders_per_h", "units_per_visit", "distance_per_unit_m"),
)


def best_rule(runs: pd.DataFrame) -> str:
    """Return the rule with the highest mean on-time share in the given runs."""
    rules = runs[~runs[DECIDED].isin([OPTIMISER, *OTHERS])]
    return str(rules.groupby(DECIDED)[SHARE].mean().idxmax())


def differences(frame: pd.DataFrame) -> Table:
    """Return the optimiser's gains in on-time share over the baselines, in percentage points.

    Each row states the due times (tight, medium or slack), the arm of the optimiser (`optimiser`,
    or `optimiser, work` with pacing `work`), and the baseline.

    Parameters
    ----------
    frame
        Runs of the design.
    """
    rows: dict[str, dict[tuple[str, str], float]] = {}
    for due, runs in frame.groupby(DUE, sort=False):
        wide = 100 * runs.pivot_table(index="replication", columns=DECIDED, values=SHARE)
        rule = best_rule(runs)
        for one, other, told in (
            (OPTIMISER, rule, f"best rule ({rule})"),
            (OPTIMISER, "start rule", "its start rule"),
            (OPTIMISER, "without due times", "without due times"),
            ("optimiser, work", rule, f"best rule ({rule})"),
            ("optimiser, work", "start rule", "its start rule"),
        ):
            found = interval(wide[one] - wide[other])
            rows[f"{due}, {one} against {told}"] = {
                (f"{SHARE}, points", "mean"): found.mean,
                (f"{SHARE}, points", HALF): found.half_width,
            }
    decimals = {(f"{SHARE}, points", part): 1 for part in ("mean", HALF)}
    caption = (
        "Differences of on-time shares in percentage points, paired by seed, with 95% "
        "confidence intervals (Student's t). The best rule is the one with the highest mean "
        "in these runs, which favours the rules."
    )
    return Table(rows_frame(rows, "due, compared"), decimals, caption)


BY_CLASS = ("on_time_urgent_share", "on_time_ordinary_share")


def differences_by_class(frame: pd.DataFrame) -> Table:
    """Return the optimiser's gains in on-time share, for urgent and for ordinary orders.

    Gains are in percentage points, over three baselines: the rule that is best for urgent orders,
    the start rule, and the optimiser with equal weights for all classes.

    Parameters
    ----------
    frame
        Runs of the design with priorities.
    """
    chosen = frame[~frame[DECIDED].isin([OPTIMISER, *OTHERS])]
    rule = str(chosen.groupby(DECIDED)[BY_CLASS[0]].mean().idxmax())
    rows: dict[str, dict[tuple[str, str], float]] = {}
    for other in (rule, "start rule", "equal weights"):
        row: dict[tuple[str, str], float] = {}
        for share in BY_CLASS:
            wide = 100 * frame.pivot_table(index="replication", columns=DECIDED, values=share)
            found = interval(wide[OPTIMISER] - wide[other])
            row[f"{share}, points", "mean"] = found.mean
            row[f"{share}, points", HALF] = found.half_width
        rows[f"best rule ({rule})" if other == rule else other] = row
    caption = (
        "Differences of the optimiser's on-time shares to others, in percentage points, "
        "paired by seed, with 95% confidence intervals (Student's t). The best rule is the "
        "one with the highest on-time share of urgent orders in these runs. equal weights: "
        "the optimiser, every class of weight 1."
    )
    made = rows_frame(rows, "against")
    return Table(made, {key: 1 for row in rows.values() for key in row}, caption)


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    options = parser("service", __doc__)
    options.add_argument("--priorities", action="store_true", help="use classes of orders instead")
    given = options.parse_args(arguments)
    if given.priorities and given.design == "service":
        given.design = "service-priorities"
    study = done(given)
    frame = study.frame.assign(**{CONTROLLERS: study.frame[DECIDED]})
    if given.priorities:
        columns = (*BY_CLASS, *COLUMNS)
        means = overview(frame, (CONTROLLERS,), columns)
        study.publish(means, "service-priorities", columns)
        study.publish(differences_by_class(frame), "service-priorities-gains", BY_CLASS)
        require_optimised(study)
        return
    study.publish(overview(frame, (DUE, CONTROLLERS), COLUMNS), "service", COLUMNS)
    study.publish(differences(frame), "service-gains", (SHARE,))
    # where answers take the time of their work, some are stale: that is what this arm shows
    require_optimised(study, frame[~frame[CONTROLLERS].str.endswith(", work")])


if __name__ == "__main__":
    sys.exit(command(main))
