"""Determines which runs are needed, given the results so far.

The answer depends only on the design and on reproducible results, never on the order in which the
results arrive: an interrupted experiment needs the same runs as an uninterrupted one.
"""

from __future__ import annotations

from dataclasses import dataclass
from statistics import mean
from typing import TYPE_CHECKING

import pandas as pd

from rmfs.experiments.statistics.selection import kim_nelson
from rmfs.experiments.statistics.sequential import narrow_enough

if TYPE_CHECKING:
    from collections.abc import Collection

    from rmfs.experiments.design.file import Best, Select, Stage, Until
    from rmfs.experiments.design.planning import Plan


@dataclass(frozen=True)
class Wanted:
    """A run that the design requires.

    Attributes
    ----------
    arm
        Name of the arm.
    replication
        With common random numbers, the seed of the run. Without them, the seed is derived from this
        number and the arm's digest (see `Plan.seed`).
    """

    stage: str
    arm: str
    replication: int


@dataclass(frozen=True)
class Schedule:
    """The runs that a design requires, given the results so far.

    Attributes
    ----------
    runs
        The runs without duplicates, in the order in which they should be made.
    complete
        Whether no further runs will be added.
    remarks
        Decisions of the stages based on the results, one line each: for example, which arms take
        part in the next stage.
    """

    runs: list[Wanted]
    complete: bool
    remarks: list[str]


def columns(plan: Plan) -> list[str]:
    """Return the footprint columns on which the stages base their decisions."""
    named: dict[str, None] = {}
    for stage in plan.design.stages:
        for rule in (stage.until, stage.select):
            if rule is not None:
                named[rule.column] = None
        if stage.arms is not None:
            named[stage.arms.by] = None
    return list(named)


def schedule(
    plan: Plan, results: pd.DataFrame, failed: Collection[tuple[str, int]] = ()
) -> Schedule:
    """Return the runs that a design requires, given the results so far.

    Parameters
    ----------
    results
        Finished runs, with the columns `arm`, `replication` and all that `columns` returns.
    failed
        Failed runs, as pairs of arm and replication; no results are expected from them.
    """
    known = _Known(results, frozenset(failed))
    runs: dict[tuple[str, int], Wanted] = {}
    remarks: list[str] = []
    present = [arm.name for arm in plan.arms]
    before: list[int] = []
    for stage in plan.design.all_stages():
        if stage.arms is not None:
            present = _best(stage.arms, stage.name, present, before, known, remarks)
            remarks.append(f"stage {stage.name}: {len(present)} arms go on: {' | '.join(present)}")
        before = plan.design.seeds_of(stage)
        wanted, over = _of_stage(stage, present, before, known, remarks)
        for arm, replication in wanted:
            runs.setdefault((arm, replication), Wanted(stage.name, arm, replication))
        if not over:
            return Schedule(list(runs.values()), False, remarks)
    return Schedule(list(runs.values()), True, remarks)


class _Known:
    """Results by arm and replication."""

    def __init__(self, results: pd.DataFrame, failed: frozenset[tuple[str, int]]) -> None:
        self.failed = failed
        keys = zip(results["arm"], results["replication"].astype(int), strict=True)
        self.row = {key: number for number, key in enumerate(keys)}
        self.results = results

    def settled(self, arm: str, replications: list[int]) -> bool:
        """Whether all these runs are finished or have failed."""
        return all((arm, r) in self.row or (arm, r) in self.failed for r in replications)

    def values(self, arm: str, replications: list[int], column: str) -> list[float]:
        """Return the values of a column in the finished runs; empty cells are left out."""
        rows = [self.row[arm, r] for r in replications if (arm, r) in self.row]
        return [float(value) for value in self.results[column].iloc[rows].dropna()]

    def without_value(self, arm: str, replication: int, column: str) -> bool:
        """Whether this run has ended or failed without a value in the column."""
        settled = self.settled(arm, [replication])
        return settled and not self.values(arm, [replication], column)


