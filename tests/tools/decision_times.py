"""How long decisions take, rule by rule, in runs of a large warehouse.

`python -m tests.tools.decision_times` writes the page docs/decision-times.md. Every rule works
in a run of its own for five minutes, beside the default rules: on the layout of the
path-planning study with 128 robots and 1,965 pods, 20 pick and 12 replenishment stations, 1,000
SKUs, and always 200 orders and 200 bundles waiting. A call lasts from the question to the last
answer; the time in which other controllers were consulted is left out.
"""

from __future__ import annotations

import argparse
import platform
import statistics
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

import rmfs
from rmfs.control import registry
from rmfs.control.problems import Problem
from rmfs.files import write_text
from rmfs.observer import Observer

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from rmfs.simulation.result import Run

PAGE = Path("docs") / "decision-times.md"
LAYOUT = {"pod_capacity": 500.0, "replenishment_station_capacity": 1000.0}
DURATION_S, LONG_S = 300.0, 3600.0
LIMIT_MS = 1.0

HEAD = """\
# How long decisions take

Times are milliseconds of wall time in runs of a large warehouse: 1,965 pods, 128 robots, 20 pick
and 12 replenishment stations, 1,000 SKUs, a constant backlog of 200 orders and 200 bundles. Each
rule is measured in a run of its own, of five simulated minutes. The other problems are decided by
their default rules, unless the measured rule needs other rules or its row names other rules.

In a *call*, a controller is asked once; it makes one decision, several or none. The column
*median, decision* shows the median of the time per decision: the time of a call divided by the
number of its decisions. For this column, calls without decisions are left out; if the rule made
no decision at all, every call counts. The other columns are the mean, the 95 % quantile and the
maximum of the times of all calls. If a controller asks other controllers during its call, their
time is not included. Rows such as *only age* stand for PPS `lexicographic` with only the
criterion named; ties are broken at random. In the row *all pooled orders count*, PPS considers
all orders in the pools of POA `queue`, not only the orders that a single pod can complete. This
page is written by `python -m tests.tools.decision_times`.

For every rule, the median should stay below one millisecond. The benchmarks
(`pytest -m benchmark tests/control`), which time a single decision repeatedly, have the same limit.
"""


@dataclass(frozen=True)
class Case:
    """A rule to be timed.

    Attributes
    ----------
    label
        What it is called in the table.
    tables
        Its own table of the controllers file, and those of partners it needs.
    """

    problem: Problem
    label: str
    tables: Mapping[str, Any] = field(default_factory=dict)


DUMMY = {"name": "dummy"}
WITH_PARTNERS: dict[tuple[Problem, str], dict[str, Any]] = {
    (Problem.RPS, "nearest"): {"roa": {"name": "random"}},
    (Problem.RPS, "reactive"): {"roa": {"name": "random"}},
    (Problem.TA, "random"): {"pps": DUMMY},
    (Problem.TA, "brute-force"): {"pps": DUMMY, "psa": DUMMY},
}
FEWER_STATIONS = {"sa": {"name": "constant-ratio", "active_share": 0.5}}
"""So that robots are idle, who else would move pods about?"""
SCORERS = ("random", "nearest", "pile-on", "age", "lateness", "completeable", "demand", "fill")
ANY_QUEUED = {"consider": "assigned-and-queued", "reserve": "assigned-and-queued"}
NEVER_ASKED = {(Problem.MM, "none"), (Problem.REPOSITIONING, "none")}


def cases() -> list[Case]:
    """Return all rules with their parameters' defaults, and the criteria of pods one by one."""
    made = []
    for problem in Problem:
        for name in registry.built_in(problem):
            rule = registry.find(problem, name)
            if problem is Problem.PP or rule.is_dummy or (problem, name) in NEVER_ASKED:
                continue
            tables = {str(problem): {"name": name}, **WITH_PARTNERS.get((problem, name), {})}
            if problem is Problem.REPOSITIONING:
                tables |= FEWER_STATIONS
            elif problem is Problem.MM:
                tables["mm"] = _exchanges(name)
            made.append(Case(problem, name, tables))
        if problem is Problem.PPS:
            made += [
                Case(problem, f"only {criterion}", {"pps": {"pick_pod": [criterion, "random"]}})
                for criterion in SCORERS
            ]
            queue = {"poa": {"name": "queue"}}
            made.append(Case(problem, "lexicographic, with POA queue", queue))
            made.append(
                Case(
                    problem,
                    "lexicographic, with POA queue, all pooled orders count",
                    {**queue, "pps": ANY_QUEUED},
                )
            )
    return made


