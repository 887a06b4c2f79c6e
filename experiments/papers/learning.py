"""Comparison of look-ahead and trained linear rules with the other rules.

The study has four regimes of the small site, with seeds not used in training. With `--sites`, it
has three regimes of the default and the large site, one of them with look-ahead. Every arm is
compared with the default rules, from which each of them starts, and with the best rule of its
regime. The measure is units picked if there is always a backlog, and late orders if orders arrive
over time. p values are corrected by Holm's method over all arms of a regime. The study takes about
0.15 CPU hours, with `--sites` 0.2.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, cast

import numpy as np

from rmfs.experiments.papers.study import command, done, parser
from rmfs.experiments.statistics import against, interval
from rmfs.experiments.tables import HALF, Table, rows_frame

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.experiments.papers.study import Study

START = "default rules"
REGIME, POLICY = "regime", "policy"
UNITS, LATE = "units_picked", "orders_late"
SHOWN = ("units_per_h", "late_share", "order_turnover_mean_s", "bundles_per_h")


def goal_of(regime: str) -> str:
    """Return the column in which the arms of a regime are compared."""
    return LATE if regime.startswith("arrivals") else UNITS


def is_rule(policy: str) -> bool:
    """Whether an arm is a plain rule, neither trained nor with look-ahead."""
    return not (policy.startswith("linear") or policy.endswith("tried"))


def best_rule(runs: pd.DataFrame, goal: str) -> str:
    """Return the rule with the best mean in a regime: most units, or fewest late orders.

    It is selected with the same seeds as are used in the comparison, which favours it.
    """
    rules = runs[runs[POLICY].map(is_rule)]
    means = rules.groupby(POLICY, sort=False)[goal].mean()
    return str(means.idxmin() if goal == LATE else means.idxmax())


def compared(frame: pd.DataFrame) -> Table:
    """Return means, and gains over the default rules and the best rule, by regime and arm.

    A gain is positive if more units are picked or, with arrivals, fewer orders are late.

    Parameters
    ----------
    frame
        Results of the design.
    """
    rows: dict[str, dict[tuple[str, str], float]] = {}
    for regime, runs in frame.groupby(REGIME, sort=False):
        goal = goal_of(str(regime))
        best = best_rule(runs, goal)
        beside = {
            name: against(runs, goal, baseline, by=POLICY)
            for name, baseline in (("default", START), ("best rule", best))
        }
        for policy in runs[POLICY].unique():
            own = runs[runs[POLICY] == policy]
            row: dict[tuple[str, str], float] = {("seeds", ""): float(len(own))}
            for column in SHOWN:
                found = interval(own[column])
                row[column, "mean"], row[column, HALF] = found.mean, found.half_width
            for name, table in beside.items():
                known = policy in table.index
                told = table.loc[policy] if known else None
                sign = -1.0 if goal == LATE else 1.0
                gain = np.nan if told is None else sign * float(told["difference"])
                half = np.nan if told is None else float(told["high"] - told["low"]) / 2
                row[f"gain on {name}", "mean"] = gain
                row[f"gain on {name}", HALF] = half
                row[f"gain on {name}", "p"] = np.nan if told is None else float(told["p_holm"])
            row["CPU", "s per run"] = float(own["cpu_s"].mean()) if "cpu_s" in own else np.nan
            mark = " (best rule)" if policy == best else ""
            rows[f"{regime}, {policy}{mark}"] = row
    made = rows_frame(rows, f"{REGIME}, {POLICY}")
    columns = cast("list[tuple[str, str]]", list(made.columns))
    decimals = dict.fromkeys(columns, 2)
    decimals |= {("seeds", ""): 0, ("units_per_h", "mean"): 1, ("units_per_h", HALF): 1}
    decimals |= {("late_share", "mean"): 3, ("late_share", HALF): 3}
    decimals |= {(one, part): 4 for one, part in columns if part == "p"}
    caption = (
        "Means over held-out seeds with 95% confidence intervals (Student's t). Gains: more "
        "units picked, or fewer late orders if orders arrive over time, paired by seed; p: "
        "paired t test after Holm's correction within the regime. bundles_per_h: a "
        "controller that stores fewer bundles than others uses up stock."
    )
    return Table(made, decimals, caption)


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    options = parser("learning", __doc__)
    options.add_argument("--sites", action="store_true", help="the default and the large site")
    given = options.parse_args(arguments)
    if given.sites:
        given.design = "learning-sites"
    study: Study = done(given)
    name = study.plan.design.name
    study.publish(compared(study.frame), name, [UNITS, LATE, *SHOWN], confidence=0.95)


if __name__ == "__main__":
    sys.exit(command(main))
