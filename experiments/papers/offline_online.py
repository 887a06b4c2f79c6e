"""Whether better answers of optimisers also improve the results of the warehouse.

A question is one decision that a controller asks an optimiser to take; questions of the same kind
form a family, and the library contains questions recorded in runs (docs: decisions). In each arm, a
controller asks the questions of one family, which are answered by one method with one limit of
work.

Offline, the library's questions of the family are answered with the settings of the arm. The
offline gap of the arm is the mean primal gap, that is, the mean relative difference between the
values of these answers and the best known values. Online, the warehouse is simulated with the
controller of the arm, with the same seeds in all arms. If arms with smaller gaps pick more units,
have fewer late orders and drive less, the objective of the questions is a good proxy for these
measures.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from scipy.stats import spearmanr

from rmfs.errors import InputError
from rmfs.experiments.papers.decision_library import LIBRARY
from rmfs.experiments.papers.decision_online import planned, searched
from rmfs.experiments.papers.study import command, done, parser
from rmfs.experiments.statistics import interval
from rmfs.experiments.tables import HALF, Table, rows_frame
from rmfs.solvers.decisions.asking import asked_again
from rmfs.solvers.decisions.files import Decision, read
from rmfs.solvers.decisions.library.table import Library
from rmfs.solvers.decisions.profiling import primal_gap
from rmfs.solvers.models.tasks.sequence import STEPS_PER_TASK

SOLVER = "solver"
COLUMNS = ("units_per_h", "late_share", "distance_per_unit_m")
GAP = "offline gap, %"

Changes = Mapping[str, Any] | Callable[[Decision], Mapping[str, Any]]
"""Changes to the settings of a question, which may depend on the question."""

ASKED: Mapping[str, tuple[str, Changes]] = {
    "pile_on greedy": ("pile_on", {"method": "greedy"}),
    "pile_on hadgs": ("pile_on", {"method": "hadgs"}),
    "pile_on joint 0.002": ("pile_on", {"limits": {"deterministic_s": 0.002}}),
    "pile_on joint 0.05": ("pile_on", {"limits": {"deterministic_s": 0.05}}),
    "planning greedy": ("planning", {"method": "greedy"}),
    "planning lns 10": ("planning", planned(lambda stations: 10)),
    "planning lns 100": ("planning", planned(lambda stations: 100)),
    "placement greedy": ("placement", {"method": "greedy"}),
    "placement assignment": ("placement", {}),
    "stays greedy": ("stays", {"method": "greedy"}),
    "stays cp_sat": ("stays", {}),
    "zones greedy": ("zones", {"method": "greedy"}),
    "zones clarabel": ("zones", {}),
    "balance greedy": ("balance", {"method": "greedy"}),
    "balance flow": ("balance", {}),
    "sequence greedy": ("sequence", {"method": "greedy"}),
    "sequence cp_sat": ("sequence", {"method": "cp_sat"}),
    "sequence lns": ("sequence", searched(STEPS_PER_TASK)),
    "replenishment greedy": ("replenishment", {"method": "greedy"}),
    "replenishment rounding": ("replenishment", {"method": "rounding"}),
    "replenishment highs": ("replenishment", {}),
}
"""For each arm of the design: its family, and its changes to the settings of a question."""


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    options = parser("offline-online", __doc__)
    options.add_argument("--library", type=Path, default=LIBRARY, help="folder of the library")
    options.add_argument("--size", default="small", help="size of the questions (default: small)")
    given = options.parse_args(arguments)
    study = done(given)
    library = Library.load(given.library)
    named = list(dict.fromkeys(study.frame[SOLVER]))
    unknown = [name for name in named if name not in ASKED]
    if unknown:
        raise InputError(f"{SOLVER}: {unknown[0]}: no such arm; known: {', '.join(ASKED)}")
    gaps = {name: offline_gaps(library, name, given.size) for name in named}
    columns = (SOLVER, *COLUMNS)
    study.publish(beside(study.frame, gaps), "offline-online", columns, size=given.size)
    found = correlations(study.frame, {name: float(np.mean(one)) for name, one in gaps.items()})
    study.publish(found, "offline-online-correlations", columns, size=given.size)


def offline_gaps(library: Library, arm: str, size: str) -> list[float]:
    """Return the primal gaps (0 to 1) of library questions answered with the settings of an arm.

    The questions are those of the arm's family that have the given size.

    Parameters
    ----------
    library
        The library of questions.
    arm
        A key of `ASKED`.
    size
        Size of the questions, such as `small`.
    """
    family, changes = ASKED[arm]
    gaps = []
    for row in library.rows.values():
        if (row.family, row.size) == (family, size):
            decision = read(library.path(row))
            asked = changes(decision) if callable(changes) else changes
            found = asked_again(asked_otherwise(decision, asked))
            gaps.append(primal_gap(found.objective, row.value))
    return gaps


def asked_otherwise(decision: Decision, changes: Mapping[str, Any]) -> Decision:
    """Return a question with changed settings; in nested tables, only given keys are changed.

    Parameters
    ----------
    decision
        The question whose settings are to be changed.
    changes
        New values of the settings to change, by key.
    """
    asked = dict(decision.asked)
    for key, value in changes.items():
        asked[key] = {**asked[key], **value} if isinstance(value, dict) else value
    return replace(decision, asked=asked)


def beside(frame: pd.DataFrame, gaps: Mapping[str, list[float]]) -> Table:
    """Return a table of the mean offline gap and the mean online measures of every arm.

    Parameters
    ----------
    frame
        Results of the runs.
    gaps
        Offline gap of each question, by arm.
    """
    rows: dict[str, dict[tuple[str, str], float]] = {}
    for arm, offline in gaps.items():
        runs = frame[frame[SOLVER] == arm]
        row = {(GAP, "mean"): 100.0 * float(np.mean(offline))}
        for column in COLUMNS:
            found = interval(runs[column])
            row[column, "mean"], row[column, HALF] = found.mean, found.half_width
        rows[arm] = row
    decimals = dict.fromkeys([(GAP, "mean")], 2) | {
        (column, part): 1 if column == "units_per_h" else 3
        for column in COLUMNS
        for part in ("mean", HALF)
    }
    caption = "Mean offline gap to the best known value, and the warehouse, by method."
    return Table(rows_frame(rows, SOLVER), decimals, caption)


def correlations(frame: pd.DataFrame, gaps: Mapping[str, float]) -> Table:
    """Return rank correlations of offline gaps with online measures, by family.

    The runs are paired by seed: each value of a measure is replaced by its difference from the mean
    of the family's arms with the same seed.

    Parameters
    ----------
    frame
        Results of the runs.
    gaps
        Mean offline gap by arm.

    Returns
    -------
    One row per family: the number of arms, the largest of their gaps, and the rank correlation of
    each measure with the gap. With two arms, the correlation shows only the sign of the effect, and
    whether the sign is the same for all seeds.
    """
    rows: dict[str, dict[tuple[str, str], float]] = {}
    of = frame[SOLVER].map(lambda arm: ASKED[arm][0])
    for family in dict.fromkeys(of):
        runs = frame[of == family]
        row: dict[tuple[str, str], float] = {("arms", ""): float(runs[SOLVER].nunique())}
        row["largest gap, %", ""] = 100.0 * max(gaps[arm] for arm in runs[SOLVER].unique())
        for column in COLUMNS:
            apart = runs[column] - runs.groupby("replication")[column].transform("mean")
            offline = runs[SOLVER].map(gaps)
            varies = offline.max() > offline.min() and apart.abs().max() > 0.0
            row[column, "rank correlation"] = (
                float(spearmanr(offline, apart).statistic) if varies else float("nan")
            )
        rows[str(family)] = row
    decimals = {key: 2 for row in rows.values() for key in row}
    decimals["arms", ""] = 0
    caption = "Rank correlation of offline gap and online measures, paired by seed, by family."
    return Table(rows_frame(rows, "family"), decimals, caption)


if __name__ == "__main__":
    sys.exit(command(main))
