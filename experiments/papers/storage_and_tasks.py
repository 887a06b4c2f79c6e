"""PSA and TA models against the rules nearest and balanced, one decision at a time.

The literature finds that storage places and tasks matter little for throughput (Merschformann,
Lamballais, de Koster, Suhl 2019); what matters is the driving. So the fleet is small, ways bind,
and metres per unit stand beside units, lines and orders per hour. Bundles per hour are shown as
well: who stores fewer has robots to spare for a while. Each kind of demand has its own
tables: means, differences to the rules, and what each model adds to its own start rule, seed by
seed.
"""

from __future__ import annotations

import sys

from rmfs.experiments.papers.benefit import (
    DECISION_S,
    SHARES,
    START,
    completed,
    publish_added,
    require_optimised,
)
from rmfs.experiments.papers.study import command, done, parser, station_units_per_h
from rmfs.experiments.tables import differences, means

RULES = "nearest, balanced"
COLUMNS = (
    "units_per_h",
    "lines_per_h",
    "orders_per_h",
    "distance_per_unit_m",
    "units_per_visit",
    "bundles_per_h",
)
DECIDED = (*SHARES, DECISION_S)


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    study = done(parser("storage-and-tasks", __doc__).parse_args(arguments))
    frame, each = study.frame, station_units_per_h(study)
    require_optimised(study)
    for demand in frame["demand"].unique():
        part = completed(frame[frame["demand"] == demand], each)
        name = f"storage-and-tasks-{demand}"
        study.publish(means(part, COLUMNS, by="rules"), name, COLUMNS)
        solved = part[~part["rules"].str.endswith(START)]
        compared = differences(solved, COLUMNS, RULES, by="rules")
        study.publish(compared, f"{name}-differences", COLUMNS)
        publish_added(study, part, ("demand",), name, COLUMNS)
    shares = means(frame[frame["optimiser_calls"] > 0], DECIDED, by="rules")
    study.publish(shares, "storage-and-tasks-decisions", DECIDED)


if __name__ == "__main__":
    sys.exit(command(main))
