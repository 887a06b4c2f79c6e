"""Figure 5b: where robots drive and wait (Merschformann, Xie, Li 2018).

The paper shows a heat map of robot movement, in colours on a logarithmic scale: robots queue at the
stations, and some areas are close to congestion. Here a layout of the same size as RAWSim-O's
layout MaTiMilli is used. The heat map shows the visits of each waypoint, that is, how often a robot
passes the waypoint or stops there, averaged over the seeds. A table shows how visits and waiting
time are distributed over the areas of the layout: aisles, storage locations, queues, and the rest.

With `--reference DIR` (the folder of RAWSim-O's public instances), MaTiMilli itself is used.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from rmfs.experiments.figures.style import saving
from rmfs.experiments.papers.study import command, done, parser
from rmfs.experiments.tables import means
from rmfs.measure.plots import heat as draw_heat

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.experiments.papers.study import Study
    from rmfs.experiments.tables import Table
    from rmfs.layout.model import Layout

COUNTS = ("visits", "loaded_visits", "waiting_s")


def together(heat: pd.DataFrame) -> pd.DataFrame:
    """Return visits and waiting time of every waypoint, averaged over the seeds."""
    place = ["waypoint", "tier", "x_m", "y_m"]
    counts = [c for c in heat if c in COUNTS]
    return heat.groupby(place, sort=False)[counts].mean().reset_index()


def areas(layout: Layout) -> NDArray[np.str_]:
    """Return the name of the area in which each waypoint lies, such as "aisles"."""
    storage, queue = layout.is_storage, layout.is_queue
    aisle = ~storage & ~queue
    for along in (layout.x_m, layout.y_m):
        low, high = along[storage].min(), along[storage].max()
        aisle &= (along >= low) & (along <= high)
    names = np.full(layout.waypoints, "halls and ring road", dtype="<U24")
    names[aisle] = "aisles"
    names[storage] = "storage places"
    names[queue] = "queues of stations"
    return names


def spread(heat: pd.DataFrame, area: NDArray[np.str_]) -> pd.DataFrame:
    """Return the distribution of visits and waiting over areas, with one row per seed and area.

    Each row contains the number of waypoints in the area, the visits per waypoint, and the area's
    shares of all visits and of all waiting time, in percent.

    Parameters
    ----------
    heat
        The table `heat` of all runs of one arm.
    area
        Name of the area of each waypoint, as `areas` returns it, shape (N,).
    """
    of_waypoint = area[heat["waypoint"].to_numpy(int)]
    grouped = heat.assign(area=of_waypoint).groupby(["replication", "area"])
    sums = grouped[["visits", "waiting_s"]].sum()
    made = pd.DataFrame({"waypoints": grouped.size()})
    made["visits per waypoint"] = sums["visits"] / made["waypoints"]
    for column, name in (("visits", "share of visits %"), ("waiting_s", "share of waiting %")):
        made[name] = 100 * sums[column] / sums[column].groupby("replication").transform("sum")
    return made.reset_index()


def as_table(found: pd.DataFrame) -> Table:
    """Return the distribution as a table to publish: means over the seeds, busiest area first."""
    columns = ["waypoints", "visits per waypoint", "share of visits %", "share of waiting %"]
    busiest = found.groupby("area")["visits per waypoint"].mean().sort_values(ascending=False)
    ordered = found.set_index("area").loc[busiest.index].reset_index()
    return means(ordered, columns, by="area")


def picture(study: Study, mean: pd.DataFrame, seeds: int) -> Path:
    """Draw the heat map of visits."""
    path = study.place("figure-5b.png")
    with saving(path, 9.0, 4.6) as figure:
        ax = figure.subplots()
        draw_heat(mean, ax)
        ax.grid(visible=False)
        ax.set_title(f"Visits of each waypoint; mean of {seeds} seeds", fontsize=9)
    study.record(path, ["robots", "distance_m"], kind="heat map")
    return path


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    options = parser("heat-map", __doc__, reference="mati/MaTiMilli.xinst")
    study = done(options.parse_args(arguments))
    (arm,) = study.plan.arms
    heat = study.table("heat")
    seeds = study.frame["replication"].nunique()
    study.publish(as_table(spread(heat, areas(study.layout(arm)))), "figure-5b", ["robots"])
    print(picture(study, together(heat), seeds))


if __name__ == "__main__":
    sys.exit(command(main))
