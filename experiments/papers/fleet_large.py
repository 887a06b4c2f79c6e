"""The number of robots that the large site needs: default rules, TA planning and its start rule.

TA planning is an optimiser that plans several visits ahead by a search; its start rule is the same
controller without the search. The study simulates the large site (layout `large`) with the stock
level kept constant. It publishes units per hour by fleet size, with an upper bound that holds even
for controllers that know all future orders (docs: bounds); the smallest fleet that reaches 95 % of
the stations' capacity; and the gain of TA planning over its start rule, paired by seed.

With `--later`, the third hour is measured, and each answer of the optimiser takes simulated time in
proportion to the computation (pacing `work`). With `--bound`, the bound is printed and nothing is
simulated.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from rmfs import layout as layouts
from rmfs import scenario
from rmfs.experiments.design.planning import plan
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
from rmfs.experiments.tables import Table, rows_frame
from rmfs.scenario.sources import sku_set
from rmfs.solvers.run_bound import units_per_h_keeping_stock
from rmfs.traffic import Traffic

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rmfs.experiments.design.planning import Plan

RULES = "default rules"


def clairvoyant(design: Plan) -> tuple[dict[int, float], float]:
    """Return an upper bound on units per hour for each fleet size, and the stations' capacity.

    The fleet sizes are those from one robot to the largest fleet of the design. The bounds hold for
    all runs in which at least as many units are stored as picked. The capacity is that of all pick
    stations together, in units per hour.
    """
    arm = design.arms[0]
    own = {
        kind: [(keys[1:], value) for keys, value in arm.overrides if keys[0] == kind]
        for kind in ("layout", "scenario")
    }
    layout = layouts.load(arm.inputs["layout"], own["layout"])
    work = scenario.load(arm.inputs["scenario"], own["scenario"])
    fleets = range(1, max(arm.levels[ROBOTS] for arm in design.arms) + 1)
    found = units_per_h_keeping_stock(
        layout, sku_set(work.skus), Traffic(layout), work.duration_s, fleets
    )
    return found, sum(3600.0 / station.unit_transfer_s for station in layout.pick_stations)


def bounds(found: Mapping[int, float], limit: float) -> Table:
    """Return a table of the bound on units per hour by fleet size.

    The first row is for one robot, the last row for the smallest fleet with the highest bound.

    Parameters
    ----------
    found, limit
        Bounds by fleet size, and capacity, as `clairvoyant` returns them.
    """
    highest = max(found.values())
    fleets = [robots for robots, bound in found.items() if bound < highest * (1 - 1e-6)]
    fleets.append(min(set(found) - set(fleets)))
    rows = {
        str(robots): {
            ("units_per_h", ""): found[robots],
            ("station_share", ""): found[robots] / limit,
        }
        for robots in fleets
    }
    caption = (
        "Upper bound on units per hour of any controller that stores at least as many units as "
        "it picks, even if it knows all future orders (docs: bounds). With more robots than in "
        "the last row, the bound does not change."
    )
    decimals = {("units_per_h", ""): 0, ("station_share", ""): 3}
    return Table(rows_frame(rows, "robots"), decimals, caption)


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    options = parser("fleet-large", __doc__)
    options.add_argument("--later", action="store_true", help="use the third hour instead")
    options.add_argument("--bound", action="store_true", help="only print the bound")
    given = options.parse_args(arguments)
    name = "fleet-large"
    if given.later:
        name += "-later"
        given.design = name
    if given.bound:
        print(bounds(*clairvoyant(plan(given.design))).markdown())
        return
    study = done(given)
    each = station_units_per_h(study)
    frame = completed(study.frame, each).drop(columns=CONTROLLERS)
    frame = frame.rename(columns={"planned": CONTROLLERS})
    planned = frame[frame[CONTROLLERS] != RULES]
    study.publish(overview(frame, (CONTROLLERS, ROBOTS), COLUMNS), name, COLUMNS)
    study.publish(needed(frame, (CONTROLLERS,)), f"{name}-needed", ("station_share",))
    study.publish(gains(planned, (ROBOTS,), START_RULE, GAINED), f"{name}-gains", GAINED)
    known, limit = clairvoyant(study.plan)
    study.publish(bounds(known, limit), f"{name}-bound", ())
    print(picture(study, frame, limit, f"{name}.png", known))
    require_optimised(study, planned[planned["station_share"] >= ENOUGH])


if __name__ == "__main__":
    sys.exit(command(main))
