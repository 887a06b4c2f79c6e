"""What the harness itself costs: `python -m experiments.overhead`.

Runs that simulate nothing but take their time asleep, and so leave the cores to the harness, go the
whole way of real ones: a process each, a real footprint and time series back, the row stored. What
the experiment takes beyond its runs is overhead: the start of the interpreter, imports, the plan,
processes, storing. The driver's memory is looked at on the way.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from experiments.extras import optional
from experiments.running.driver import Silent
from rmfs.errors import InputError

if TYPE_CHECKING:
    from experiments.running.job import Job, Outcome

DESIGN = """\
format = "rmfs-design/1"
name = "overhead"
replications = {replications}
keep = ["series"]

[base]
layout = "basic"
scenario = "basic"
controllers = "default"
"scenario.duration_s" = 600

[factors]
"layout.robots" = [8, 10, 12, 14, 16]
"""
ARMS = 5
TOLD = "cost.json"


@dataclass
class Cost:
    """What an experiment of sleeping runs has cost.

    Attributes
    ----------
    runs, jobs, asleep_s
        How many runs, how many at a time, and how long each.
    wall_s
        From the start of the interpreter to its end.
    cpu_s
        Processor time of the driver and all workers.
    memory_mb
        Resident memory of the driver after each run.
    """

    runs: int
    jobs: int
    asleep_s: float
    wall_s: float
    cpu_s: float
    memory_mb: list[float] = field(default_factory=list)

    @property
    def overhead(self) -> float:
        """Wall time beyond that of the runs, as a share of it."""
        alone_s = -(-self.runs // self.jobs) * self.asleep_s
        return self.wall_s / alone_s - 1.0

    def __str__(self) -> str:
        """Say it in lines."""
        early = self.memory_mb[len(self.memory_mb) // 10]
        return (
            f"{self.runs} runs of {self.asleep_s:g} s, {self.jobs} at a time: {self.wall_s:.1f} s\n"
            f"overhead: {self.overhead:.2%} of the time of the runs\n"
            f"processor time: {1000 * self.cpu_s / self.runs:.0f} ms a run\n"
            f"memory of the driver: {early:.0f} MB after a tenth of the runs, "
            f"{self.memory_mb[-1]:.0f} MB at the end"
        )


def measure(runs: int, asleep_s: float, jobs: int) -> Cost:
    """Run an experiment of sleeping runs in an interpreter of its own.

    Parameters
    ----------
    runs
        A multiple of five: the arms of the experiment.
    asleep_s
        What each run takes.
    jobs
        Runs at a time.
    """
    if runs % ARMS:
        raise InputError(f"--runs {runs}: must be a multiple of {ARMS}")
    with tempfile.TemporaryDirectory() as folder:
        given = [folder, *(str(one) for one in (runs, asleep_s, jobs))]
        code = f"from experiments.overhead import drive_asleep; drive_asleep(*{given!r})"
        begun = time.perf_counter()
        subprocess.run([sys.executable, "-c", code], check=True)
        wall_s = time.perf_counter() - begun
        told = json.loads((Path(folder) / TOLD).read_text(encoding="utf-8"))
    return Cost(runs, jobs, asleep_s, wall_s, told["cpu_s"], told["memory_mb"])


def drive_asleep(folder: str, runs: str, asleep_s: str, jobs: str) -> None:
    """Do the whole experiment and write down what it cost; the inside of `measure`."""
    from experiments.design.planning import plan
    from experiments.running.driver import drive
    from experiments.running.execute import execute
    from experiments.running.local import LocalProcesses
    from experiments.store import Store

    path = Path(folder) / "overhead.toml"
    path.write_text(DESIGN.format(replications=int(runs) // ARMS), encoding="utf-8")
    made = plan(path)
    real = execute(made.job(made.arms[0], 1))
    engine = LocalProcesses(int(jobs), partial(asleep, float(asleep_s), real))
    memory = _Memory(optional("psutil", "experiments", "the cost of the harness").Process())
    done = drive(made, Store(Path(folder) / "out"), engine, memory)
    assert done.finished == int(runs) and not done.failed
    told = {"cpu_s": memory.cpu_s(), "memory_mb": memory.mb}
    (Path(folder) / TOLD).write_text(json.dumps(told), encoding="utf-8")


def asleep(seconds: float, outcome: Outcome, job: Job) -> Outcome:
    """Take time, and come back with the tables of another run."""
    time.sleep(seconds)
    assert outcome.footprint is not None
    return replace(outcome, footprint=outcome.footprint.assign(seed=job.seed))


class _Memory(Silent):
    """Looks at the driver's memory whenever a run has ended."""

    def __init__(self, process: Any) -> None:
        self.process = process
        self.mb: list[float] = []

    def ended(self, job: Job, outcome: Outcome) -> None:
        self.mb.append(round(self.process.memory_info().rss / 1e6, 1))

    def cpu_s(self) -> float:
        """Return the processor time of the driver, the fork server and all workers."""
        return sum(sum(one.cpu_times()[:4]) for one in (self.process, *self.process.children()))


def main(arguments: list[str] | None = None) -> int:
    """Measure and tell."""
    parser = argparse.ArgumentParser(prog="python -m experiments.overhead")
    parser.add_argument("--runs", type=int, default=500)
    parser.add_argument("--seconds", type=float, default=10.0, help="what each run takes")
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time")
    given = parser.parse_args(arguments)
    try:
        print(measure(given.runs, given.seconds, given.jobs))
    except InputError as error:
        print(f"overhead: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
