"""The benefit of planning ahead: TA planning compared with its own start rule.

TA planning, an optimiser that plans several visits ahead, is run at the small site (layout `small`)
with three to five robots or, with `--large`, at the large site (layout `large`) with 20 and with 30
robots. Orders are not split; they come from a backlog or arrive over time. The start rule is the
same controller with `method = "greedy"` and otherwise the same parameters: it also continues the
previous plan, but does not search. With `--anticipation`, the comparison is not with the start
rule: TA planning that considers future orders is compared with TA planning that ignores them. The
tables also show stored bundles and used space, because a controller that stores fewer bundles has
more robots for picking, but only for a while.
"""

from __future__ import annotations

import sys

from rmfs.experiments.papers.benefit import (
    CONTROLLERS,
    completed,
    gains,
    overview,
    require_optimised,
)
from rmfs.experiments.papers.study import command, done, parser, station_units_per_h

START_RULE = "start rule"
GROUPS = ("demand", "layout.robots")
COLUMNS = (
    "units_per_h",
    "station_share",
    "units_per_visit",
    "distance_per_unit_m",
    "orders_per_h",
    "late_share",
    "bundles_per_h",
    "inventory_share_mean",
)
GAINED = ("units_per_h", "distance_per_unit_m", "units_per_visit", "orders_per_h", "bundles_per_h")


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    options = parser("planning", __doc__)
    other = options.add_mutually_exclusive_group()
    other.add_argument("--large", action="store_true", help="use the large site instead")
    other.add_argument(
        "--anticipation",
        action="store_true",
        help="compare with planning that considers future orders instead",
    )
    given = options.parse_args(arguments)
    name, baseline = "planning", START_RULE
    if given.large:
        name = given.design = "planning-large"
    elif given.anticipation:
        name, baseline = "anticipation", "planning"
        given.design = name
    study = done(given)
    frame = completed(study.frame, station_units_per_h(study))
    frame = frame.assign(**{CONTROLLERS: frame["planned"]})
    study.publish(overview(frame, (*GROUPS, CONTROLLERS), COLUMNS), name, COLUMNS)
    study.publish(gains(frame, GROUPS, baseline, GAINED), f"{name}-gains", GAINED)
    require_optimised(study)


if __name__ == "__main__":
    sys.exit(command(main))
