"""Robot-days driven and proven safe: `python -m tests.tools.proof --robot-days 1000`.

A case is a number: it says layout, robots, scenario, rules, planner, what goes wrong, whether
robots have batteries and whether orders are packed. Each is run with a trace, which two checkers
look at that share no code, and a ledger counts units. A row for each case is written as soon as it
ends, so that the command may be stopped and called again, for days.
"""

from __future__ import annotations

import argparse
import csv
import random
import sys
import tempfile
import time
import traceback
import warnings
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

import rmfs
from tests.ledger import Ledger
from tests.second_checker import problems

if TYPE_CHECKING:
    from collections.abc import Callable

HOUR_S = 3600.0

SITES: tuple[tuple[str, str, tuple[int, ...]], ...] = (
    ("small", "small", (6, 10, 14)),
    ("small", "small-arrivals", (10,)),
    ("default", "default", (16, 32)),
    ("default", "poisson", (24,)),
    ("study-128", "pp-minimal", (96, 128)),
    ("study-128", "pp-minimal", (128,)),
    ("study-tiers", "pp-minimal", (24, 43)),
    ("study-32", "pp-minimal", (32,)),
    ("large", "large-arrivals", (20, 45)),
)
PLANNERS = ("time-windows",) * 9 + ("whca-n", "pibt", "far")
RULES = ("default", "default", "default", "random", "sequ")


@dataclass(frozen=True)
class Row:
    """What came of a case: figures, and in `problem` what should not be; nothing if all is well."""

    case: int
    layout: str
    scenario: str
    rules: str
    planner: str
    robots: int
    simulated_h: float
    disturbed: str
    battery: bool
    packing: bool
    robot_days: float
    distance_km: float
    orders: int
    disturbances: int
    charges: int
    packed: int
    motions: int
    wall_s: float
    problem: str


def drawn(number: int) -> dict[str, Any]:
    """Return the case of a number: what `rmfs.simulate` is called with."""
    rng = random.Random(f"proof/{number}")
    layout, scenario, fleets = rng.choice(SITES)
    planner = rng.choice(PLANNERS)
    hours = rng.choice((0.5, 1.0, 2.0))
    given: dict[str, Any] = {
        "layout.robots": rng.choice(fleets),
        "controllers.pp.name": planner,
        "scenario.warmup_s": 0.0,
        "scenario.duration_s": hours * HOUR_S,
    }
    wrong: dict[str, Any] = {}
    if rng.random() < 0.5:
        every_s = rng.choice((60.0, 150.0, 600.0))
        wrong["closures"] = {"every_s": every_s, "lasting_s": rng.choice((20.0, 60.0, 300.0))}
    if rng.random() < 0.4:
        wrong["breakdowns"] = {"every_s": 120.0, "lasting_s": rng.choice((10.0, 100.0, 600.0))}
    if rng.random() < 0.3:
        wrong["slow"] = {"every_s": 60.0, "lasting_s": 120.0, "speed_share": 0.4}
    if layout == "study-tiers":
        given["controllers.psa"] = {"name": "random", "prefer_same_tier": False}
        if rng.random() < 0.4:
            wrong["elevators_out"] = [[rng.choice((0, 1)), 600.0, 1200.0]]
    elif planner == "time-windows" and rng.random() < 0.25 and layout != "small":
        kind = rng.choice(("charger", "charger", "swap"))
        given[f"layout.other_stations.{kind}"] = {"kind": kind, "within": 8}
        given["scenario.energy.battery"] = {"capacity_wh": 500, "initial_least_share": 0.3}
        if kind == "charger" and rng.random() < 0.5:
            wrong["chargers"] = {"every_s": 3600.0, "lasting_s": 900.0}
    if wrong:
        given["scenario.disturbances"] = wrong
    rules = rng.choice(RULES if scenario == "small-arrivals" else RULES[:-1])
    if rng.random() < 0.2:
        # elsewhere whole orders go to the packers: to split them takes the time of many runs
        rules = "pile-on-split" if layout in ("small", "default") else rules
        given["scenario.packing"] = {"packers": 4, "order_s": 20.0, "bypass": False}
    return {
        "layout": layout,
        "scenario": scenario,
        "controllers": rules,
        "seed": number,
        "set": given,
    }


def proven(number: int) -> Row:
    """Run a case, and have everybody look at it."""
    case = drawn(number)
    given, began = case["set"], time.process_time()
    wrong = given.get("scenario.disturbances", {})
    ledger = Ledger()
    figures: dict[str, Any] = {}
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            run = rmfs.simulate(**case, trace=True, observers=[ledger])
        footprint = run.footprint
        figures = {
            "robots": run.layout.robots,
            "distance_km": round(float(footprint["distance_m"]) / 1000, 3),
            "orders": int(footprint["orders_completed"]),
            "disturbances": int(footprint["disturbances"]),
            "charges": counted(footprint, "charges"),
            "packed": counted(footprint, "orders_packed"),
            "motions": len(run.trace["robot"]),
        }
        problem = refuted(run, ledger)
    except Exception as error:
        problem = f"{type(error).__name__}: {error} {traceback.format_exc()[-400:]}"
    hours = given["scenario.duration_s"] / HOUR_S
    robots = figures.pop("robots", given["layout.robots"])
    counts = ("orders", "disturbances", "charges", "packed", "motions")
    empty = {"distance_km": 0.0, **dict.fromkeys(counts, 0)}
    return Row(
        case=number,
        layout=case["layout"],
        scenario=case["scenario"],
        rules=case["controllers"],
        planner=given["controllers.pp.name"],
        robots=robots,
        simulated_h=hours,
        disturbed=" ".join(sorted(wrong)),
        battery="scenario.energy.battery" in given,
        packing="scenario.packing" in given,
        robot_days=round(robots * hours / 24, 4),
        **{**empty, **figures},
        wall_s=round(time.process_time() - began, 1),
        problem=" ".join(problem.split()),
    )


