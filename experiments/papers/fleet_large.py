"""How many robots the large site needs: rules, visits planned by search, and its start rule.

Units per hour over the size of the fleet, the stock kept at its level, with the proven bound in the
picture; the smallest fleet that reaches 95 % of what the stations can do; and what the
search adds to the start rule of the same controller, seed by seed. With `--later` the same in the
third hour, answers paced by their work.
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
from rmfs.experiments.papers.fewer_robots import COLUMNS, ENOUGH, ROBOTS, needed, picture
from rmfs.experiments.papers.planning import GAINED, START_RULE
from rmfs.experiments.papers.study import command, done, parser, station_units_per_h

RULES = "default rules"


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    options = parser("fleet-large", __doc__)
    options.add_argument("--later", action="store_true", help="the third hour instead")
    given = options.parse_args(arguments)
    name = "fleet-large"
    if given.later:
        name += "-later"
        given.design = name
    study = done(given)
    each = station_units_per_h(study)
    frame = completed(study.frame, each).drop(columns=CONTROLLERS)
    frame = frame.rename(columns={"planned": CONTROLLERS})
    planned = frame[frame[CONTROLLERS] != RULES]
    study.publish(overview(frame, (CONTROLLERS, ROBOTS), COLUMNS), name, COLUMNS)
    study.publish(needed(frame, (CONTROLLERS,)), f"{name}-needed", ("station_share",))
    study.publish(gains(planned, (ROBOTS,), START_RULE, GAINED), f"{name}-gains", GAINED)
    print(picture(study, frame, each * frame["pick_stations"].iloc[0], f"{name}.png"))
    require_optimised(study, planned[planned["station_share"] >= ENOUGH])


if __name__ == "__main__":
    sys.exit(command(main))
