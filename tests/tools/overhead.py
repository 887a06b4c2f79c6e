"""What the harness itself costs: `python -m tests.tools.overhead`.

Real runs of ten seconds or more are done by the real command, `rmfs experiment run`, in an
interpreter of its own. What it takes beyond the time that its runs spend simulating is overhead:
the start of the interpreter, imports, the plan, processes, loading, tables, storing. As the time of
the simulations is taken inside the runs, a busy machine slows both alike; beside it the same is
told in processor time, which other work on the machine does not touch. The driver's memory is
looked at on the way.

With `--asleep` the runs simulate nothing but sleep, and so leave the cores to the harness. They go
the whole way of real ones (a process each, a real footprint and time series back, the row stored),
many more at a time than there are cores: 500 runs take a minute, and the processor time of all
processes together is what the harness costs.
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

from rmfs.errors import InputError
from rmfs.experiments.extras import optional
from rmfs.experiments.running.driver import Silent
from rmfs.files import write_text
from tests.tools.checkout import ENVIRONMENT

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd

    from rmfs.experiments.running.job import Job, Outcome

DESIGN = """\
format = "rmfs-design/1"
name = "overhead"
replications = {replications}
keep = ["series"]

[base]
layout = "default"
scenario = "default"
controllers = "default"
"scenario.duration_s" = {duration_s}

[factors]
"layout.robots" = [16, 20, 24, 28, 32]
"""
ARMS = 5
TOLD = "cost.json"
LOOK_S = 1.0
"""Time between two looks at the driver's memory."""

SHORT_S = 600.0
"""Simulated time of the one run whose tables all sleeping runs come back with."""


