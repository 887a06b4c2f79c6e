"""Comparison of runs, arms or tables: differences in their inputs and outputs."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from rmfs.errors import InputError
from rmfs.experiments.complete import lacking
from rmfs.experiments.design import planning as plans
from rmfs.experiments.results import assigned
from rmfs.experiments.statistics.paired import paired, unpaired
from rmfs.experiments.store import Store
from rmfs.measure.dictionary import FOOTPRINT, learnt, names, reproducible
from rmfs.measure.folder import PARAMETERS, load_run

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

ARM_SIGN = "#"
"""Character that separates a folder from the name of one of its arms."""


def numbers() -> list[str]:
    """Return the numerical columns of the footprint, including those of registered measures."""
    columns = (*FOOTPRINT, *learnt())
    return [column.name for column in columns if column.is_number and column.name != "seed"]


OUTPUTS = ("baseline", "other", "pairs", "difference", "low", "high", "relative", "p")
"""Columns that `Comparison.outputs_of` returns."""

NOT_INPUT = ("written", "machine", "check")
"""Keys of run.json that do not describe what was simulated."""


@dataclass(frozen=True)
class Side:
    """A run, an arm or a table that is compared.

    Attributes
    ----------
    name
        Path of the run, experiment or table; for an arm, followed by `#` and the name of the arm.
    rows
        Footprints, one row per seed.
    inputs
        Known inputs: dotted keys and their values.
    note
        Description of missing runs of the experiment; empty if none are missing, or if the side
        does not belong to an experiment.
    """

    name: str
    rows: pd.DataFrame
    inputs: Mapping[str, Any] = field(default_factory=dict)
    note: str = ""

    @cached_property
    def by_seed(self) -> pd.DataFrame:
        """The numerical columns of the footprint, indexed by seed.

        Raises
        ------
        InputError
            If there is no column seed, or a seed occurs more than once.
        """
        # not the replication: without common random numbers, each arm has other seeds
        if "seed" not in self.rows:
            raise InputError(f"{self.name}: has no column seed")
        rows = self.rows.set_index("seed")
        if not rows.index.is_unique:
            seed = rows.index[rows.index.duplicated()][0]
            raise InputError(
                f"{self.name}: has several rows with seed {seed}; the rows of an arm need a seed "
                "each, and a table with several arms needs the column arm"
            )
        present = [column for column in numbers() if column in rows]
        return rows[present].astype("Float64").astype(float)


@dataclass(frozen=True)
class Comparison:
    """Comparison of two sides: `other` with `baseline`.

    Attributes
    ----------
    inputs
        Inputs that differ, with the columns `key`, `baseline` and `other`.
    by_seed
        Numerical columns of the baseline and of the other side, indexed by seed: of the common
        seeds or, if there are none, of all.
    pairs
        Number of common seeds; if it is 0, the two samples are treated as independent.
    identical
        Whether both sides have the same seeds and equal values in all reproducible columns.
    confidence
        Confidence level of the intervals.
    """

    baseline: Side
    other: Side
    inputs: pd.DataFrame
    by_seed: tuple[pd.DataFrame, pd.DataFrame]
    pairs: int
    identical: bool
    confidence: float

    @cached_property
    def columns(self) -> list[str]:
        """Numerical columns of the footprint that both sides have and one has a value in."""
        a, b = self.by_seed
        known = set(a.columns[a.notna().any()]) | set(b.columns[b.notna().any()])
        return [c for c in numbers() if c in a and c in b and c in known]

    @cached_property
    def outputs(self) -> pd.DataFrame:
        """One row for each of `columns`, as `outputs_of` returns them."""
        return self.outputs_of(self.columns)

    def outputs_of(self, columns: Sequence[str]) -> pd.DataFrame:
        """Compare both sides in some columns of the footprint.

        Returns
        -------
        One row per column. `baseline` and `other` are means over the common seeds with a value on
        both sides or, if there are none, over all values of each side; `pairs` is the number of
        these common seeds. `difference` is `other` minus `baseline`; `low` and `high` are the ends
        of its confidence interval, and `p` is its p value. `relative` is the difference divided by
        `baseline`. The interval and `p` are nan if there are too few seeds: only one common seed,
        or no common seed and a side with a single seed.
        """
        a, b = self.by_seed
        tested = paired if self.pairs else unpaired
        rows: dict[str, dict[str, float]] = {}
        for column in columns:
            told = tested(b[column], a[column], confidence=self.confidence)
            # a pair for the paired difference, so that it is the difference of the means
            both = a.index[a[column].notna() & b[column].notna()] if told["pairs"] else slice(None)
            means = {"baseline": a[column][both].mean(), "other": b[column][both].mean()}
            rows[column] = {**means, **told}
        index = pd.Index(rows, name="column")
        return pd.DataFrame(list(rows.values()), index=index, columns=pd.Index(OUTPUTS))

    @property
    def notes(self) -> list[str]:
        """Descriptions of the missing runs of both sides, without duplicates."""
        return list(dict.fromkeys(one.note for one in (self.baseline, self.other) if one.note))


def compare(sources: Sequence[str | Path], *, confidence: float = 0.95) -> list[Comparison]:
    """Compare all sources with the first source, or all arms of a single source with its first arm.

    Parameters
    ----------
    sources
        Run folders, folders of experiments, .csv or .parquet tables of footprints, or single arms
        of experiments or tables (`PATH#ARM`). If there is a single source, each of its other arms
        is compared with its first arm. If there are several sources and any of them has several
        arms, arms of the same name are compared.

    Raises
    ------
    InputError
        If a source cannot be read, or there is nothing to compare.
    """
    read = [_sides(str(source)) for source in sources]
    if len(read) == 1:
        first, *others = read[0]
        pairs = [(first, other) for other in others]
    elif all(len(sides) == 1 for sides in read):
        pairs = [(read[0][0], sides[0]) for sides in read[1:]]
    else:
        pairs = _same_arms(read)
    if not pairs:
        raise InputError(f"nothing to compare: {_why_nothing(read)}")
    return [_compared(first, other, confidence) for first, other in pairs]


def _same_arms(read: list[list[Side]]) -> list[tuple[Side, Side]]:
    known = [{_arm_of(side): side for side in sides} for sides in read]
    first = known[0]
    return [(first[arm], others[arm]) for arm in first for others in known[1:] if arm in others]


def _why_nothing(read: list[list[Side]]) -> str:
    if len(read) == 1:
        return "give two runs, arms or tables"
    several = next(sides for sides in read if len(sides) > 1)
    names = ", ".join(side.name for side in several)
    return f"no arms have the same name; to compare one arm, write it as one of: {names}"


def _arm_of(side: Side) -> str:
    return side.name.partition(ARM_SIGN)[2]


def _compared(first: Side, other: Side, confidence: float) -> Comparison:
    a, b = first.by_seed, other.by_seed
    common = a.index.intersection(b.index)
    if len(common):
        a, b = a.loc[common], b.loc[common]
    shared = [c for c in _repeating() if c in first.rows and c in other.rows]
    same = len(first.rows) == len(other.rows) and _text(first, shared) == _text(other, shared)
    inputs = _input_differences(first, other)
    return Comparison(first, other, inputs, (a, b), len(common), same, confidence)


def _repeating() -> list[str]:
    """Return the reproducible columns of the footprint, with those of registered measures."""
    return [*reproducible("footprint"), *(c.name for c in learnt() if not c.measured)]


def _text(side: Side, columns: list[str]) -> str:
    """Return columns as CSV, without the names of inputs, which are not results."""
    chosen = [c for c in columns if c not in ("layout", "scenario", "controllers")]
    return side.rows.sort_values("seed")[chosen].to_csv(index=False)


def _input_differences(first: Side, other: Side) -> pd.DataFrame:
    keys = [*first.inputs, *(key for key in other.inputs if key not in first.inputs)]
    rows = [
        (key, first.inputs.get(key, "-"), other.inputs.get(key, "-"))
        for key in keys
        if _differs(first.inputs.get(key), other.inputs.get(key))
    ]
    return pd.DataFrame(rows, columns=pd.Index(["key", "baseline", "other"]))


def _differs(first: Any, second: Any) -> bool:
    both_numbers = all(isinstance(v, int | float) for v in (first, second))
    return bool(first != second) if both_numbers else json.dumps(first) != json.dumps(second)


def _sides(source: str) -> list[Side]:
    """Read a source and return one side for each of its arms."""
    place, _, arm = source.partition(ARM_SIGN)
    path = Path(place)
    if (path / PARAMETERS).is_file():
        if arm:
            raise InputError(f"{source}: {place} is a run, which has no arms")
        return [_run_side(path)]
    if (path / plans.FILE).is_file():
        return _experiment_sides(path, arm, source)
    if path.is_file() and path.suffix.lower() in (".csv", ".parquet"):
        return _table_sides(path, arm)
    raise InputError(
        f"{source}: neither a run folder, nor an experiment, nor a .csv or .parquet table"
    )


def _run_side(path: Path) -> Side:
    run = load_run(path)
    told = {key: value for key, value in run.parameters.items() if key not in NOT_INPUT}
    return Side(str(path), run.table("footprint"), dict(_flat(told)))


def _experiment_sides(path: Path, arm: str, source: str) -> list[Side]:
    plan = plans.load(path)
    chosen = [plan.arm(arm)] if arm else plan.arms
    store = Store(path)
    frame = assigned(plan, store)
    missing = lacking(plan, store, {one.name for one in chosen}, rows=frame)
    note = f"{source}: {missing}" if missing else ""
    return [
        Side(
            f"{path}{ARM_SIGN}{one.name}",
            frame[frame["arm"] == one.name],
            {
                **one.inputs,
                **{".".join(keys): value for keys, value in one.overrides},
                "pacing": one.pacing,
                "digest": one.digest[:12],
            },
            note,
        )
        for one in chosen
        if (frame["arm"] == one.name).any()
    ]


def _table_sides(path: Path, arm: str) -> list[Side]:
    try:
        frame = _read_csv(path) if path.suffix.lower() == ".csv" else pd.read_parquet(path)
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read ({error})") from None
    if not set(frame.columns) & set(numbers()):
        raise InputError(f"{path}: has no column of a footprint")
    if "arm" not in frame:
        return [Side(str(path), frame, _constant(frame))]
    groups = {str(name): group for name, group in frame.groupby("arm", sort=False)}
    if arm and arm not in groups:
        raise InputError(f"{path}: has no arm {arm}; arms: {', '.join(groups)}")
    return [
        Side(f"{path}{ARM_SIGN}{name}", group, _constant(group))
        for name, group in groups.items()
        if not arm or name == arm
    ]


def _read_csv(path: Path) -> pd.DataFrame:
    """Read a table; the name of an arm is text, even if it is a word such as None or NA."""
    frame = pd.read_csv(path)
    if "arm" in frame:
        frame["arm"] = pd.read_csv(path, usecols=["arm"], dtype=str, keep_default_na=False)["arm"]
    return frame


def _constant(frame: pd.DataFrame) -> dict[str, Any]:
    """Return the inputs and factors that have the same value in all rows."""
    inputs = ("layout", "scenario", "controllers", "warmup_s", "duration_s", "robots", "pods")
    columns = [c for c in frame if c in inputs or "." in str(c)]
    return {str(c): _plain(frame[c].iloc[0]) for c in columns if len(frame[c].unique()) == 1}


def _plain(value: Any) -> Any:
    if pd.isna(value):
        return None
    return value.item() if isinstance(value, np.generic) else value


def _flat(value: Any, before: str = "") -> list[tuple[str, Any]]:
    """Return the values of nested tables with their dotted keys."""
    if not isinstance(value, dict):
        return [(before, value)]
    found = []
    for key, item in value.items():
        found += _flat(item, f"{before}.{key}" if before else str(key))
    return found


MAIN = (
    "orders_completed",
    "units_picked",
    "units_per_h",
    "orders_per_h",
    "bundles_per_h",
    "units_score",
    "units_per_visit",
    "distance_m",
    "distance_per_unit_m",
    "pick_station_idle_share",
    "robot_queueing_share",
    "order_turnover_median_s",
    "late_share",
)
"""Outputs shown by default."""


def chosen_columns(
    comparison: Comparison, columns: Sequence[str], *, everything: bool
) -> list[str]:
    """Return the columns to show.

    These are the requested `columns`. If none are requested, they are the main columns (`MAIN`) or,
    with `everything`, all reproducible columns whose means differ.

    Raises
    ------
    InputError
        If a requested column does not exist.
    """
    there = comparison.columns
    wrong = [column for column in columns if column not in there]
    if wrong:
        valid = ", ".join(c for c in (*names("footprint"), *numbers()) if c in there)
        raise InputError(f"column {', '.join(wrong)}: not in both sides; valid: {valid}")
    if columns:
        return list(columns)
    if everything:
        # what the clock has measured is no outcome of what was simulated
        outcomes = {*_repeating()}
        differ = comparison.outputs["difference"] != 0
        return [c for c in there if c in outcomes and differ[c]]
    return [c for c in MAIN if c in there]
