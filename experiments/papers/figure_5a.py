"""Figure 5a: the PSA rule is exchanged in the middle of a day (Merschformann, Xie, Li 2018).

The paper shows one run of 24 h in which nearest storage replaces random storage after half of the
time: from then on, the robots drive less and complete more orders. Here three arms are run with ten
seeds on a layout of the same size as the layout MaTiMilli of RAWSim-O: one with the exchange, one
with random storage throughout, and one with nearest storage throughout. The effect of the exchange
is a difference in differences, paired by seed: the difference between the second and the first half
in the arm with the exchange, minus that in the arm with random storage throughout.

With `--reference DIR` (the folder of RAWSim-O's public instances), the original layout
`DIR/mati/MaTiMilli.xinst` is used instead; the names of published files then end in `-reference`.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from rmfs.experiments.figures import progression
from rmfs.experiments.figures.style import COLOURS, axis_label, saving
from rmfs.experiments.papers.study import command, done, parser
from rmfs.experiments.statistics import paired, rates
from rmfs.experiments.tables import HALF, Table, digits

if TYPE_CHECKING:
    from rmfs.experiments.papers.study import Study

STAYS, CHANGES = "random throughout", "random, then nearest"
NEAREST = "nearest throughout"
COLUMNS = ("orders_completed", "units_picked", "distance_m")
SHOWN = {"orders_completed": "orders", "units_picked": "units", "distance_m": "distance"}
SETTLED_S = 3600.0
"""Time left out at the beginning of each half, in s."""


def halves(series: pd.DataFrame, *, settle_s: float = SETTLED_S) -> pd.DataFrame:
    """Return each run's orders, units and metres per hour before and after the exchange.

    For arms without an exchange, `before` and `after` are the first and the second half of the run.

    Parameters
    ----------
    series
        The time series of the runs.
    settle_s
        Time left out at the beginning of each half, in s.

    Returns
    -------
    One row per arm, replication and half (`before`, `after`).
    """
    middle_s = float(series["time_s"].max()) / 2.0
    parts = {
        "before": rates(series, COLUMNS, start_s=settle_s, end_s=middle_s),
        "after": rates(series, COLUMNS, start_s=middle_s + settle_s),
    }
    return pd.concat([part.assign(half=name) for name, part in parts.items()], ignore_index=True)


def differences(rated: pd.DataFrame, confidence: float = 0.95) -> pd.DataFrame:
    """Return the effect of the exchange, one row per measure.

    Returns
    -------
    The mean in each half for two arms (random storage throughout, and the exchange); the difference
    in differences, with its confidence interval, p value and number of seeds; and the column
    `relative`, which is the difference in differences divided by the mean of the second half with
    random storage throughout.
    """
    rows = {}
    for column in COLUMNS:
        wide = rated.pivot_table(index="replication", columns=["arm", "half"], values=column)
        changed = wide[CHANGES, "after"] - wide[CHANGES, "before"]
        stayed = wide[STAYS, "after"] - wide[STAYS, "before"]
        found = paired(changed, stayed, confidence=confidence)
        rows[SHOWN[column]] = {
            **{
                f"{arm}: {half}": float(wide[arm, half].mean())
                for arm in (STAYS, CHANGES)
                for half in ("before", "after")
            },
            "difference": found["difference"],
            "low": found["low"],
            "high": found["high"],
            "relative": found["difference"] / float(wide[STAYS, "after"].mean()),
            "p": found["p"],
            "seeds": found["pairs"],
        }
    made = pd.DataFrame.from_dict(rows, orient="index")
    made.index.name = "per hour"
    return made


def as_table(found: pd.DataFrame) -> Table:
    """Return the result of `differences` as a table to publish."""
    half = (found["high"] - found["low"]) / 2
    percent = 100 * found["relative"]
    parts = {
        **{(str(c), ""): found[c] for c in found if ": " in str(c)},
        ("difference in differences", "difference"): found["difference"],
        ("difference in differences", HALF): half,
        ("%", ""): percent,
        ("p", ""): found["p"],
        ("seeds", ""): found["seeds"].astype(int),
    }
    frame = pd.DataFrame(parts)
    frame.columns = pd.MultiIndex.from_tuples(list(parts))
    decimals = {column: digits(half, found["difference"]) for column in parts}
    decimals |= {("%", ""): 1, ("p", ""): 4, ("seeds", ""): 0}
    caption = (
        "Storage rule exchanged (random, then nearest) against kept (random): rates per hour "
        "in the two halves of 24 h, difference in differences, paired by seed, with 95% "
        "confidence interval (Student's t)."
    )
    return Table(frame, decimals, caption)


def picture(study: Study, series: pd.DataFrame) -> Path:
    """Plot orders and distance per hour over time, for each arm."""
    path = study.place("figure-5a.png")
    colours = {STAYS: "0.55", CHANGES: COLOURS[1], NEAREST: COLOURS[0]}
    series = series.assign(distance_m=series["distance_m"] / 1000.0)
    labels = {
        "orders_completed": axis_label("orders_completed", "series", per="hour"),
        "distance_m": "distance (km per hour)",
    }
    middle_h = float(series["time_s"].max()) / 7200.0
    bin_s = min(3600.0, float(series["time_s"].max()) / 24)
    with saving(path, 7.0, 5.2) as figure:
        axes = figure.subplots(2, 1, sharex=True)
        for ax, (column, label) in zip(axes, labels.items(), strict=True):
            progression(series, column, ax, bin_s=bin_s, colours=colours)
            ax.axvline(middle_h, color="black", linewidth=0.8, linestyle=":")
            ax.set_ylabel(label)
            ax.label_outer()
        axes[0].legend(fontsize=8, title="pod storage assignment", loc=(0.13, 0.03))
        seeds = study.frame["replication"].nunique()
        axes[0].set_title(
            f"Pod storage rule exchanged after {middle_h:g} h; mean of {seeds} seeds with 95 % "
            "intervals",
            fontsize=9,
        )
    study.record(path, ["orders_completed", "distance_m"], kind="progression", confidence=0.95)
    return path


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    options = parser("psa-exchange", __doc__, reference="mati/MaTiMilli.xinst")
    study = done(options.parse_args(arguments))
    series = study.table("series")
    settle_s = min(SETTLED_S, float(series["time_s"].max()) / 24)
    found = differences(halves(series, settle_s=settle_s))
    study.publish(as_table(found), "figure-5a", list(COLUMNS), settled_s=settle_s)
    print(picture(study, series))


if __name__ == "__main__":
    sys.exit(command(main))