@dataclass(frozen=True)
class Cost:
    """What an experiment of real runs has cost.

    Attributes
    ----------
    runs, jobs
        How many runs, how many at a time.
    wall_s
        From the start of the interpreter to its end.
    simulating_s
        What each run spent simulating, in the order they ended.
    gaps_s
        Between the ends of two runs, what was not simulation; empty for several jobs at a time.
    simulating_cpu_s, harness_cpu_s
        Processor time of the simulations; of driver, fork server, and the rest of the runs.
    memory_mb
        Resident memory of the driver, from time to time.
    """

    runs: int
    jobs: int
    wall_s: float
    simulating_s: Sequence[float]
    gaps_s: Sequence[float]
    simulating_cpu_s: float
    harness_cpu_s: float
    memory_mb: Sequence[float]

    @property
    def overhead(self) -> float:
        """What was not simulation, as a share of the simulations' time."""
        return self.wall_s * self.jobs / sum(self.simulating_s) - 1.0

    @property
    def overhead_cpu(self) -> float:
        """The same in processor time."""
        return self.harness_cpu_s / self.simulating_cpu_s

    def __str__(self) -> str:
        """Say it in lines."""
        lines = [
            f"{self.runs} runs of {min(self.simulating_s):.1f} to {max(self.simulating_s):.1f} s, "
            f"{self.jobs} at a time: {self.wall_s:.1f} s",
            f"overhead: {self.overhead:.2%} of the time of the simulations",
            f"in processor time: {self.harness_cpu_s:.1f} s beside {self.simulating_cpu_s:.1f} s "
            f"of simulation, {self.overhead_cpu:.2%}",
            *_memory_lines(self.memory_mb),
        ]
        if len(self.gaps_s) >= ARMS:
            third = max(1, len(self.gaps_s) // 3)
            first, last = (
                1000 * _mean(part) for part in (self.gaps_s[:third], self.gaps_s[-third:])
            )
            start_s = self.wall_s - sum(self.simulating_s) - sum(self.gaps_s)
            lines += [
                f"of that {start_s:.2f} s once, {1000 * _mean(self.gaps_s):.0f} ms a run",
                f"a run of the first third costs {first:.0f} ms, one of the last {last:.0f} ms",
            ]
        return "\n".join(lines)


@dataclass(frozen=True)
class CostAsleep:
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
        Resident memory of the driver after each run, and when all are stored.
    """

    runs: int
    jobs: int
    asleep_s: float
    wall_s: float
    cpu_s: float
    memory_mb: Sequence[float] = field(default_factory=list)

    @property
    def overhead(self) -> float:
        """Processor time of the harness as a share of the time of the runs."""
        return self.cpu_s / (self.runs * self.asleep_s)

    def __str__(self) -> str:
        """Say it in lines."""
        return "\n".join(
            [
                f"{self.runs} sleeping runs of {self.asleep_s:g} s, {self.jobs} at a time: "
                f"{self.wall_s:.1f} s",
                f"processor time: {self.cpu_s:.1f} s, {1000 * self.cpu_s / self.runs:.0f} ms a run",
                f"overhead: {self.overhead:.2%} of the time of the runs",
                *_memory_lines(self.memory_mb),
            ]
        )


def _memory_lines(memory_mb: Sequence[float]) -> list[str]:
    early = memory_mb[len(memory_mb) // 10]
    return [
        f"memory of the driver: {early:.0f} MB after a tenth of the time, "
        f"{max(memory_mb):.0f} MB at most, {memory_mb[-1]:.0f} MB at the end"
    ]


def _mean(values: Sequence[float]) -> float:
    return sum(values) / len(values)


def measure(
    runs: int, duration_s: float, jobs: int, folder: Path, file: Path | None = None
) -> Cost:
    """Do an experiment of real runs by the command of users.

    Parameters
    ----------
    runs
        A multiple of five: the arms of the experiment.
    duration_s
        Simulated time of each run.
    jobs
        Runs at a time.
    folder
        Where design and results go; empty or absent.
    file
        A .csv table to write, with its provenance. Default: none.

    Raises
    ------
    InputError
        If the number of runs is wrong or the folder holds something.
    """
    from rmfs.experiments.results import load

    psutil = optional("psutil", "experiments", "the cost of the harness")
    path = _design(folder, runs, duration_s)
    given = ["experiment", "run", str(path), "--out", str(folder / "out"), "--jobs", str(jobs)]
    memory_mb, cpu_s = [], 0.0
    begun = time.perf_counter()
    with subprocess.Popen([sys.executable, "-m", "rmfs", *given]) as command:
        driver = psutil.Process(command.pid)
        while command.poll() is None:
            try:
                rss = driver.memory_info().rss
                if not rss:
                    break  # it has ended
                memory_mb.append(rss / 1e6)
                cpu_s = sum(sum(one.cpu_times()[:2]) for one in (driver, *_servers(driver)))
                command.wait(LOOK_S)
            except (subprocess.TimeoutExpired, psutil.NoSuchProcess):
                continue
        wall_s = time.perf_counter() - begun
    if command.returncode:
        raise InputError(f"{path}: the experiment ended with code {command.returncode}")
    rows = load(folder / "out").sort_values("finished", kind="stable")
    inside = rows["cpu_s"] * rows["wall_s"] / rows["elapsed_s"]
    cost = Cost(
        runs,
        jobs,
        wall_s,
        [float(s) for s in rows["wall_s"]],
        gaps(rows) if jobs == 1 else [],
        float(inside.sum()),
        cpu_s + float((rows["cpu_s"] - inside).sum()),
        memory_mb,
    )
    if file is not None:
        _publish(cost, rows, path, file)
    return cost


def _publish(cost: Cost, rows: pd.DataFrame, design: Path, file: Path) -> None:
    """Write what it has cost as a table, with its provenance."""
    from rmfs.experiments.design.planning import plan
    from rmfs.experiments.provenance import write

    figures = {
        "runs": cost.runs,
        "shortest run, s": min(cost.simulating_s),
        "wall time, s": cost.wall_s,
        "overhead by the clock, %": 100 * cost.overhead,
        "overhead in processor time, %": 100 * cost.overhead_cpu,
        "memory of the driver at most, MB": max(cost.memory_mb),
    }
    lines = ["figure,value", *(f'"{name}",{value}' for name, value in figures.items())]
    write_text(file, "\n".join(lines) + "\n")
    made = plan(design)
    columns = ["wall_s"]
    write(file, rows, design=made.design.name, design_hash=made.hash, columns=columns)


def _servers(driver: Any) -> list[Any]:
    """Return the processes that the driver has started itself, which the runs are forked from."""
    return list(driver.children())


def _design(folder: Path, runs: int, duration_s: float) -> Path:
    if runs < 1 or runs % ARMS:
        raise InputError(f"--runs {runs}: must be a multiple of {ARMS}")
    if folder.exists() and any(folder.iterdir()):
        raise InputError(f"{folder}: holds something already; nothing finished may be found")
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "overhead.toml"
    text = DESIGN.format(replications=runs // ARMS, duration_s=duration_s)
    path.write_text(text, encoding="utf-8")
    return path


def gaps(rows: pd.DataFrame) -> list[float]:
    """Return what lies between the ends of runs done one after the other, less the simulation.

    Parameters
    ----------
    rows
        In the order they ended: `finished` (ISO 8601) and `wall_s`.
    """
    import pandas as pd

    ended = pd.to_datetime(rows["finished"])
    between = ended.diff().dt.total_seconds() - rows["wall_s"]
    return [float(s) for s in between.iloc[1:]]


def measure_asleep(runs: int, asleep_s: float, jobs: int) -> CostAsleep:
    """Do an experiment of sleeping runs in an interpreter of its own.

    Parameters
    ----------
    runs
        A multiple of five: the arms of the experiment.
    asleep_s
        What each run takes.
    jobs
        Runs at a time.

    Raises
    ------
    InputError
        If the number of runs is wrong.
    """
    with tempfile.TemporaryDirectory() as name:
        path = _design(Path(name) / "overhead", runs, SHORT_S)
        given = [str(path), str(asleep_s), str(jobs)]
        code = f"from tests.tools.overhead import drive_asleep; drive_asleep(*{given!r})"
        begun = time.perf_counter()
        subprocess.run([sys.executable, "-c", code], check=True, env=ENVIRONMENT)
        wall_s = time.perf_counter() - begun
        told = json.loads(path.with_name(TOLD).read_text(encoding="utf-8"))
    return CostAsleep(runs, jobs, asleep_s, wall_s, told["cpu_s"], told["memory_mb"])


def drive_asleep(design: str, asleep_s: str, jobs: str) -> None:
    """Do the whole experiment and write down what it cost; the inside of `measure_asleep`."""
    from rmfs.experiments.design.planning import plan
    from rmfs.experiments.running.driver import drive
    from rmfs.experiments.running.execute import execute
    from rmfs.experiments.running.local import LocalProcesses
    from rmfs.experiments.store import Store

    path = Path(design)
    made = plan(path)
    real = execute(made.job(made.arms[0], 1))
    engine = LocalProcesses(int(jobs), partial(asleep, float(asleep_s), real))
    memory = _Memory(optional("psutil", "experiments", "the cost of the harness").Process())
    done = drive(made, Store(path.parent / "out"), engine, memory)
    assert done.finished == done.wanted and not done.failed
    memory.look()
    told = {"cpu_s": memory.cpu_s(), "memory_mb": memory.mb}
    path.with_name(TOLD).write_text(json.dumps(told), encoding="utf-8")


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
        self.look()

    def look(self) -> None:
        self.mb.append(round(self.process.memory_info().rss / 1e6, 1))

    def cpu_s(self) -> float:
        """Return the processor time of the driver, the fork server and all workers."""
        return sum(sum(one.cpu_times()[:4]) for one in (self.process, *self.process.children()))


def main(arguments: list[str] | None = None) -> int:
    """Measure and tell."""
    parser = argparse.ArgumentParser(prog="python -m tests.tools.overhead")
    parser.add_argument("--runs", type=int, default=500)
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time (default: 2)")
    parser.add_argument(
        "--duration",
        type=float,
        default=120_000.0,
        metavar="S",
        help="simulated time of a run (default: 120,000 s: 10 s or more of a fast core)",
    )
    parser.add_argument(
        "--asleep", type=float, metavar="S", help="runs that take so long and simulate nothing"
    )
    parser.add_argument("--file", type=Path, help="a .csv table of the figures of real runs")
    given = parser.parse_args(arguments)
    try:
        if given.asleep is not None:
            print(measure_asleep(given.runs, given.asleep, given.jobs))
        else:
            with tempfile.TemporaryDirectory() as folder:
                print(measure(given.runs, given.duration, given.jobs, Path(folder), given.file))
    except InputError as error:
        print(f"overhead: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
