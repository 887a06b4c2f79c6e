"""Questions of the library of decisions, answered with default and other settings.

Each question of the families `planning` and `sequence` (sequences of tasks for robots) is answered
once under each setting in `SETTINGS`. A setting consists of a method and its limits. Everything
else is as in the run in which a controller asked the question; for example, a search starts from
the plan that the controller had. The study publishes the primal gap (relative difference to the
best known value) and the processor time.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import asdict, replace
from pathlib import Path
from time import process_time
from typing import TYPE_CHECKING, Any

import pandas as pd

from rmfs.experiments.papers.decision_library import LIBRARY, publish_table
from rmfs.experiments.papers.study import PUBLISHED, command
from rmfs.solvers.control.planning.parameters import STEPS_PER_STATION
from rmfs.solvers.decisions.asking import asked_again
from rmfs.solvers.decisions.files import read
from rmfs.solvers.decisions.library.table import Library
from rmfs.solvers.decisions.profiling import primal_gap
from rmfs.solvers.models.solution import Limits
from rmfs.solvers.models.tasks.sequence import STEPS_PER_TASK

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from rmfs.solvers.decisions.files import Decision

SIZES = ("medium", "real", "double")


def planned(steps: Callable[[int], int]) -> Callable[[Decision], dict[str, Any]]:
    """Return a function that gives the method and limits for a question of the family `planning`.

    Parameters
    ----------
    steps
        Number of steps of the neighbourhood search per station, as a function of the number of
        stations.
    """

    def asked(decision: Decision) -> dict[str, Any]:
        stations = decision.sizes["S"]
        limits = Limits(iterations=steps(stations) * stations, deterministic_s=1.0)
        return {"method": "lns", "limits": asdict(limits)}

    return asked


def _routed(method: str, work_s: float) -> Callable[[Decision], dict[str, Any]]:
    """Return a function that gives the method and a limit of work, for the family `sequence`."""
    limits = asdict(Limits(deterministic_s=work_s, gap=0.01))
    return lambda decision: {"method": method, "limits": limits}


def searched(steps: int) -> Callable[[Decision], dict[str, Any]]:
    """Return a function that gives the method and limits for a question of the family `sequence`.

    Parameters
    ----------
    steps
        Number of steps of the neighbourhood search per task.
    """

    def asked(decision: Decision) -> dict[str, Any]:
        limits = Limits(iterations=steps * decision.sizes["T"])
        return {"method": "lns", "limits": asdict(limits)}

    return asked


SETTINGS: Mapping[str, Mapping[str, Callable[[Decision], dict[str, Any]]]] = {
    "planning": {
        "150 steps per station": planned(lambda stations: 150),
        "default: 75 steps per station, for each station": planned(
            lambda stations: STEPS_PER_STATION * stations
        ),
        "1,500 steps per station (`planning-split`)": planned(lambda stations: 1500),
    },
    "sequence": {
        "insertion": lambda decision: {"method": "greedy"},
        "50 steps per task": searched(50),
        "default: 200 steps per task": searched(STEPS_PER_TASK),
        "CP-SAT, 0.01 s": _routed("cp_sat", 0.01),
        "column generation, 0.6 s": _routed("columns", 0.6),
    },
}
"""Functions that return method and limits of a setting, by family and name of the setting."""


def main(arguments: list[str] | None = None) -> None:
    """Answer the questions under all settings and publish the table."""
    made = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    made.add_argument("--library", type=Path, default=LIBRARY, help="folder of the library")
    made.add_argument("--published", type=Path, default=PUBLISHED, help="folder of tables")
    made.add_argument("--size", action="append", choices=SIZES, help="sizes (default: all)")
    given = made.parse_args(arguments)
    library = Library.load(given.library)
    rows = pd.DataFrame(answered(library, given.size or SIZES))
    publish_table(given.published / "decision-settings.md", compared(rows))


def answered(library: Library, sizes: tuple[str, ...]) -> Iterator[dict[str, Any]]:
    """Yield the primal gap and the processor time (s) of each question under each setting.

    Parameters
    ----------
    library
        The library of questions.
    sizes
        Sizes of the questions to answer.
    """
    for family, settings in SETTINGS.items():
        for size in sizes:
            for row in library.rows.values():
                if (row.family, row.size) != (family, size):
                    continue
                decision = read(library.path(row))
                for setting, changed in settings.items():
                    asked = {**decision.asked, **changed(decision)}
                    began = process_time()
                    found = asked_again(replace(decision, asked=asked))
                    seconds = process_time() - began
                    gap = primal_gap(found.objective, row.value)
                    yield {
                        "family": family,
                        "size": size,
                        "setting": setting,
                        "gap": gap,
                        "seconds": seconds,
                    }


def compared(rows: pd.DataFrame) -> pd.DataFrame:
    """Return median and largest gap, and median processor time, by family, setting and size.

    Parameters
    ----------
    rows
        One row for each question and setting, as `answered` yields them.
    """
    groups = rows.groupby(["family", "setting", "size"], sort=False)
    return pd.DataFrame(
        {
            "questions": groups.size(),
            "median gap": groups["gap"].median().map("{:.2%}".format),
            "largest gap": groups["gap"].max().map("{:.2%}".format),
            "median processor time, ms": (1e3 * groups["seconds"].median()).map("{:.0f}".format),
        }
    ).reset_index()


if __name__ == "__main__":
    sys.exit(command(main))
