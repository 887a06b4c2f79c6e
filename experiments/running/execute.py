"""Executes one job in a worker process: loads the inputs, simulates and measures.

For runs on this machine, the modules imported here are loaded once, before workers are forked.
"""

from __future__ import annotations

import importlib
import platform
import sys
import time
import traceback
from pathlib import Path
from typing import TYPE_CHECKING

from rmfs.errors import InputError
from rmfs.experiments.design import resolve
from rmfs.experiments.running.job import Job, Outcome
from rmfs.measure.footprints import some_tables
from rmfs.simulation.run import simulate
from rmfs.solvers.decisions.recording import DecisionRecorder

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.simulation.result import Run


def execute(job: Job) -> Outcome:
    """Execute a job; any error becomes part of the outcome."""
    begun, begun_cpu = time.perf_counter(), time.process_time()
    host = platform.node()
    try:
        made = _simulated(job)
    except Exception as error:
        line = str(error).splitlines()[0] if str(error) else ""
        return Outcome(
            error=f"{type(error).__name__}: {line}",
            traceback=traceback.format_exc(),
            elapsed_s=time.perf_counter() - begun,
            cpu_s=time.process_time() - begun_cpu,
            host=host,
        )
    footprint = made.pop("footprint")
    return Outcome(
        footprint,
        made,
        elapsed_s=time.perf_counter() - begun,
        cpu_s=time.process_time() - begun_cpu,
        host=host,
    )


def _simulated(job: Job) -> dict[str, pd.DataFrame]:
    """Simulate, and return the tables wanted.

    Raises
    ------
    InputError
        If an input file has changed since the plan was made.
    RuntimeError
        If the motion is not safe: a defect.
    """
    _forget_changed(job.files)
    inputs = resolve.load(job.inputs, job.overrides)
    changed = [name for name, known in job.files.items() if resolve.present_hash(name) != known]
    if changed:
        raise InputError(f"{', '.join(changed)}: changed since the plan was made; plan again")
    keeper = _keeper(job)
    run = simulate(
        inputs.layout,
        inputs.scenario,
        inputs.controllers,
        seed=job.seed,
        pacing=job.pacing,
        overrides=resolve.of_pacing(job.overrides),
        trace=job.check,
        allow_not_well_formed=job.allow_not_well_formed,
        measures=job.measures,
        observers=[] if keeper is None else [keeper],
    )
    # as if simulate had read the files itself
    layout, scenario, controllers = (Path(given).stem for given in job.inputs.values())
    run.names = (layout, scenario, controllers)
    run.overrides = list(job.overrides)
    return _tables(run, job)


def _keeper(job: Job) -> DecisionRecorder | None:
    """Return an observer that records questions to optimisers; None if they are not recorded."""
    if not job.decisions:
        return None
    run = {part: Path(given).stem for part, given in job.inputs.items()}
    changes = [f"{'.'.join(path)}={value}" for path, value in job.overrides]
    told = {**run, "seed": job.seed, "set": changes, "design": job.design, "arm": job.arm}
    return DecisionRecorder(Path(job.decisions) / f"{job.arm}-seed{job.seed}", told)


def _forget_changed(files: dict[str, str]) -> None:
    """Let changed modules of users be imported again; a cluster worker executes several jobs.

    If one of them has changed since this process imported it, all of them are imported again, so
    that none refers to an old version of another.
    """
    mine = {name: known for name, known in files.items() if name.endswith(".py")}
    if any(_SEEN.get(name, known) != known for name, known in mine.items()):
        for name, module in list(sys.modules.items()):
            if getattr(module, "__file__", None) in mine:
                del sys.modules[name]
        importlib.invalidate_caches()
    _SEEN.update(mine)


_SEEN: dict[str, str] = {}
"""Hash of each source file of users, in the version that this process imported last."""


def _tables(run: Run, job: Job) -> dict[str, pd.DataFrame]:
    report = run.check() if job.check else None
    if report is not None and not report.ok:
        raise RuntimeError(f"unsafe motion: {report.summary()}")
    return some_tables(run, job.keep, report)
