"""Spoil inputs for so long, or so many; or one case again: `python -m tests.tools.spoil`."""

from __future__ import annotations

import argparse
import os
import shlex
import sys
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from tests.tools.spoil import samples
from tests.tools.spoil.trial import FINE, Verdict, tried


def warm() -> None:
    """Import what commands import, so that no case pays for it."""
    import rmfs.experiments.commands
    import rmfs.rawsimo.folder
    import rmfs.simulation.run
    import rmfs.solvers.decisions.commands
    import rmfs.view.commands  # noqa: F401


def spoil(numbers: range, seconds: float, out: Path) -> tuple[Counter[str], list[Verdict]]:
    """Run case after case, until the cases or the seconds are used up.

    Parameters
    ----------
    out
        Folder for whole samples and for the files of cases that fail.

    Returns
    -------
    How many ended in which way, and those that failed.
    """
    whole = samples.prepared((out / "whole").absolute())
    counts: Counter[str] = Counter()
    failed = []
    until = time.monotonic() + seconds
    for number in numbers:
        if time.monotonic() > until:
            break
        verdict = tried(number, whole, out / "failed")
        counts[verdict.outcome] += 1
        if not verdict.fine or verdict.outcome == "long":
            print(f"{verdict}\n  rmfs {shlex.join(verdict.case.arguments)[:600]}", flush=True)
        if not verdict.fine:
            failed.append(verdict)
        if counts.total() % 500 == 0:
            print(f"{counts.total()} cases, {len(failed)} failed", flush=True)
    return counts, failed


def spoil_together(
    first: int, cases: int, seconds: float, out: Path, processes: int
) -> tuple[Counter[str], list[Verdict]]:
    """Share the cases among processes, as `spoil` runs them."""
    samples.prepared((out / "whole").absolute())
    shares = [range(first + one, first + cases, processes) for one in range(processes)]
    counts: Counter[str] = Counter()
    failed = []
    with ProcessPoolExecutor(processes) as pool:
        parts = [pool.submit(spoil, share, seconds, out) for share in shares]
        for part in parts:
            counted, bad = part.result()
            counts.update(counted)
            failed.extend(bad)
    return counts, failed


def main(arguments: list[str] | None = None) -> int:
    """Return the exit code: 1 if a case failed."""
    parser = argparse.ArgumentParser(prog="python -m tests.tools.spoil", description=__doc__)
    parser.add_argument("--first", type=int, default=0, help="number of the first case")
    parser.add_argument("--cases", type=int, default=10**9, help="number of cases, at most")
    parser.add_argument("--seconds", type=float, default=120.0, help="wall time to go on for")
    parser.add_argument("--processes", type=int, default=1, help="how many cases run at a time")
    parser.add_argument("--case", type=int, help="run one case again, and tell all of it")
    parser.add_argument("--out", type=Path, default=Path("results/spoil"))
    given = parser.parse_args(arguments)
    os.environ["COLUMNS"] = "200"
    warm()
    if given.case is not None:
        whole = samples.prepared((given.out / "whole").absolute())
        verdict = tried(given.case, whole, given.out / "failed")
        print(f"{verdict} ({verdict.seconds:.1f} s)\nrmfs {shlex.join(verdict.case.arguments)}")
        return 0 if verdict.fine else 1
    where = (given.first, given.cases, given.seconds, given.out)
    counts, failed = spoil_together(*where, given.processes)
    fine = ", ".join(f"{counts[outcome]} {outcome}" for outcome in FINE)
    print(f"{counts.total()} cases: {fine}, {len(failed)} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
