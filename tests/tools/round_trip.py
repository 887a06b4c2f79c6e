"""Round trip of decisions: what runs have recorded is solved anew from its files, and is the same.

`python -m tests.tools.round_trip` simulates half of the default floor under each set of controllers
until 500 questions are written, reads every file, and answers it as the controller had it answered:
the same method, limits of work and seed. The answer must be the recorded one to the last bit:
values, objective, bound and work. The checker, which knows no model, must accept it. Questions of
families that no controller asks are made of others, answered under a limit of work, written with
their answers, and treated alike. The counts go to results/published/decision-round-trip.md.
"""

from __future__ import annotations

import argparse
import math
import sys
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import rmfs
from rmfs import layout as layouts
from rmfs import scenario as scenarios
from rmfs.experiments.papers.decision_library import publish_table
from rmfs.experiments.papers.study import PUBLISHED, command
from rmfs.scenario import sku_set
from rmfs.solvers.decisions.asking import asked_again
from rmfs.solvers.decisions.checking import check
from rmfs.solvers.decisions.files import Decision, read, write
from rmfs.solvers.decisions.library.derived import derived
from rmfs.solvers.decisions.models import plain_data
from rmfs.solvers.decisions.recording import DecisionRecorder
from rmfs.solvers.decisions.solving import solve
from rmfs.solvers.run_bound import run_bound
from rmfs.traffic import Traffic

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

SETS = {
    "pile-on": "pile_on",
    "pile-on-split": "pile_on",
    "pile-on-dispatch": "pile_on",
    "m1g": "pile_on",
    "hadgs": "pile_on",
    "planning": "planning",
    "psa-placement": "placement",
    "psa-prices": "zones",
    "psa-stays": "stays",
    "ta-matching": "matching",
    "ta-balance": "balance",
    "ta-routes": "sequence",
    "stocking": "replenishment",
    "ca-schedule": "charging",
}
"""A shipped set of controllers, and the family that it asks."""

DERIVED = {
    "sequencing": ("beam", 20.0),
    "rack_allocation": ("cp_sat", 0.05),
    "run_bound": ("highs", None),
}
"""Families that nobody asks: method and limit of work of their answers."""

SMALLER: dict[str, Any] = {
    "layout.robots": 6,
    "layout.pick_stations.east": 2,
    "layout.replenishment_stations.west": 2,
    "layout.horizontal_aisles": 4,
    "scenario.warmup_s": 0,
    "scenario.skus.count": 200,
    "scenario.replenishment.resume_below_share": 0.8,
    "scenario.replenishment.pause_above_share": 0.9,
}
"""Half of the default floor."""

MORE: dict[str, dict[str, Any]] = {
    "psa-prices": {"controllers.psa.period_s": 30.0},
    "stocking": {"controllers.rps.work_s": 0.003, "controllers.rps.bundles": 10},
    "ca-schedule": {
        "layout.other_stations.charger": {"kind": "charger", "north": 2},
        "scenario.energy.battery": {"capacity_wh": 60, "initial_least_share": 0.4},
        "controllers.ca.period_s": 10,
    },
}
"""What is changed so that a set asks often, and small questions."""

RUN_S, MOST_SEEDS = 600.0, 300


@dataclass
class Count:
    """What became of the questions of one set.

    Attributes
    ----------
    controllers, family
        Who asked what.
    runs, questions
        How many.
    same
        Questions whose answer came again.
    wrong
        Those of which it did not.
    """

    controllers: str
    family: str
    runs: int = 0
    questions: int = 0
    same: int = 0
    wrong: tuple[str, ...] = ()


def main(arguments: list[str] | None = None) -> None:
    """Count, and publish the table; exit code 1 if an answer is another one."""
    made = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    made.add_argument("--questions", type=int, default=500, help="of each set")
    made.add_argument("--only", action="append", help="sets of controllers, or derived families")
    made.add_argument("--published", type=Path, default=PUBLISHED, help="folder of the table")
    given = made.parse_args(arguments)
    counts = []
    for name in given.only or [*SETS, *DERIVED]:
        count = (asked if name in SETS else unasked)(name, given.questions)
        print(
            f"{name}: {count.same} of {count.questions} came again, {count.runs} runs", flush=True
        )
        counts.append(count)
    publish_table(given.published / "decision-round-trip.md", table(counts))
    wrong = [one for count in counts for one in count.wrong]
    if wrong:
        sys.exit(f"{len(wrong)} answers are others: {', '.join(wrong[:10])}")


