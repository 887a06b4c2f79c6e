"""Many short disturbed runs: `python -m tests.tools.disturbed --seeds 1000 --seconds 3600`.

Every mix of closures, breakdowns, slow robots and late motions, on every shipped layout, with one
seed after the other. A run must come to its end, its trace must be proven safe, and its books must
be right. It is interrupted after a while: then it has no end. A row for each run is written as soon
as it ends, so that the command may be stopped and called again.
"""

from __future__ import annotations

import argparse
import csv
import signal
import sys
import time
import warnings
from contextlib import contextmanager
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING, Any

import rmfs
from tests.ledger import Ledger

if TYPE_CHECKING:
    from collections.abc import Iterator

SITES = {
    "small": ("small-arrivals", 240.0),
    "demonstrator": ("demonstrator", 240.0),
    "basic": ("basic", 90.0),
    "default": ("default", 120.0),
    "default-32": ("default", 90.0),
    "study-32": ("pp-minimal", 60.0),
    "study-tiers": ("pp-minimal", 60.0),
    "large": ("large-arrivals", 40.0),
    "study-128": ("pp-minimal", 30.0),
}
"""Scenario and simulated seconds for every shipped layout: less where a run costs more."""

WRONG: dict[str, dict[str, Any]] = {
    "closures": {"every_s": 10.0, "lasting_s": 20.0},
    "breakdowns": {"every_s": 10.0, "lasting_s": 20.0},
    "slow": {"every_s": 10.0, "lasting_s": 30.0, "speed_share": 0.5},
    "late_motions": {"probability": 0.2, "least_s": 0.5, "most_s": 5.0},
}
MIXES = ["+".join(mix) for size in range(1, 5) for mix in combinations(WRONG, size)]

LONGEST_S = 300
"""Wall time after which a run counts as one without end."""

COLUMNS = ("layout", "mix", "seed", "disturbances", "distance_m", "cpu_s", "problem")
Row = dict[str, Any]


class EndlessError(Exception):
    """A run has taken too long."""


@contextmanager
def patience(seconds: int) -> Iterator[None]:
    """Interrupt what takes longer."""

    def enough(*_: object) -> None:
        raise EndlessError(f"no end after {seconds} s")

    before = signal.signal(signal.SIGALRM, enough)
    signal.alarm(seconds)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def driven(layout: str, mix: str, seed: int) -> Row:
    """Drive one run and look at it."""
    scenario, duration_s = SITES[layout]
    given = {
        "scenario.warmup_s": 0.0,
        "scenario.duration_s": duration_s,
        "scenario.disturbances": {kind: WRONG[kind] for kind in mix.split("+")},
    }
    row: Row = {"layout": layout, "mix": mix, "seed": seed, "disturbances": 0, "distance_m": 0.0}
    ledger, began, problem = Ledger(), time.process_time(), ""
    try:
        with warnings.catch_warnings(), patience(LONGEST_S):
            warnings.simplefilter("ignore")
            run = rmfs.simulate(
                layout, scenario, "default", seed=seed, set=given, trace=True, observers=[ledger]
            )
            row["disturbances"] = int(run.footprint["disturbances"])
            row["distance_m"] = round(float(run.footprint["distance_m"]), 1)
            report = run.check()
            problem = "" if report.ok else report.summary(3)
            ledger.check()  # type: ignore[no-untyped-call]
    except Exception as error:
        problem = f"{type(error).__name__}: {error}"
    cpu_s = round(time.process_time() - began, 2)
    return {**row, "cpu_s": cpu_s, "problem": " ".join(problem.split())}


def done(path: Path) -> list[Row]:
    """Read the rows of runs that have ended."""
    if not path.exists():
        return []
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def drive(path: Path, seeds: int, seconds: float) -> list[Row]:
    """Drive what has not been driven, seed by seed, until all is done or the time is over."""
    rows = done(path)
    known = {(row["layout"], row["mix"], int(row["seed"])) for row in rows}
    cases = [(layout, mix, seed) for seed in range(seeds) for layout in SITES for mix in MIXES]
    until = time.monotonic() + seconds
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS)
        if not rows:
            writer.writeheader()
        for case in cases:
            if time.monotonic() > until:
                break
            if case not in known:
                row = driven(*case)
                writer.writerow(row)
                file.flush()
                rows.append(row)
                if row["problem"]:
                    print(*case, row["problem"], flush=True)
    return rows


def table(rows: list[Row]) -> str:
    """Return sums for each layout, and for all."""
    lines = ["layout | runs | seeds of every mix | disturbances | km | cpu s a run | not right"]
    for layout in (*SITES, "all"):
        mine = [row for row in rows if layout in ("all", row["layout"])]
        if mine:
            seeds = [sum(row["mix"] == mix for row in mine) for mix in MIXES]
            disturbances = sum(int(row["disturbances"]) for row in mine)
            km = sum(float(row["distance_m"]) for row in mine) / 1000
            cpu_s = sum(float(row["cpu_s"]) for row in mine) / len(mine)
            wrong = sum(bool(row["problem"]) for row in mine)
            cells = (len(mine), min(seeds), disturbances, f"{km:.1f}", f"{cpu_s:.2f}", wrong)
            lines.append(" | ".join([layout, *map(str, cells)]))
    return "\n".join(lines)


def main(arguments: list[str] | None = None) -> int:
    """Return the exit code: 1 if a run is not right."""
    parser = argparse.ArgumentParser(prog="python -m tests.tools.disturbed", description=__doc__)
    parser.add_argument("--seeds", type=int, default=1000, help="how many of every mix and layout")
    parser.add_argument("--seconds", type=float, default=float("inf"), help="or stop after these")
    parser.add_argument("--out", type=Path, default=Path("results/disturbed/runs.csv"))
    given = parser.parse_args(arguments)
    rows = drive(given.out, given.seeds, given.seconds)
    print(table(rows))
    return int(any(row["problem"] for row in rows))


if __name__ == "__main__":
    sys.exit(main())
