"""Joint decisions on orders, pods and robots at a small site (Jiao, Huang, Song, Li, Wang 2025).

In that paper, a model (M1G) decides on pick orders, pods and robots jointly; a heuristic (HADGS)
solves the same problem. The paper reports 16 % more orders per hour and 30 % less distance per
order with M1G than with sequential rules (SEQU). Here the site is rebuilt as far as it is published
(layout `small`), with ten or with six robots. Orders come from a backlog of 100, as in the paper,
or arrive over time, independently of the controllers. SEQU, M1G and HADGS are compared with the
joint controllers of rmfs: `pile-on` with whole orders, and `pile-on-split` with split orders (Xie,
Thieme, Krenzler, Li 2021). Six robots are so few that they are the bottleneck. For six robots, the
study also contains M1G with changed parameters (`m1g-mended`), `pile-on` with a reward per unit
(`pile-on-units`), and the start rules of all controllers named here except SEQU and HADGS. The
study takes about 0.5 CPU hours.
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

GROUPS = ("demand", "layout.robots")
BASELINE = "sequ"


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    study = done(parser("joint-small", __doc__).parse_args(arguments))
    frame = completed(study.frame, station_units_per_h(study))
    study.publish(overview(frame, (*GROUPS, "controllers")), "joint-small", COLUMNS)
    solved = frame[~frame["controllers"].str.endswith(START)]
    study.publish(gains(solved, GROUPS, BASELINE), "joint-small-gains", COLUMNS)
    publish_added(study, frame, GROUPS, "joint-small")
    unsplit = frame[frame["controllers"].isin(["pile-on", "pile-on-split"])]
    study.publish(gains(unsplit, GROUPS, "pile-on"), "joint-small-split", COLUMNS)
    require_optimised(study)


if __name__ == "__main__":
    sys.exit(command(main))
