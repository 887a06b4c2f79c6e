"""The balance of work among pickers, and its cost.

At the small site (layout `small`), orders arrive over time, and two pickers differ in speed and get
tired. The study publishes means of all arms, and differences, paired by seed:

- POA `workload`, which balances open orders over the stations, compared with the default rule
  `pod-match`;
- SA `staffed`, which lets tired pickers rest, compared with stations that are always active, both
  with POA `pod-match`;
- POA `picker-load`, which considers the speed and, in a second arm, also the fatigue of pickers,
  compared with POA `workload`;
- optimisers with balance in their objective, compared with the same optimisers without balance.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from rmfs.experiments.papers.benefit import CONTROLLERS, overview, require_optimised
from rmfs.experiments.papers.study import command, done, parser
from rmfs.experiments.statistics import interval
from rmfs.experiments.tables import HALF, Table, digits, rows_frame

if TYPE_CHECKING:
    import pandas as pd

DECIDED = "decided"
SPREAD = ("picker_work_variation", "picker_fatigue_max")
COSTS = ("units_per_h", "order_turnover_mean_s", "distance_per_unit_m")
COMPARED = (
    ("workload", "pod match"),
    ("picker load", "workload"),
    ("picker load, fatigue", "workload"),
    ("staffed", "pod match"),
    ("pile-on, balance", "pile-on"),
    ("planning, balance", "planning"),
)
"""The pairs of arms that are compared: an arm and its baseline."""


def differences(frame: pd.DataFrame) -> Table:
    """Return the differences between the arms of each pair in `COMPARED`, paired by seed.

    Each difference is the value of the arm minus that of its baseline, in the unit of the column.

    Parameters
    ----------
    frame
        Runs of the design.
    """
    rows: dict[str, dict[tuple[str, str], float]] = {}
    for one, other in COMPARED:
        row: dict[tuple[str, str], float] = {}
        for column in (*SPREAD, *COSTS):
            wide = frame.pivot_table(index="replication", columns=DECIDED, values=column)
            found = interval(wide[one] - wide[other])
            row[column, "mean"], row[column, HALF] = found.mean, found.half_width
        rows[f"{one} less {other}"] = row
    made = rows_frame(rows, "compared")
    decimals: dict[tuple[str, str], int] = {}
    for column in (*SPREAD, *COSTS):
        shown = digits(made[column, HALF], made[column, "mean"])
        decimals |= {(column, part): shown for part in ("mean", HALF)}
    caption = "Differences paired by seed, with 95% confidence intervals (Student's t)."
    return Table(made, decimals, caption)


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    study = done(parser("pickers", __doc__).parse_args(arguments))
    frame = study.frame.assign(**{CONTROLLERS: study.frame[DECIDED]})
    columns = (*SPREAD, *COSTS)
    study.publish(overview(frame, (CONTROLLERS,), columns), "pickers", columns)
    study.publish(differences(frame), "pickers-differences", columns)
    require_optimised(study)


if __name__ == "__main__":
    sys.exit(command(main))
