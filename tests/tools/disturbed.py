"""Many short disturbed runs: `python -m tests.tools.disturbed --seeds 1000 --seconds 3600`.

Every mix of closures, breakdowns, slow robots and late motions, on every shipped layout, with one
seed after the other. The runs are short, but something strikes every other second. A run must come
to its end, the trace must be proven safe, and the books must be right. A run that takes too long is
interrupted and counts as one without end. Each run's row is written as soon as the run ends, so the
command can be stopped and resumed.

Each layout is loaded and checked once. Little stock, few orders and no footprint keep the runs
cheap: none of these affects the traffic.
"""

from __future__ import annotations

import argparse
import csv
import gc
import signal
import sys
import time
import warnings
from collections import Counter
from contextlib import contextmanager
from functools import cache
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from rmfs import layout as layouts
from rmfs.simulation.run import Simulation
from tests.ledger import Ledger

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rmfs import Layout

SITES = {
    "small": ("small-arrivals", 60.0),
    "demonstrator": ("demonstrator", 60.0),
    "basic": ("basic", 40.0),
    "default": ("default", 40.0),
    "default-32": ("default", 40.0),
    "study-32": ("pp-minimal", 30.0),
    "study-tiers": ("pp-minimal", 12.0),
    "large": ("large-arrivals", 12.0),
    "study-128": ("pp-minimal", 12.0),
}
"""Scenario and simulated seconds for every shipped layout: less where a run costs more."""

LIGHTER: dict[str, dict[str, Any]] = {
    "pp-minimal": {
        "skus.count": 100,
        "skus.space_per_unit.value": 5.0,
        "stock.initial_share": 0.3,
        "demand.orders": 200,
    },
    "large-arrivals": {"stock.initial_share": 0.3, "replenishment.bundles": 100},
}
"""What makes a scenario cheaper: fewer units in stock, and as much traffic."""

WRONG: dict[str, dict[str, Any]] = {
    "closures": {"every_s": 1.5, "lasting_s": 4.0},
    "breakdowns": {"every_s": 1.5, "lasting_s": 4.0},
    "slow": {"every_s": 1.5, "lasting_s": 4.0, "speed_share": 0.5},
    "late_motions": {"probability": 0.3, "least_s": 0.5, "most_s": 5.0},
}
KINDS = {"closure": "closures", "breakdown": "breakdowns", "slow": "slow"}
"""What a disturbance of each kind is called in a scenario."""

MIXES = ["+".join(mix) for size in range(1, 5) for mix in combinations(WRONG, size)]

LONGEST_S = 300
"""Wall time after which a run counts as one without end."""

COLUMNS = ("layout", "mix", "seed", *WRONG, "distance_m", "cpu_s", "problem")
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


class Checked(Simulation):
    """A simulation on a layout that has been checked."""

    checks_layout: ClassVar[bool] = False


@cache
def checked(name: str) -> Layout:
    """Load and check a layout."""
    layout = layouts.load(name)
    layouts.refuse(layout, name)
    gc.freeze()  # the layout stays, so that no collection need look at it
    return layout


def driven(layout: str, mix: str, seed: int) -> Row:
    """Drive one run and look at it."""
    scenario, duration_s = SITES[layout]
    kinds = mix.split("+")
    given = {
        "warmup_s": 0.0,
        "duration_s": duration_s,
        "disturbances": {kind: WRONG[kind] for kind in kinds},
        **LIGHTER.get(scenario, {}),
    }
    row: Row = {"layout": layout, "mix": mix, "seed": seed}
    row |= dict.fromkeys([*WRONG, "distance_m"], 0)
    ledger, began, problem = Ledger(), time.process_time(), ""
    try:
        with warnings.catch_warnings(), patience(LONGEST_S):
            warnings.simplefilter("ignore")
            simulation = Checked(
                checked(layout),
                scenario,
                "default",
                seed=seed,
                set={f"scenario.{key}": value for key, value in given.items()},
                trace=True,
                observers=[ledger],
            )
            simulation.run()
            run = simulation.result()
            struck = Counter(KINDS[one.kind] for one in run.disturbances.begun)
            struck["late_motions"] = int(run.traffic.counters()["late_motions"])
            row |= struck
            row["distance_m"] = round(float(run.traffic.motion()["distance_m"].sum()), 1)
            report = run.check()
            problem = "" if report.ok else report.summary(3)
            ledger.check()  # type: ignore[no-untyped-call]
    except (KeyboardInterrupt, SystemExit):
        raise
    except BaseException as error:  # a panic of the core is no Exception
        problem = f"{type(error).__name__}: {error}"
    cpu_s = round(time.process_time() - began, 2)
    return {**row, "cpu_s": cpu_s, "problem": " ".join(problem.split())}


def done(path: Path) -> list[Row]:
    """Read the rows of runs that have ended."""
    if not path.exists():
        return []
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def drive(
    path: Path, seeds: range, seconds: float, sites: Sequence[str] | None = None
) -> list[Row]:
    """Drive what has not been driven, seed by seed, until all is done or the time is over."""
    rows = done(path)
    known = {(row["layout"], row["mix"], int(row["seed"])) for row in rows}
    cases = [(layout, mix, seed) for seed in seeds for layout in sites or SITES for mix in MIXES]
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
    """Return sums for each layout, and for all; `whole`: runs in which every kind has struck."""
    cells = [
        "layout",
        "runs",
        "seeds of every mix",
        *WRONG,
        "km",
        "CPU s per run",
        "whole",
        "failed",
    ]
    lines = [" | ".join(cells)]
    for layout in (*SITES, "all"):
        mine = [row for row in rows if layout in ("all", row["layout"])]
        if mine:
            seeds = Counter((row["layout"], row["mix"]) for row in mine)
            sites = SITES if layout == "all" else [layout]
            least = min(seeds[site, mix] for site in sites for mix in MIXES)
            struck = [sum(int(row[kind]) for row in mine) for kind in WRONG]
            km = sum(float(row["distance_m"]) for row in mine) / 1000
            cpu_s = sum(float(row["cpu_s"]) for row in mine) / len(mine)
            whole = sum(all(int(row[kind]) for kind in row["mix"].split("+")) for row in mine)
            wrong = sum(bool(row["problem"]) for row in mine)
            sums = (layout, len(mine), least, *struck, f"{km:.1f}", f"{cpu_s:.2f}", whole, wrong)
            lines.append(" | ".join(map(str, sums)))
    return "\n".join(lines)


def main(arguments: list[str] | None = None) -> int:
    """Return the exit code: 1 if a run is not right."""
    parser = argparse.ArgumentParser(prog="python -m tests.tools.disturbed", description=__doc__)
    parser.add_argument("--seeds", type=int, default=1000, help="how many of every mix and layout")
    parser.add_argument("--seconds", type=float, default=float("inf"), help="or stop after these")
    parser.add_argument("--out", type=Path, default=Path("results/disturbed/runs.csv"))
    parser.add_argument(
        "--part",
        type=int,
        nargs=2,
        default=(0, 1),
        metavar=("I", "N"),
        help="only seeds I, I + N, I + 2 N, ...: N processes can write to the same file",
    )
    parser.add_argument("--layouts", nargs="*", choices=tuple(SITES), help="only these")
    given = parser.parse_args(arguments)
    seeds = range(given.part[0], given.seeds, given.part[1])
    rows = drive(given.out, seeds, given.seconds, given.layouts)
    print(table(rows))
    return int(any(row["problem"] for row in rows))


if __name__ == "__main__":
    sys.exit(main())
