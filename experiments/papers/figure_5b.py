"""Figure 5b: where robots drive and wait (Merschformann, Xie, Li 2018).

The paper shows a heat map of robot movement, in colours on a logarithmic scale: robots queue at the
stations, and some areas are so busy that congestion threatens. Here the visits of each waypoint are
averaged over the seeds, and a table says how they are spread over the areas of the layout.

With `--reference DIR` (the public instances of RAWSim-O) the layout MaTiMilli itself is taken
instead of its twin.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from experiments.figures.style import saving
from experiments.papers.study import command, done, parser
from experiments.tables import Table
from rmfs.measure.plots import heat as draw_heat

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from experiments.papers.study import Study
    from rmfs.layout.model import Layout

COUNTS = ("visits", "loaded_visits", "waiting_s")


def together(heat: pd.DataFrame) -> pd.DataFrame:
    """Return the means of the counts of every waypoint over the seeds."""
    place = ["waypoint", "tier", "x_m", "y_m"]
    counts = [c for c in heat if c in COUNTS]
    return heat.groupby(place, sort=False)[counts].mean().reset_index()


def areas(layout: Layout) -> NDArray[np.str_]:
    """Return the area of each waypoint."""
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


def spread(mean: pd.DataFrame, area: NDArray[np.str_]) -> pd.DataFrame:
    """Return per area the waypoints, visits and waiting time, and their shares."""
    grouped = mean.assign(area=area[mean["waypoint"].to_numpy(int)]).groupby("area")
    made = pd.DataFrame({"waypoints": grouped.size(), "visits": grouped["visits"].sum()})
    made["visits per waypoint"] = made["visits"] / made["waypoints"]
    made["share of visits %"] = 100 * made["visits"] / made["visits"].sum()
    made["waiting h"] = grouped["waiting_s"].sum() / 3600.0
    made["share of waiting %"] = 100 * made["waiting h"] / made["waiting h"].sum()
    return made.sort_values("visits per waypoint", ascending=False)


def as_table(found: pd.DataFrame, seeds: int) -> Table:
    """Return the spread as a table to publish."""
    frame = found.copy()
    frame.columns = pd.MultiIndex.from_tuples([(name, "") for name in found.columns])
    decimals = dict(zip(frame.columns, (0, 0, 0, 1, 1, 1), strict=True))
    return Table(frame, decimals, f"Robots' visits and waiting by area; mean of {seeds} seeds.")


def picture(study: Study, mean: pd.DataFrame, seeds: int) -> Path:
    """Draw the heat map."""
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
    mean = together(study.table("heat"))
    seeds = study.frame["replication"].nunique()
    study.publish(as_table(spread(mean, areas(study.layout(arm))), seeds), "figure-5b", ["robots"])
    print(picture(study, mean, seeds))


if __name__ == "__main__":
    sys.exit(command(main))
