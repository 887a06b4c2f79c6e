"""The cost of computing time: units per hour as a function of the optimiser's time limit.

The study uses the small site (layout `small`) with six robots and split orders. With the pacing
`fixed`, an answer of the optimiser takes effect after the whole time limit, as if the solver had
used all of it. With `work`, it takes effect after the time that corresponds to the solver's work,
which is less if the optimum is proven early. Results with either pacing are reproducible. The study
takes about 0.1 CPU hours.

Two options change the study:

- `--wall` uses wall time, with four time limits (0.02 CPU hours). The results are not
  reproducible, and the machine must be otherwise idle.
- `--planning` uses TA planning, which plans several visits ahead, with four robots. Its problems
  are so large that the length of the search matters. The study then varies the time per answer or
  the number of search steps, instead of the time limit.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from rmfs.experiments.figures.lines import lines
from rmfs.experiments.figures.style import saving
from rmfs.experiments.papers.benefit import completed, overview, require_optimised
from rmfs.experiments.papers.study import command, done, parser, station_units_per_h

if TYPE_CHECKING:
    from pathlib import Path

    import pandas as pd

    from rmfs.experiments.papers.study import Study

THINKING, LIMIT = "thinking", "controllers.poa.work_s"
COLUMNS = ("units_per_h", "units_per_visit", "distance_per_unit_m", "paced_mean_s")


def paced(frame: pd.DataFrame) -> pd.DataFrame:
    """Return the runs with a new column `paced_mean_s`: mean simulated time of an answer, in s."""
    return frame.assign(paced_mean_s=frame["paced_s"] / frame["optimiser_calls"])


def picture(study: Study, frame: pd.DataFrame) -> Path:
    """Plot units per hour against the time limit, with one line per pacing."""
    path = study.place("price-of-thinking.png")
    with saving(path, 6.0, 4.0) as figure:
        ax = figure.subplots()
        timed = frame[~frame[THINKING].isin(["none", "start rule"])]
        words = timed[THINKING].str.split(expand=True)
        timed = timed.assign(mode=words[0], limit_s=words[1].astype(float))
        lines(timed, "limit_s", "units_per_h", "mode", ax)
        at_once = frame.loc[frame[THINKING] == "none", "units_per_h"]
        if len(at_once):
            ax.axhline(at_once.mean(), color="0.5", linewidth=0.8, label="no time at all")
        ax.set_xscale("log")
        ax.set_xlabel("time limit of the optimiser, s")
        ax.legend(fontsize=8)
    study.record(path, ["units_per_h"], kind="lines", confidence=0.95)
    return path


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    options = parser("price-of-thinking", __doc__)
    other = options.add_mutually_exclusive_group()
    other.add_argument("--wall", action="store_true", help="use wall time at four limits instead")
    other.add_argument(
        "--planning", action="store_true", help="use plans of several visits instead"
    )
    given = options.parse_args(arguments)
    if given.wall:
        given.design = "price-of-thinking-wall"
    if given.planning:
        given.design = "price-of-thinking-planning"
    study = done(given)
    frame = paced(completed(study.frame, station_units_per_h(study)))
    level = LIMIT if LIMIT in frame and THINKING not in frame else THINKING
    name = study.plan.design.name
    study.publish(overview(frame, (level,), COLUMNS), name, ["units_per_h", "paced_s"])
    if level == THINKING and not given.planning:
        print(picture(study, frame))
    # plans that take long to think of grow stale: that is what is shown
    require_optimised(
        study, frame[frame[THINKING].str.startswith("work ")] if given.planning else None
    )


if __name__ == "__main__":
    sys.exit(command(main))
