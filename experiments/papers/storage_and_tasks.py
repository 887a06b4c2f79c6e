"""PSA and TA models against the rules nearest and balanced, one decision at a time.

The literature finds that storage places and tasks matter little for throughput (Merschformann,
Lamballais, de Koster, Suhl 2019); what matters is the driving. So the fleet is small, ways bind,
and metres per unit stand beside units, lines and orders per hour. Bundles per hour are shown as
well: who stores fewer has robots to spare for a while. Each kind of demand has its own
tables: means, and differences to the rules seed by seed.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from experiments.papers.study import FAILED, command, done, parser
from experiments.tables import differences, means

if TYPE_CHECKING:
    import pandas as pd

RULES = "nearest, balanced"
COLUMNS = (
    "units_per_h",
    "lines_per_h",
    "orders_per_h",
    "distance_per_unit_m",
    "units_per_visit",
    "bundles_per_h",
)
DECIDED = (
    "optimiser_decision_share",
    "heuristic_decision_share",
    "stale_decision_share",
    "failed_decision_share",
    "optimiser_wall_median_s",
)
ENOUGH = 0.9
"""Share of decisions that must come from the optimiser for a run to say anything about it."""


def too_few(frame: pd.DataFrame) -> list[str]:
    """Return the arms in which some run has too few decisions by the optimiser."""
    asked = frame[frame["optimiser_calls"] > 0]
    return sorted(asked.loc[asked["optimiser_decision_share"] < ENOUGH, "arm"].unique())


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    study = done(parser("storage-and-tasks", __doc__).parse_args(arguments))
    frame = study.frame
    if few := too_few(frame):
        print(f"too few decisions by the optimiser: {', '.join(few)}", file=sys.stderr)
        raise SystemExit(FAILED)
    for demand in frame["demand"].unique():
        part = frame[frame["demand"] == demand]
        name = f"storage-and-tasks-{demand}"
        study.publish(means(part, COLUMNS, by="rules"), name, COLUMNS)
        compared = differences(part, COLUMNS, RULES, by="rules")
        study.publish(compared, f"{name}-differences", COLUMNS)
    shares = means(frame[frame["optimiser_calls"] > 0], DECIDED, by="rules")
    study.publish(shares, "storage-and-tasks-decisions", DECIDED)


if __name__ == "__main__":
    sys.exit(command(main))
