"""PSA and TA models compared with the PSA rule `nearest` and the TA rule `balanced`.

Most arms replace only one of the two rules by a model. The literature finds that storage locations
and tasks matter little for throughput (Merschformann, Lamballais, de Koster, Suhl 2019), but they
affect how far robots drive. Therefore the fleet is so small that driving is the bottleneck, and
metres per unit are shown with units, lines and orders per hour. Bundles per hour are shown as well,
because storing fewer bundles frees robots for a while.

For each kind of demand (a backlog, and orders that arrive over time), there are four tables:
means; differences from the two rules, paired by seed; the gains of four of the models over their
own start rules, also paired by seed; and by whom decisions were made.
"""

from __future__ import annotations

import sys

from rmfs.experiments.papers.benefit import (
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
        shares = means(part[part["optimiser_calls"] > 0], SHARES, by="rules")
        study.publish(shares, f"{name}-decisions", SHARES)


if __name__ == "__main__":
    sys.exit(command(main))
