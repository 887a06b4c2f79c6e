"""Orders on time: rules against an optimiser that knows due times.

The small site with tight, medium and slack due times. The optimiser is TA planning with tardiness
in its objective (`late_s`); beside it stand the same with its thinking charged (pacing `work`), its
start rule, and planning without due times. Published are means, and differences of on-time shares
in points, seed by seed: to the best of the rules, chosen in favour of the rules from the same runs,
and to the start rule.
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
OTHERS = ("optimiser, work", "start rule", "without due times")
"""What is no rule besides the optimiser."""

COLUMNS = (
    *(SHARE, "lateness_p95_s", "late_by_mean_s", "orders_overdue_end"),
    *("orders_per_h", "units_per_visit", "distance_per_unit_m"),
)


def best_rule(runs: pd.DataFrame) -> str:
    """Return the rule with the highest mean on-time share among runs of one kind of due times."""
    rules = runs[~runs[DECIDED].isin([OPTIMISER, *OTHERS])]
    return str(rules.groupby(DECIDED)[SHARE].mean().idxmax())


def differences(frame: pd.DataFrame) -> Table:
    """Return by how many points more orders are on time, by due times and whom it is compared with.

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
        "Differences of on-time shares in points, seed by seed, with 95% confidence intervals "
        "(Student's t). The best rule is the one with the highest mean in these runs, which "
        "favours the rules."
    )
    return Table(rows_frame(rows, "due, compared"), decimals, caption)


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    study = done(parser("service", __doc__).parse_args(arguments))
    frame = study.frame.assign(**{CONTROLLERS: study.frame[DECIDED]})
    study.publish(overview(frame, (DUE, CONTROLLERS), COLUMNS), "service", COLUMNS)
    study.publish(differences(frame), "service-gains", (SHARE,))
    require_optimised(study)


if __name__ == "__main__":
    sys.exit(command(main))
