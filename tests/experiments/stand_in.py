"""A run that simulates nothing: figures made up from arm and seed, in no time."""

from __future__ import annotations

import json
import os
import signal
import time
import zlib
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd

from rmfs.experiments.running.job import Job, Outcome
from rmfs.measure.columns import REAL
from rmfs.measure.dictionary import FOOTPRINT
from rmfs.measure.tables import SERIES

EFFECT = {"nearest": 40.0, "random": 0.0}
ROBOTS = 10.0


def footprint(job: Job) -> pd.DataFrame:
    """One row: 500 units an hour, 10 more per robot, 40 more with `nearest`; noise of the seed."""
    given = {".".join(path): value for path, value in job.overrides}
    rng = np.random.default_rng(job.seed)
    units = 500.0 + ROBOTS * given.get("layout.robots", 16)
    units += EFFECT.get(str(given.get("controllers.psa")), 0.0)
    shared = rng.normal(0.0, 20.0)
    own = np.random.default_rng([job.seed, zlib.crc32(job.arm.encode())]).normal(0.0, 5.0)
    row = {
        "seed": job.seed,
        "robots": given.get("layout.robots", 16),
        "units_per_h": units + shared + own,
        "wall_s": time.perf_counter(),
    }
    return template().assign(**{name: pd.array([v], TYPES[name]) for name, v in row.items()})


TYPES = {column.name: column.dtype for column in FOOTPRINT}
DULL = {REAL: 1.5, "str": "as run", "Int64": pd.NA}


@cache
def template() -> pd.DataFrame:
    """A footprint with all columns."""
    return pd.DataFrame(
        {name: pd.array([DULL.get(dtype, 7)], dtype) for name, dtype in TYPES.items()}
    )


def series(job: Job) -> pd.DataFrame:
    """Four quarters of an hour."""
    times = np.arange(1, 5) * 900.0
    frame = pd.DataFrame({column.name: 1.0 for column in SERIES}, index=range(4))
    frame["time_s"], frame["interval_s"] = times, 900.0
    frame["orders_completed"] = 10 + job.seed + np.arange(4)
    return frame.astype({column.name: column.dtype for column in SERIES})


def work(job: Job) -> Outcome:
    tables = {name: series(job) for name in job.keep}
    return Outcome(footprint(job), tables, elapsed_s=0.001, host="here")


def work_that_fails_for_random(job: Job) -> Outcome:
    if "psa=random" in job.arm and job.seed == 2:
        return Outcome(error="ValueError: a robot is lost", traceback="Traceback: somewhere")
    return work(job)


def work_that_dies_once(marks: Path, job: Job) -> Outcome:
    """The first worker for seed 2 of each arm kills itself; the folder `marks` holds who did."""
    mark = marks / job.key
    if job.seed == 2 and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return work(job)


def work_that_always_dies(job: Job) -> Outcome:
    if job.seed == 2:
        os._exit(3)
    return work(job)


class Inline:
    """An engine without processes.

    Parameters
    ----------
    after
        Jobs after which the driver is interrupted.
    """

    def __init__(self, do=work, after: int | None = None, slots: int = 3) -> None:
        self.do, self.after, self.slots = do, after, slots
        self.waiting: list[Job] = []
        self.done: list[str] = []
        self.closed = False

    def submit(self, job: Job) -> None:
        assert len(self.waiting) < self.slots
        self.waiting.append(job)

    def wait(self, timeout_s: float) -> list[tuple[Job, Outcome]]:
        if self.after is not None and len(self.done) >= self.after:
            raise KeyboardInterrupt
        # the last one handed in is the first to end: order must not matter
        job = self.waiting.pop()
        self.done.append(f"{job.arm}/{job.seed}")
        return [(job, self.do(job))]

    def close(self) -> None:
        self.closed = True


def work_without_end(job: Job) -> Outcome:
    time.sleep(600)
    return work(job)


def work_that_tells_threads(job: Job) -> Outcome:
    names = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")
    told = {name: os.environ.get(name) for name in names}
    ignored = signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    return Outcome(error=json.dumps({**told, "sigint": "ignored" if ignored else "heard"}))
