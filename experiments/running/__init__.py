"""Running of experiments: jobs, worker processes, and the driver that distributes jobs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rmfs.experiments.design.planning import Plan
    from rmfs.experiments.running.driver import Tally, Watcher
    from rmfs.experiments.running.local import Engine


def run(
    plan: Plan,
    folder: str | Path,
    *,
    processes: int | None = None,
    dask: str | None = None,
    watcher: Watcher | None = None,
) -> Tally:
    """Execute the runs of a plan that are not finished yet.

    Parameters
    ----------
    folder
        Folder for the results, created if necessary.
    processes
        Number of parallel runs on this machine. Default: one per available core.
    dask
        Cluster on which to execute the runs: the address of a Dask scheduler, or a cluster profile
        (a .toml file, see `running.cluster`). Default: none; runs are executed on this machine.
    watcher
        Object that is notified of progress. Default: none.

    Raises
    ------
    PlanError
        If the plan has errors.
    InputError
        If the folder cannot be written, or the cluster cannot be used.
    """
    from rmfs.experiments.running.cluster import DaskWorkers
    from rmfs.experiments.running.driver import drive
    from rmfs.experiments.running.local import LocalProcesses
    from rmfs.experiments.store import Store

    plan.require_sound()
    engine: Engine = DaskWorkers(dask) if dask is not None else LocalProcesses(processes or cores())
    return drive(plan, Store(Path(folder)), engine, watcher)


def cores() -> int:
    """Return the number of cores available to this process."""
    import os

    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # not Linux
        return os.cpu_count() or 1
