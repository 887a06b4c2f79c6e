"""Joint decisions on orders and pods at a large site: 12 pick stations, 1,200 pods, 45 robots.

Published exact models cannot be solved at this size. On the layout `large`, the default rules and
HADGS (a heuristic of Jiao et al. 2025) are compared with the joint controllers of rmfs (`pile-on`
with whole orders, `pile-on-split` with split orders), for a backlog and for orders that arrive over
time. The study takes about 0.3 CPU hours.

A thesis with public instances (GitHub: Aesopz/RAWSIM-O-Aesop) reports results for a site of the
same size, but with another layout and other orders. With HADGS, 6,341 units are picked in 2 h, and
a decision takes 0.211 s. With the best heuristic of the thesis, 8,318 units are picked (96 % of the
stations' capacity), and a decision takes 0.066 s.
"""

from __future__ import annotations

import sys

from rmfs.experiments.papers.benefit import (
    COLUMNS,
    START,
    completed,
    gains,
    overview,
    publish_added,
    require_optimised,
)
from rmfs.experiments.papers.study import command, done, parser, station_units_per_h

BASELINE = "default"


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    study = done(parser("joint-large", __doc__).parse_args(arguments))
    frame = completed(study.frame, station_units_per_h(study))
    study.publish(overview(frame, ("demand", "controllers")), "joint-large", COLUMNS)
    solved = frame[~frame["controllers"].str.endswith(START)]
    study.publish(gains(solved, ("demand",), BASELINE), "joint-large-gains", COLUMNS)
    publish_added(study, frame, ("demand",), "joint-large")
    require_optimised(study)


if __name__ == "__main__":
    sys.exit(command(main))