def table(counts: list[Count]) -> list[dict[str, Any]]:
    """Return a row per set."""
    return [
        {
            "family": count.family,
            "controllers": count.controllers,
            "runs": count.runs,
            "questions": count.questions,
            "same answer": count.same,
        }
        for count in counts
    ]


def asked(controllers: str, most: int) -> Count:
    """Record, and answer anew.

    Parameters
    ----------
    controllers
        A key of `SETS`.
    most
        Questions.
    """
    count = Count(controllers, SETS[controllers])
    for seed in range(MOST_SEEDS):
        with tempfile.TemporaryDirectory() as folder:
            count.runs += 1
            for question in recorded(controllers, RUN_S, Path(folder), seed):
                if question.family == count.family and question.recorded is not None:
                    compare(count, question, asked_again)
                if count.questions >= most:
                    return count
    return count


def recorded(
    controllers: str, duration_s: float, folder: Path, seed: int = 0, **more: Any
) -> list[Decision]:
    """Simulate, and read what was written."""
    given = SMALLER | MORE.get(controllers, {}) | {"scenario.duration_s": duration_s}
    keeper = DecisionRecorder(folder, {"controllers": controllers, "seed": seed})
    rmfs.simulate(controllers=controllers, seed=seed, set=given, observers=[keeper], **more)
    found = [read(path) for path in sorted(folder.glob("*.json.gz"))]
    assert keeper.written == len(found) > 0
    return found


def unasked(family: str, most: int) -> Count:
    """Make questions of a family that nobody asks, and answer each twice.

    Parameters
    ----------
    family
        A key of `DERIVED`.
    most
        Questions.
    """
    method, work = DERIVED[family]
    count = Count("none", family)

    def again(question: Decision) -> Any:
        return solve(question, method, work=work)

    for seed in range(MOST_SEEDS):
        with tempfile.TemporaryDirectory() as folder:
            count.runs += 1
            for question in _made(family, Path(folder) / "asked", seed, most):
                kept = replace(question, recorded=again(question))
                write(kept, Path(folder) / "made")
                path = Path(folder) / "made" / f"{kept.name}.json.gz"
                compare(count, read(path), again)
                if count.questions >= most:
                    return count
    return count


def _made(family: str, folder: Path, seed: int, most: int) -> Iterator[Decision]:
    if family == "run_bound":
        layout = layouts.load("small")
        skus = sku_set(scenarios.load("small").skus)
        traffic = Traffic(layout)
        for number in range(most):
            data = run_bound(layout, skus, traffic, 60.0 * (number + 1))
            yield Decision(family, plain_data(family, data), {"layout": "small"})
        return
    seen = set()
    asked = recorded("pile-on", RUN_S, folder, seed)
    for question in derived(family, "small", (one for one in asked if one.family == "pile_on")):
        if question.hash not in seen and _is_question(question):
            seen.add(question.hash)
            yield question


def _is_question(question: Decision) -> bool:
    """Whether anything is to be decided: pile-on may be asked when no order can be served."""
    sizes = question.sizes
    slots = int(question.data["slots"].sum()) if question.family == "rack_allocation" else 1
    return sizes["O"] >= slots


def compare(count: Count, question: Decision, answer: Callable[[Decision], Any]) -> None:
    """Answer a question, count it, and say whether the answer is the recorded one."""
    kept, again = question.recorded, answer(question)
    assert kept is not None
    count.questions += 1
    same = (
        (kept.values is None) == (again.values is None)
        and _equal(kept.objective, again.objective)
        and _equal(kept.bound, again.bound)
        and kept.by["work"] == again.by["work"]
    )
    if same and kept.values is not None:
        same = all(_same(again.values[name], value) for name, value in kept.values.items())
        check(question, kept)
    count.same += same
    if not same:
        count.wrong = (*count.wrong, question.name)


def _equal(one: float, other: float) -> bool:
    """Whether two numbers are the same; those that say nothing are written as none."""
    return one == other or not (math.isfinite(one) or math.isfinite(other))


def _same(one: Any, other: Any) -> bool:
    return bool(np.all(one == other)) if isinstance(one, np.ndarray) else bool(one == other)


if __name__ == "__main__":
    sys.exit(command(main))
