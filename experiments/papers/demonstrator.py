"""The demonstrator: one to four table-top robots (Merschformann, Xie, Li 2018, section 4).

In the paper, four small robots drive on a grid of 36 cells of 0.45 m, with one replenishment
station, one pick station and six pods. The top speed of the robots is 0.21 m/s, their acceleration
is 0.5 m/s2, and a full turn takes 5.5 s. The paper reports no throughput. Here the same warehouse
is simulated with one to four robots. The table shows units per hour and other measures for each
number of robots; the independent checker proves every run safe.

With `--reference DIR` (the folder of RAWSim-O's public instances), RAWSim-O's layout `office-4bot`
is used instead; it has the same waypoints and robots, but four pods and more order slots.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from rmfs import layout as layouts
from rmfs.experiments.figures.style import saving
from rmfs.experiments.papers.figure_5b import together
from rmfs.experiments.papers.study import command, done, parser
from rmfs.experiments.tables import means
from rmfs.measure.plots import heat as draw_heat

if TYPE_CHECKING:
    from pathlib import Path

    from rmfs.experiments.papers.study import Study

COLUMNS = (
    *("units_per_h", "distance_per_unit_m", "trip_time_mean_s"),
    *("robot_moving_share", "robot_queueing_share", "collisions"),
)


def picture(study: Study) -> Path:
    """Draw a heat map of how often robots visit each waypoint, for the arm with four robots."""
    path = study.place("demonstrator-heat.png")
    last = study.plan.arms[-1].name
    heat = study.table("heat")
    with saving(path, 5.6, 4.6) as figure:
        ax = figure.subplots()
        draw_heat(together(heat[heat["arm"] == last]), ax)
        ax.grid(visible=False)
        ax.set_title(f"Visits of each waypoint, {last}", fontsize=9)
    study.record(path, ["robots", "distance_m"], kind="heat map", arm=last)
    return path


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    options = parser("demonstrator", __doc__, reference="demonstrator/office-4bot.xinst")
    study = done(options.parse_args(arguments))
    study.publish(means(study.frame, COLUMNS), "demonstrator", list(COLUMNS))
    path = study.place("demonstrator-layout.png")
    layouts.save_picture(study.layout(study.plan.arms[-1]), path)
    study.record(path, ["robots"], kind="layout")
    print(path)
    print(picture(study))


if __name__ == "__main__":
    sys.exit(command(main))
