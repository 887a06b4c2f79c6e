"""A comparison of all methods of path planning, after Merschformann, Xie and Erdmann (2017).

There are three layouts, each of the size of an instance in that paper: 32 robots on one tier, 128
robots on one tier, and 96 robots on three tiers with elevators. The backlog is constant, all other
decisions are random, and one hour is simulated. Methods are compared by orders per hour. As in the
paper, pods, and therefore robots, stay on their tier if possible. The layout with three tiers is
simulated a second time with pods stored on any tier, so that robots have to use the elevators.

With `--reference DIR` (the folder of RAWSim-O's public instances), the original layouts of the
paper are used instead, and the results of RAWSim-O are shown for comparison.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import pandas as pd

from rmfs.experiments.papers.study import command, done, parser, reference_inputs
from rmfs.experiments.statistics import against, interval
from rmfs.experiments.tables import HALF, Table

if TYPE_CHECKING:
    import argparse
    from collections.abc import Mapping

    from rmfs.experiments.papers.study import Study

Rows = dict[tuple[str, str], dict[tuple[str, str], float]]
"""The cells of the table, by row (layout and method) and then by column."""

OURS = "time-windows"
METHOD = "controllers.pp"


@dataclass(frozen=True)
class Instance:
    """A layout of the study.

    Attributes
    ----------
    twin
        Name of a shipped layout of the same size as the original layout.
    reference
        Path of the original layout in the folder of RAWSim-O's public instances.
    theirs
        Results of RAWSim-O with seed 0, for the methods that were run with RAWSim-O: orders per
        hour, km per hour, and the simulated time in s over which both were measured.
    seeds
        Number of seeds for each method that is not in `slow`.
    slow
        Methods that need minutes of computation for a simulated hour, with the number of seeds of
        each; a method with 0 seeds is left out.
    riding
        Whether pods are stored on any tier, so that robots use elevators. Otherwise pods stay on
        their tier if possible, as is the default in RAWSim-O and rmfs.
    """

    twin: str
    reference: str
    theirs: dict[str, tuple[float, float, int]]
    seeds: int = 3
    slow: dict[str, int] = field(default_factory=dict)
    riding: bool = False

    @property
    def part(self) -> str:
        """Name of the folder for the runs with this layout."""
        return self.twin + ("-riding" if self.riding else "")

    def name(self, *, reference: bool) -> str:
        """Return the name for the table: that of the original layout or that of its twin."""
        stem = self.reference.removeprefix("pp/").removesuffix(".xinst")
        return (stem if reference else self.twin) + (", riding" if self.riding else "")


EVADING = "far, evading to a neighbour"
INSTANCES = [
    Instance(
        "study-32",
        "pp/1-4-4-32-550.xinst",
        {
            "far": (458.5, 69.0, 7200),
            EVADING: (439.0, 68.55, 7200),
            "whca-n": (456.5, 69.1, 7200),
            "whca-v": (498.5, 72.3, 7200),
            "od-id": (472.5, 68.05, 7200),
            "cbs": (482.0, 71.4, 1800),
            "bcp": (396.0, 74.4, 300),
        },
        seeds=10,
    ),
    Instance(
        "study-128",
        "pp/1-12-20-128-1965.xinst",
        {
            "far": (1211.0, 360.5, 3600),
            "whca-n": (1172.0, 344.8, 900),
            "whca-v": (1248.0, 372.4, 900),
        },
        seeds=10,
        slow={"bcp": 3},
    ),
    Instance(
        "study-tiers",
        "pp/3-12-12-96-1650.xinst",
        {"far": (1347.0, 234.2, 3600), "whca-n": (1342.0, 231.5, 3600)},
        seeds=10,
        slow={"bcp": 3},
    ),
    Instance("study-tiers", "pp/3-12-12-96-1650.xinst", {}, seeds=3, slow={"bcp": 0}, riding=True),
]
"""The layouts of the study, with results of RAWSim-O. The shorter a simulation was, the more its
results depend on the initial phase, in which all robots are free."""

CAPTION = (
    "Path planning methods over an hour with a constant backlog: means over seeds with 95% "
    "confidence intervals (Student's t); planning is wall time per simulated hour, failures "
    "are searches that found no path. The difference in orders is to time-windows, paired by "
    "seed."
)


def row(runs: pd.DataFrame, difference: Mapping[Any, float] | None) -> dict[tuple[str, str], float]:
    """Return the table row of one method on one layout.

    Parameters
    ----------
    runs
        Runs of the method on the layout, one row per run.
    difference
        Difference from the baseline method in orders per hour: a row of the result of
        `rmfs.experiments.statistics.against`. None for the baseline method itself.
    """
    cells = {("seeds", ""): float(len(runs))}
    hours = runs["duration_s"] / 3600.0
    for name, values in (
        ("orders/h", runs["orders_per_h"]),
        ("km/h", runs["distance_m"] / 1000.0 / hours),
        ("planning s/h", runs["planning_wall_s"] / hours),
    ):
        found = interval(values)
        cells[name, "mean"], cells[name, HALF] = found.mean, found.half_width
    if difference is not None:
        cells["difference", "mean"] = difference["difference"]
        cells["difference", HALF] = (difference["high"] - difference["low"]) / 2.0
    else:
        cells["difference", "mean"] = cells["difference", HALF] = float("nan")
    cells["failures/h", ""] = float((runs["plan_failures"] / hours).mean())
    cells["CPU s/run", ""] = float(runs["cpu_s"].mean())
    cells["collisions", ""] = float(runs["collisions"].sum())
    return cells


def rows(study: Study, instance: Instance, name: str) -> Rows:
    """Return the table rows of one layout, one per method, most orders per hour first.

    For original layouts, the rows also contain the results of RAWSim-O.
    """
    frame = study.frame
    differences = against(frame, "orders_per_h", OURS, by=METHOD)
    made: Rows = {}
    for planner, runs in frame.groupby(METHOD, sort=False):
        other = None if planner == OURS else differences.loc[[planner]].iloc[0].to_dict()
        cells = row(runs, other)
        if study.suffix:
            orders, km, over = instance.theirs.get(str(planner), (float("nan"),) * 3)
            cells["RAWSim-O", "orders/h"], cells["RAWSim-O", "km/h"] = orders, km
            cells["RAWSim-O", "over s"] = over
        made[name, str(planner)] = cells
    return dict(sorted(made.items(), key=lambda item: -item[1]["orders/h", "mean"]))


def as_table(made: Rows) -> Table:
    """Return all rows as a table to publish."""
    columns = pd.MultiIndex.from_tuples(list(next(iter(made.values()))))
    index = pd.MultiIndex.from_tuples(list(made), names=["layout", "method"])
    cells = [[one[column] for column in columns] for one in made.values()]
    decimals = dict.fromkeys(columns, 1)
    decimals |= {("seeds", ""): 0, ("collisions", ""): 0, ("failures/h", ""): 0}
    decimals |= {("planning s/h", "mean"): 2, ("planning s/h", HALF): 2}
    if ("RAWSim-O", "over s") in decimals:
        decimals["RAWSim-O", "over s"] = 0
    return Table(pd.DataFrame(cells, index=index, columns=columns), decimals, CAPTION)


def finished(given: argparse.Namespace, instance: Instance) -> Study:
    """Run all methods on a layout, each with its number of seeds."""
    given.reference_layout = instance.reference
    studies = []
    for seeds in sorted({instance.seeds, *instance.slow.values()} - {0}):
        studies.append(
            done(
                given,
                layout=instance.twin,
                more={"controllers.psa.prefer_same_tier": False} if instance.riding else {},
                part=instance.part,
                replications=seeds,
                without=[f"pp={name}" for name, most in instance.slow.items() if most < seeds],
            )
        )
    frames = pd.concat([study.frame for study in studies])
    return replace(studies[-1], frame=frames.drop_duplicates("run", ignore_index=True))


def main(arguments: list[str] | None = None) -> None:
    """Run the study on all layouts and publish one table."""
    options = parser("path-planning", __doc__, reference="pp/*.xinst")
    given = options.parse_args(arguments)
    for instance in INSTANCES:  # a missing layout is noticed before the first run
        given.reference_layout = instance.reference
        reference_inputs(given)
    made: Rows = {}
    studies = [finished(given, instance) for instance in INSTANCES]
    for instance, study in zip(INSTANCES, studies, strict=True):
        made |= rows(study, instance, instance.name(reference=given.reference is not None))
    every = replace(studies[-1], frame=pd.concat([study.frame for study in studies]))
    every.publish(
        as_table(made), "path-planning", ["orders_per_h", "distance_m", "planning_wall_s"]
    )


if __name__ == "__main__":
    sys.exit(command(main))