def _exchanges(name: str) -> dict[str, Any]:
    if name == "random":
        return {"name": name, "period_s": 60.0}
    entries = [
        {"at_s": 60.0 * n, "psa": {"name": ("random", "nearest")[n % 2]}} for n in range(1, 5)
    ]
    return {"name": name, "exchanges": entries}


class Calls(Observer):
    """Wall time (s) and decisions of every call of the controllers of one problem."""

    def __init__(self, problem: Problem) -> None:
        self._problem = str(problem)
        self.calls: list[tuple[float, int]] = []

    def decision(self, problem: str, time_s: float, wall_s: float, decisions: int) -> None:
        """Write a call down."""
        if problem == self._problem:
            self.calls.append((wall_s, decisions))


def simulate(
    tables: Mapping[str, Any], duration_s: float, seed: int, observers: Sequence[Observer] = ()
) -> Run:
    """Run the large warehouse with some rules in place of the default ones."""
    given = {
        "layout": LAYOUT,
        "scenario": {"duration_s": duration_s, "warmup_s": 0.0},
        "controllers": tables,
    }
    overrides = [
        ([part, key], value) for part, table in given.items() for key, value in table.items()
    ]
    return rmfs.simulate(
        "study-128", "default", "default", seed=seed, overrides=overrides, observers=observers
    )


def times(case: Case, seed: int = 0) -> dict[str, Any]:
    """Time the calls of one rule.

    Returns
    -------
    `problem`, `rule`, `calls`, `decisions`; `median` of the milliseconds per decision, and
    `mean`, `p95` and `max` of those per call.
    """
    timed = Calls(case.problem)
    simulate(case.tables, DURATION_S, seed, [timed])
    calls = pd.DataFrame(timed.calls, columns=["wall_s", "decisions"])
    wall_ms = 1000 * calls["wall_s"]
    decided = calls["decisions"] > 0 if (calls["decisions"] > 0).any() else slice(None)
    return {
        "problem": str(case.problem),
        "rule": case.label,
        "calls": len(calls),
        "decisions": int(calls["decisions"].sum()),
        "median": float((wall_ms / calls["decisions"].clip(lower=1))[decided].median()),
        "mean": float(wall_ms.mean()),
        "p95": float(wall_ms.quantile(0.95)),
        "max": float(wall_ms.max()),
    }


def shares(runs: int = 3) -> dict[str, float]:
    """Return the shares of a run's time with the default rules, an hour: medians over seeds."""
    found: dict[str, list[float]] = {"decisions": [], "planning": []}
    for seed in range(runs):
        run = simulate({}, LONG_S, seed)
        found["decisions"].append(float(run.footprint["decision_wall_s"]) / run.wall_s)
        found["planning"].append(run.traffic.counters()["planning_s"] / run.wall_s)
    return {name: statistics.median(values) for name, values in found.items()}


def page(frame: pd.DataFrame, share: Mapping[str, float]) -> str:
    """Write the page."""
    rest = 1 - share["decisions"] - share["planning"]
    lines = [
        HEAD,
        f"With the default rules, decisions take {share['decisions']:.0%} of the wall time of a "
        "run of one simulated hour in this warehouse, path planning "
        f"{share['planning']:.0%}, and everything else {rest:.0%} (each rounded).\n",
        "| problem | rule | calls | decisions "
        "| median, decision | mean, call | 95 %, call | max, call |",
        "|---|---|---:|---:|---:|---:|---:|---:|",
    ]
    for row in frame.to_dict("records"):
        spoken = " | ".join(f"{row[name]:.3f}" for name in ("median", "mean", "p95", "max"))
        told = f"{row['problem']} | {row['rule']} | {row['calls']} | {row['decisions']}"
        lines.append(f"| {told} | {spoken} |")
    lines += ["", f"Measured on {platform.platform()}, Python {platform.python_version()}.", ""]
    return "\n".join(lines)


def main(arguments: list[str] | None = None) -> int:
    """Time every rule and write the page; exit code 1 if a median is above a millisecond."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--out", type=Path, default=PAGE, help=f"the page (default: {PAGE})")
    given = parser.parse_args(arguments)
    rows = []
    for case in cases():
        rows.append(times(case))
        print(f"{case.problem} {case.label}: {rows[-1]['median']:.3f} ms", flush=True)
    frame = pd.DataFrame(rows)
    write_text(given.out, page(frame, shares()))
    print(given.out)
    slow = frame[~(frame["median"] < LIMIT_MS)]
    for row in slow.itertuples(index=False):
        print(f"{row.problem} {row.rule}: more than {LIMIT_MS:g} ms", file=sys.stderr)
    return int(len(slow) > 0)


if __name__ == "__main__":
    sys.exit(main())
