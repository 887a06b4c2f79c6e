"""Look-ahead, trained linear rules, networks and optimisers compared with plain rules.

A linear rule chooses the candidate with the greatest score, a weighted sum of features. In a
network rule, a network trained by PPO (proximal policy optimisation) computes the scores.
Look-ahead tries out decisions in copies of the run (docs: learning).

A regime is a combination of a site, a kind of demand and a number of robots. The study has four
regimes at the small site (layout `small`) or, with `--sites`, one at the default site and one at
the large site (layouts `default` and `large`). With `--ppo`, the study contains the networks, but
not look-ahead. The seeds were not used in training.

Every arm is compared with the default rules and with the best plain rule of its regime. In regimes
with a backlog, the measure is the number of units picked. In regimes with orders that arrive over
time, it is the number of late orders: those completed late, plus those overdue at the end. p values
are corrected by Holm's method over all arms of a regime. A bound that holds for all controllers,
even if they know the future, shows how much improvement is possible.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, cast

import numpy as np

from rmfs.experiments.papers.late_bound import fewest_late
from rmfs.experiments.papers.study import command, done, parser
from rmfs.experiments.statistics import against, interval
from rmfs.experiments.tables import HALF, Table, rows_frame

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import pandas as pd

    from rmfs.experiments.papers.study import Study

START = "default rules"
REGIME, POLICY = "regime", "policy"
UNITS, LATE = "units_picked", "late_or_overdue"
SHOWN = ("on_time_share", "order_turnover_mean_s", "bundles_per_h")
COLUMNS = (UNITS, "orders_late", "orders_overdue_end", "units_per_h_bound", *SHOWN)
NOT_RULES = ("linear", "PPO", "tried", "optimiser")
"""Words in the names of arms that are not plain rules."""


def goal_of(regime: str) -> str:
    """Return the name of the column by which the arms of a regime are compared."""
    return LATE if regime.startswith("arrivals") else UNITS


def is_rule(policy: str) -> bool:
    """Return whether an arm has plain rules only: untrained, without look-ahead or optimiser."""
    return not any(word in policy for word in NOT_RULES)


def is_linear(policy: str) -> bool:
    """Return whether an arm has linear rules."""
    return policy.startswith("linear")


def best_rule(runs: pd.DataFrame, goal: str, among: Callable[[str], bool] = is_rule) -> str:
    """Return the plain rule with the best mean in a regime: most units, or fewest late orders.

    The comparisons favour this rule, because it is selected from the same runs.

    Parameters
    ----------
    runs
        Runs of the regime.
    goal
        Column by which the arms are compared.
    among
        Function that returns whether an arm can be selected. Default: only plain rules.
    """
    rules = runs[runs[POLICY].map(among)]
    means = rules.groupby(POLICY, sort=False)[goal].mean()
    return str(means.idxmin() if goal == LATE else means.idxmax())


def with_goals(frame: pd.DataFrame) -> pd.DataFrame:
    """Add the column `LATE`: number of orders completed late, plus those overdue at the end."""
    return frame.assign(**{LATE: frame["orders_late"] + frame["orders_overdue_end"]})


def most_units(runs: pd.DataFrame) -> float:
    """Return an upper bound on the units that any controller can pick in any of these runs."""
    return float((runs["units_per_h_bound"] * runs["duration_s"]).max() / 3600.0)


def fewest_late_mean(orders: pd.DataFrame, stations: int, unit_s: float) -> float:
    """Return a lower bound on the mean of the column `LATE`, late orders per run.

    Parameters
    ----------
    orders
        Table `orders` of the runs of one arm, with the additional columns `replication`, `start_s`
        and `end_s` (start and end of the run's measured time). The bound considers the orders due
        in the measured time. Orders that the arm completed before this time are not in the table;
        without them, the bound is weaker but still valid.
    stations
        Number of pick stations.
    unit_s
        Minimum time from one unit to the next at a station, in s.
    """
    found = []
    for _, run in orders.groupby("replication"):
        counted = run[(run["due_s"] >= run["start_s"]) & (run["due_s"] < run["end_s"])]
        # the unit that is picked at the due time is still being handled after it
        due_s = counted["due_s"].to_numpy() + unit_s
        work_s = counted["units"].to_numpy() * unit_s
        found.append(fewest_late(counted["created_s"].to_numpy(), due_s, work_s, stations))
    return float(np.mean(found))


def compared(frame: pd.DataFrame, at_best: Mapping[str, float]) -> Table:
    """Return means, and gains over the default rules and the best plain rule, by regime and arm.

    If the results contain networks trained by PPO, gains over the best linear rule are added. A
    gain is positive if an arm is better: if more units are picked or fewer orders are late,
    depending on the measure of the regime.

    Parameters
    ----------
    frame
        Results of the design, as `with_goals` returns them.
    at_best
        Bound of each regime: an upper bound on units picked, or a lower bound on late orders.
    """
    networks = frame[POLICY].str.startswith("PPO").any()
    rows: dict[str, dict[tuple[str, str], float]] = {}
    for name, runs in frame.groupby(REGIME, sort=False):
        regime = str(name)
        goal = goal_of(regime)
        sign = -1.0 if goal == LATE else 1.0
        best = best_rule(runs, goal)
        baselines = {"default": START, "best rule": best}
        if networks:
            baselines["best linear rule"] = best_rule(runs, goal, is_linear)
        beside = {
            label: against(runs, goal, baseline, by=POLICY) for label, baseline in baselines.items()
        }
        room = sign * (at_best[regime] - float(runs[runs[POLICY] == START][goal].mean()))
        for policy in runs[POLICY].unique():
            own = runs[runs[POLICY] == policy]
            row: dict[tuple[str, str], float] = {("seeds", ""): float(len(own))}
            found = interval(own[goal])
            row["goal", "mean"], row["goal", HALF] = found.mean, found.half_width
            row["bound", ""] = at_best[regime]
            for label, table in beside.items():
                known = policy in table.index
                given = table.loc[policy] if known else None
                gain = np.nan if given is None else sign * float(given["difference"])
                half = np.nan if given is None else float(given["high"] - given["low"]) / 2
                row[f"gain on {label}", "mean"] = gain
                row[f"gain on {label}", HALF] = half
                row[f"gain on {label}", "p"] = np.nan if given is None else float(given["p_holm"])
            row["share of the room", ""] = row["gain on default", "mean"] / room
            for column in SHOWN:
                found = interval(own[column])
                row[column, "mean"], row[column, HALF] = found.mean, found.half_width
            row["CPU", "s per run"] = float(own["cpu_s"].mean()) if "cpu_s" in own else np.nan
            mark = " (best rule)" if policy == best else ""
            rows[f"{regime}, {policy}{mark}"] = row
    made = rows_frame(rows, f"{REGIME}, {POLICY}")
    columns = cast("list[tuple[str, str]]", list(made.columns))
    decimals = dict.fromkeys(columns, 2)
    decimals |= {("seeds", ""): 0, ("goal", "mean"): 1, ("goal", HALF): 1, ("bound", ""): 1}
    decimals |= {(one, part): 3 for one, part in columns if one == "on_time_share"}
    decimals |= {(one, part): 4 for one, part in columns if part == "p"}
    caption = (
        "Means over held-out seeds with 95% confidence intervals (Student's t). goal: units picked "
        "per run or, in the regimes with arrivals, orders completed late or overdue at the end. "
        "bound: no controller can pick more units, or have fewer late orders, whatever it knows; "
        "share of the room: gain on the default rules divided by the distance of these rules from "
        "the bound. Gains are paired by seed; p: paired t test after Holm's correction within the "
        "regime. TA tried: look-ahead by TA rollout. PPO: network rules. bundles_per_h: a "
        "controller that stores fewer bundles than others uses up stock."
    )
    return Table(made, decimals, caption)


def bounds(study: Study, frame: pd.DataFrame) -> dict[str, float]:
    """Return the bound of each regime: on units picked (upper) or on late orders (lower)."""
    found = {}
    for name, runs in frame.groupby(REGIME, sort=False):
        regime = str(name)
        if goal_of(regime) == UNITS:
            found[regime] = most_units(runs)
            continue
        rules = runs[runs[POLICY] == START]
        arm = next(one for one in study.plan.arms if one.levels == {REGIME: name, POLICY: START})
        stations = study.layout(arm).pick_stations
        orders = study.table("orders")
        orders = orders[(orders[REGIME] == regime) & (orders[POLICY] == START)]
        window = rules.set_index("replication")[["warmup_s", "duration_s"]]
        orders = orders.join(window, on="replication")
        orders = orders.assign(
            start_s=orders["warmup_s"], end_s=orders["warmup_s"] + orders["duration_s"]
        )
        unit_s = min(max(one.unit_transfer_s, one.unit_pick_s) for one in stations)
        found[regime] = fewest_late_mean(orders, len(stations), unit_s)
    return found


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    options = parser("learning", __doc__)
    options.add_argument("--sites", action="store_true", help="the default and the large site")
    options.add_argument(
        "--ppo", action="store_true", help="with networks trained by PPO, but without look-ahead"
    )
    given = options.parse_args(arguments)
    if given.sites or given.ppo:
        given.design = f"learning{'-ppo' if given.ppo else ''}{'-sites' if given.sites else ''}"
    study: Study = done(given)
    frame = with_goals(study.frame)
    table = compared(frame, bounds(study, frame))
    study.publish(table, study.plan.design.name, COLUMNS, confidence=0.95)


if __name__ == "__main__":
    sys.exit(command(main))
