"""Loads the results of an experiment."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from rmfs.errors import InputError
from rmfs.experiments.design import planning as plans
from rmfs.experiments.design.arms import PARTS
from rmfs.experiments.design.stages import schedule
from rmfs.experiments.running.job import run_key
from rmfs.experiments.store import PROVENANCE, Store
from rmfs.measure.dictionary import learnt, names, reproducible

if TYPE_CHECKING:
    from rmfs.experiments.design.planning import Plan


def load(folder: str | Path, *, table: str = "footprint") -> pd.DataFrame:
    """Load the results of a finished or running experiment.

    Parameters
    ----------
    folder
        Folder of the experiment's results.
    table
        `footprint`, or a table named in the entry `keep` of the design.

    Returns
    -------
    For `footprint`, one row per finished run, sorted by arm (in design order) and replication. The
    columns are `arm`, the factors, `stage`, `replication` (the seed as listed in the design), the
    footprint, `run` (a hash that identifies the run), and further columns on the origin of the
    run. Other tables start with the columns `arm`, the factors, `replication` and `seed`.

    Raises
    ------
    InputError
        If the folder contains no experiment, or the table is not kept.
    """
    path = Path(folder)
    plan = plans.load(path)
    store = Store(path)
    rows = assigned(plan, store)
    if table == "footprint":
        return rows
    if table not in plan.design.keep:
        kept = ", ".join(["footprint", *plan.design.keep])
        raise InputError(f"{path}: table {table} is not kept; kept: {kept}")
    head = rows[["arm", *plan.factors, "replication", "seed", "run"]]
    order = pd.Series(range(len(head)), index=head["run"])
    content = store.table(table, list(head["run"]))
    content = content.sort_values("run", key=lambda run: run.map(order), kind="stable")
    clash = [c for c in head if c in content and c != "run"]
    made = head.merge(content.drop(columns=clash), on="run", how="right", sort=False)
    return made.drop(columns="run").reset_index(drop=True)


def failures(folder: str | Path) -> pd.DataFrame:
    """Return the failed runs of an experiment, one row each, with `error` and `traceback`."""
    path = Path(folder)
    return failed(plans.load(path), Store(path))


def failed(plan: Plan, store: Store) -> pd.DataFrame:
    """Return the failed runs of a plan, except those that were later repeated successfully."""
    found = store.failures()
    replications = [int(r) for r in found["replication"].unique()]
    names = {
        run_key(arm.digest, plan.seed(arm, r)): arm.name for arm in plan.arms for r in replications
    }
    kept = found[found["run"].isin(list(names)) & ~found["run"].isin(list(store.finished()))]
    return kept.assign(arm=kept["run"].map(names)).reset_index(drop=True)


def failed_pairs(plan: Plan, store: Store) -> set[tuple[str, int]]:
    """Return the runs that `failed` returns, as pairs of arm and replication."""
    lost = failed(plan, store)
    return set(zip(lost["arm"], lost["replication"].astype(int), strict=True))


def assigned(plan: Plan, store: Store) -> pd.DataFrame:
    """Return the results of a plan's finished runs, one row each, with arm and factors.

    Rows are sorted by arm (in the order of the plan) and replication. Runs with outdated inputs
    and runs that the plan no longer requires, such as those of removed seeds, are excluded.
    """
    rows = store.rows()
    by_digest = {arm.digest: arm for arm in plan.arms}
    mine = rows[rows["arm_digest"].isin(list(by_digest))].copy()
    arms = [by_digest[digest] for digest in mine["arm_digest"]]
    mine["arm"] = [arm.name for arm in arms]
    told = zip(arms, mine["replication"], mine["seed"], strict=True)
    right = [plan.seed(arm, int(replication)) == seed for arm, replication, seed in told]
    mine = mine[np.array(right, dtype=bool)]
    now = schedule(plan, mine, failed_pairs(plan, store))
    wanted = {(run.arm, run.replication): run for run in now.runs}
    pairs = list(zip(mine["arm"], mine["replication"].astype(int), strict=True))
    mine = mine[np.array([pair in wanted for pair in pairs], dtype=bool)]
    order = {arm.name: number for number, arm in enumerate(plan.arms)}
    mine = mine.assign(
        stage=[wanted[pair].stage for pair in pairs if pair in wanted],
        _order=mine["arm"].map(order),
    )
    mine = mine.sort_values(["_order", "replication"], ignore_index=True)
    return _arranged(plan, mine)


def reproducible_table(frame: pd.DataFrame) -> pd.DataFrame:
    """Return only the columns whose values do not change if the experiment is repeated.

    Rows are sorted by arm and replication. Columns that depend on the machine (such as wall times)
    and columns on the origin of a run are excluded. Two experiments have identical results if their
    reproducible tables, written as CSV, are equal byte for byte.
    """
    gone = {*names("footprint")} - {*reproducible("footprint")}
    gone |= {column.name for column in learnt() if column.measured}
    gone |= {*PROVENANCE, "run", "arm_digest", "design", "design_hash"}
    kept = frame[[column for column in frame.columns if column not in gone]]
    return kept.sort_values(["arm", "replication"], kind="stable", ignore_index=True)


def to_csv(frame: pd.DataFrame, path: Path) -> None:
    """Write the `reproducible_table` of results as CSV."""
    from rmfs.files import write_text

    write_text(path, reproducible_table(frame).to_csv(index=False, lineterminator="\n"))


def _arranged(plan: Plan, mine: pd.DataFrame) -> pd.DataFrame:
    """Put the columns in order and add those of the factors."""
    arms = {arm.name: arm for arm in plan.arms}
    mine = mine.copy()
    for factor in plan.factors:
        # the content of an input decides, under whatever name it was run
        mine[factor] = pd.Series(
            [arms[name].levels[factor] for name in mine["arm"]], index=mine.index
        )
    for part in PARTS:
        if part not in plan.factors:
            mine[part] = pd.Series(
                [Path(arms[name].inputs[part]).stem for name in mine["arm"]], index=mine.index
            )
    footprint = [c for c in names("footprint") if c in mine and c not in plan.factors]
    known = ["arm", *plan.factors, "stage", "replication", *footprint]
    tail = ["run", "arm_digest", "design", "design_hash", *PROVENANCE]
    others = [c for c in mine if c not in (*known, *tail, "_order")]
    return mine[[*known, *others, *(c for c in tail if c in mine)]]
