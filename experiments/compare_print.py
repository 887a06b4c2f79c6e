"""The output of the command `rmfs compare`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.experiments.console import open_console
from rmfs.experiments.wording import p_value

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.experiments.compare import Comparison

ROUNDING = 1e-12
"""Largest difference that counts as rounding error: as a share of the larger of the two values, or
absolute if both are below 1."""

MOST_RELATIVE = 10.0
"""Largest difference, in multiples of the baseline, that is also shown in percent of it."""


def print_comparisons(found: list[Comparison], columns: list[str], *, everything: bool) -> None:
    """Print comparisons: the inputs that differ, and the chosen columns of the outputs."""
    from rmfs.experiments.compare import chosen_columns

    console = open_console()
    for number, one in enumerate(found):
        if number:
            console.print()
        console.print(f"baseline  {one.baseline.name}", markup=False)
        console.print(f"other     {one.other.name}", markup=False)
        if one.identical:
            console.print("identical: all reproducible columns are the same")
        _print_inputs(console, one)
        shown = one.outputs_of(chosen_columns(one, columns, everything=everything))
        console.print(_outputs(shown))
        console.print(_how(one))
        for column, pairs in shown["pairs"].items():
            if pairs < one.pairs:
                console.print(f"{column}: {pairs:.0f} of these seeds have a value on both sides")
        for note in one.notes:
            console.print(f"Note: {note}.", markup=False)


def _print_inputs(console: Any, one: Comparison) -> None:
    from rich import box
    from rich.table import Table

    if one.inputs.empty:
        known = bool(one.baseline.inputs) and bool(one.other.inputs)
        console.print("input: the same" if known else "input: not known")
        return
    shown = Table("input", "baseline", "other", box=box.SIMPLE_HEAD)
    for row in one.inputs.itertuples():
        shown.add_row(str(row.key), str(row.baseline), str(row.other))
    console.print(shown)


def _outputs(outputs: pd.DataFrame) -> Any:
    from rich import box
    from rich.table import Table

    from rmfs.experiments.statistics.paired import holm

    # over what is shown: a hundred columns nobody looks at prove nothing
    corrected = holm(outputs["p"])
    shown = Table("output", box=box.SIMPLE_HEAD)
    heads = ["baseline", "other", "difference", "relative"]
    several = bool(outputs["low"].notna().any())
    if several:
        heads += ["interval", "p (Holm)"]
    for head in heads:
        shown.add_column(head, justify="right")
    for column in outputs.index:
        row: dict[Any, Any] = outputs.loc[column].to_dict()
        p = corrected[column]
        scale = max(abs(row["baseline"]), abs(row["other"]))
        cells = [_number(row[key], scale) for key in ("baseline", "other", "difference")]
        cells.append(_relative(row["difference"], row["baseline"], scale))
        if several:
            cells.append(f"{_number(row['low'], scale)} to {_number(row['high'], scale)}")
            cells.append(p_value(p))
        shown.add_row(column, *cells)
    return shown


def _how(one: Comparison) -> str:
    if one.pairs:
        told = f"paired by {one.pairs} common seed{'s' if one.pairs > 1 else ''}"
        there = len(one.baseline.rows), len(one.other.rows)
        alone = max(there) > one.pairs
        return f"{told}, of {there[0]} and {there[1]}" if alone else told
    counts = f"{len(one.baseline.rows)} and {len(one.other.rows)}"
    return f"no common seed: {counts} runs treated as independent (Welch)"


def _number(value: float, scale: float = 1.0) -> str:
    """Format a number; a rounding error, relative to `scale`, is shown as 0."""
    if value != value:
        return "-"
    size = abs(value)
    if size <= ROUNDING * max(scale, 1.0):
        return "0"
    return f"{value:,.0f}" if size >= 10_000 else f"{value:,.4g}"


def _relative(difference: float, baseline: float, scale: float) -> str:
    """Format a difference in percent of the baseline; "-" if it is unknown or too large."""
    if difference != difference or abs(difference) > MOST_RELATIVE * abs(baseline):
        return "-"
    if abs(difference) <= ROUNDING * max(scale, 1.0):
        return "0%"
    return f"{difference / baseline:+.1%}"
