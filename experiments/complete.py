"""Search for the missing runs of an experiment."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.experiments.design.stages import schedule
from rmfs.experiments.results import assigned, failed_pairs

if TYPE_CHECKING:
    from collections.abc import Collection

    import pandas as pd

    from rmfs.experiments.design.planning import Plan
    from rmfs.experiments.store import Store


def lacking(
    plan: Plan, store: Store, only: Collection[str] = (), *, rows: pd.DataFrame | None = None
) -> str:
    """Return a description of the missing runs of an experiment; empty if none are missing.

    Parameters
    ----------
    only
        Names of the arms to check. Default: all arms.
    rows
        The finished runs, as `assigned` returns them. Default: they are read.
    """
    lost = failed_pairs(plan, store)
    now = schedule(plan, assigned(plan, store) if rows is None else rows, lost)
    runs = [run for run in now.runs if not only or run.arm in only]
    finished = store.finished(plan.design.keep)
    arms = {arm.name: arm for arm in plan.arms}
    done = {
        (run.arm, run.replication)
        for run in runs
        if plan.job(arms[run.arm], run.replication).key in finished
    }
    wanted = len(runs)
    if len(done) == wanted and now.complete:
        return ""
    said = [f"incomplete: {len(done)} of {wanted} runs are finished"]
    failed = len(lost & {(run.arm, run.replication) for run in runs})
    if failed:
        said.append(f"{failed} failed")
    known = {run.arm for run in runs}
    empty = len(known - {arm for arm, _ in done})
    if empty:
        said.append(f"{empty} of {len(known)} arms have none")
    if not now.complete and may_grow(plan):
        said.append("stages may add more")
    return ", ".join(said)


def may_grow(plan: Plan) -> bool:
    """Whether the stages of an experiment may add further runs."""
    return any(stage.until or stage.select or stage.arms for stage in plan.design.stages)