def _of_stage(
    stage: Stage, arms: list[str], seeds: list[int], known: _Known, remarks: list[str]
) -> tuple[list[tuple[str, int]], bool]:
    """Return the runs that a stage requires so far, and whether the stage is complete."""
    # seed by seed: whatever is finished so far can be compared
    wanted = [(arm, seed) for seed in seeds for arm in arms]
    if not all(known.settled(arm, seeds) for arm in arms):
        return wanted, False
    if stage.until is not None:
        return _until(stage.until, stage.name, arms, seeds, known, remarks)
    if stage.select is not None:
        return _select(stage.select, stage.name, arms, seeds, known, remarks)
    return wanted, True


def _until(
    rule: Until, name: str, arms: list[str], seeds: list[int], known: _Known, remarks: list[str]
) -> tuple[list[tuple[str, int]], bool]:
    """Give every arm seeds until its interval is narrow enough."""
    wanted = [(arm, seed) for seed in seeds for arm in arms]
    over = True
    for arm in arms:
        used = list(seeds)
        while len(used) < rule.max_seeds and known.settled(arm, used):
            values = known.values(arm, used, rule.column)
            if len(values) < len(used) or narrow_enough(
                values, rule.relative_half_width, rule.confidence
            ):
                break
            count = min(rule.step, rule.max_seeds - len(used))
            used += range(max(used) + 1, max(used) + 1 + count)
        wanted += [(arm, seed) for seed in used[len(seeds) :]]
        if not known.settled(arm, used):
            over = False
        else:
            remarks.append(f"stage {name}: {arm}: {len(used)} seeds")
    return wanted, over


def _select(
    rule: Select, name: str, arms: list[str], seeds: list[int], known: _Known, remarks: list[str]
) -> tuple[list[tuple[str, int]], bool]:
    """Give further seeds to all arms that may still be the best, until one is left."""
    sound = [arm for arm in arms if len(known.values(arm, seeds, rule.column)) == len(seeds)]
    if not sound:
        remarks.append(f"stage {name}: nothing to select from, as all arms have failed runs")
        return [(arm, seed) for seed in seeds for arm in arms], True
    more = range(max(seeds) + 1, max(seeds) + 1 + rule.max_seeds - len(seeds))
    samples: dict[str, list[float]] = {}
    wanted = [(arm, seed) for seed in seeds for arm in arms]
    for arm in sound:
        samples[arm] = known.values(arm, seeds, rule.column)
        for seed in more:
            value = known.values(arm, [seed], rule.column)
            if not value:
                break
            samples[arm] += value
    found = kim_nelson(
        samples,
        first=len(seeds),
        indifference=rule.indifference,
        error=rule.error,
        goal=rule.better(),
        most=rule.max_seeds,
    )
    for arm in sound:
        wanted += [(arm, seed) for seed in more[: found.used[arm] - len(seeds)]]
    if not found.over:
        seed = [*seeds, *more][found.observations]
        wanted += [(arm, seed) for arm in found.left]
        if not any(known.without_value(arm, seed, rule.column) for arm in found.left):
            return wanted, False
        remarks.append(f"stage {name}: stopped, as runs of arms that may be the best failed")
        return wanted, True
    remarks.append(f"stage {name}: {found.verdict()}")
    return wanted, True


def _best(
    rule: Best, name: str, arms: list[str], seeds: list[int], known: _Known, remarks: list[str]
) -> list[str]:
    """Return the arms with the best means over the previous stage's seeds, in design order.

    All means cover the same seeds: an arm that lacks a value for one of them is left out.
    """
    values = {arm: known.values(arm, seeds, rule.by) for arm in arms}
    if lacking := [arm for arm in arms if len(values[arm]) < len(seeds)]:
        told = f"stage {name}: left out, as not all runs have a value of {rule.by}"
        remarks.append(f"{told}: {' | '.join(lacking)}")
    means = pd.Series({arm: mean(values[arm]) for arm in arms if arm not in lacking}, dtype=float)
    order = means.sort_values(ascending=rule.better() == "min", kind="stable")
    chosen = set(order.index[: rule.best])
    return [arm for arm in arms if arm in chosen]