def counted(footprint: Any, name: str) -> int:
    """Return a figure of a footprint; 0 where it was not counted."""
    value = footprint.get(name, 0)
    return 0 if pd.isna(value) else int(value)


def refuted(run: Any, ledger: Ledger) -> str:
    """Return what is wrong with a run; nothing if it is right."""
    report = run.check()
    if not report.ok:
        return f"first checker: {report.summary(3)}"
    with tempfile.TemporaryDirectory() as folder:
        found = problems(run.save(Path(folder) / "run").path)
    if found:
        return f"second checker: {'; '.join(found[:3])}"
    try:
        ledger.check()  # type: ignore[no-untyped-call]
    except AssertionError as error:
        return f"ledger: {error}"
    return ""


def done(path: Path) -> list[Row]:
    """Read the rows of cases that have ended."""
    if not path.exists():
        return []
    with path.open(newline="", encoding="utf-8") as file:
        return [_typed(row) for row in csv.DictReader(file)]


def _typed(row: dict[str, str]) -> Row:
    types: dict[str, Callable[[str], Any]] = {
        "int": int,
        "float": float,
        "str": str,
        "bool": lambda text: text == "True",
    }
    return Row(**{one.name: types[str(one.type)](row[one.name]) for one in fields(Row)})


def drive(path: Path, first: int, robot_days: float, seconds: float) -> list[Row]:
    """Run cases that have not ended yet, until enough is driven or the time is over."""
    rows = done(path)
    known = {row.case for row in rows}
    path.parent.mkdir(parents=True, exist_ok=True)
    until, number = time.monotonic() + seconds, first
    while sum(row.robot_days for row in rows) < robot_days and time.monotonic() < until:
        if number not in known:
            row = proven(number)
            rows.append(row)
            new = not path.exists()
            with path.open("a", newline="", encoding="utf-8") as file:
                writer = csv.DictWriter(file, [one.name for one in fields(Row)])
                if new:
                    writer.writeheader()
                writer.writerow(asdict(row))
            told = row.problem or "safe"
            print(f"case {number}: {row.robot_days} robot-days, {row.wall_s} s: {told}", flush=True)
        number += 1
    return rows


def main(arguments: list[str] | None = None) -> int:
    """Return the exit code: 1 if a case is not right."""
    parser = argparse.ArgumentParser(prog="python -m tests.tools.proof", description=__doc__)
    parser.add_argument("--robot-days", type=float, default=10_000.0, help="where to stop")
    parser.add_argument("--seconds", type=float, default=float("inf"), help="or after this time")
    parser.add_argument("--first", type=int, default=0, help="number of the first case")
    parser.add_argument("--case", type=int, help="run one case again")
    parser.add_argument("--out", type=Path, default=Path("results/proof/cases.csv"))
    given = parser.parse_args(arguments)
    if given.case is not None:
        row = proven(given.case)
        print(drawn(given.case), row, sep="\n")
        return bool(row.problem)
    rows = drive(given.out, given.first, given.robot_days, given.seconds)
    days = sum(row.robot_days for row in rows)
    disturbed = sum(24 * row.robot_days for row in rows if row.disturbances)
    failed = [row.case for row in rows if row.problem]
    print(table(rows))
    print(f"{len(rows)} cases, {days:.1f} robot-days, {disturbed:.0f} robot-hours disturbed")
    print(f"not right: {failed or 'none'}")
    return bool(failed)


def table(rows: list[Row]) -> str:
    """Return sums over all cases, those that were disturbed, those of each layout and so on."""
    parts: dict[str, list[Row]] = {"all": rows, "disturbed": [r for r in rows if r.disturbances]}
    for name in ("layout", "planner", "rules"):
        for value in sorted({getattr(row, name) for row in rows}):
            parts[f"{name} {value}"] = [row for row in rows if getattr(row, name) == value]
    parts["batteries"] = [row for row in rows if row.battery]
    parts["packing"] = [row for row in rows if row.packing]
    sums = ("robot_days", "distance_km", "orders", "disturbances", "charges", "packed")
    lines = [" | ".join(("cases of", "cases", "robot_hours", *sums, "not right"))]
    for name, mine in parts.items():
        figures = [sum(getattr(row, one) for row in mine) for one in sums]
        days = figures[0]
        wrong = [row.case for row in mine if row.problem]
        cells = [len(mine), round(24 * days), round(days, 1), *map(round, figures[1:])]
        lines.append(" | ".join((name, *(f"{cell:,}" for cell in cells), str(wrong or "none"))))
    return "\n".join(lines)


if __name__ == "__main__":
    sys.exit(main())
