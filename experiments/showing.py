"""Output of `rmfs experiment`: the requested tables, and a note on missing runs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import typer

from rmfs.errors import InputError

if TYPE_CHECKING:
    from pathlib import Path

    import pandas as pd

    from rmfs.experiments.design.planning import Plan
    from rmfs.experiments.figures.pareto import Goal
    from rmfs.experiments.tables import Table

INCOMPLETE = 3
"""Exit code if a table or plot shows an experiment with missing runs."""


def write_table(
    shown: Table, file: Path, made: Plan, frame: pd.DataFrame, columns: list[str]
) -> None:
    """Write a table to a file, with the provenance of its numbers beside it."""
    from rmfs.experiments.provenance import write

    shown.write(file)
    beside = write(
        file,
        frame,
        design=made.design.name,
        design_hash=made.hash,
        columns=columns,
        caption=shown.caption,
    )
    typer.echo(f"{file}: written, with {beside.name}")


def anovas(
    made: Plan,
    frame: pd.DataFrame,
    columns: list[str],
    confidence: float,
    *,
    interactions: bool,
) -> list[Table]:
    """Return an analysis of variance for each column."""
    from rmfs.experiments import tables
    from rmfs.experiments.statistics import anova

    return [
        tables.effects(
            anova(
                frame,
                column,
                made.factors,
                interactions=interactions,
                confidence=confidence,
                names=made.short_names,
            ),
            column,
        )
        for column in columns
    ]


def chosen_table(
    made: Plan,
    frame: pd.DataFrame,
    columns: list[str],
    baseline: str | None,
    confidence: float,
    *,
    bootstrap: bool,
) -> Table:
    """Return a table of means or, if a baseline is given, of differences from the baseline."""
    from rmfs.experiments import tables

    method: Any = "bootstrap" if bootstrap else "t"
    if baseline is not None:
        made.arm(baseline)
        return tables.differences(frame, columns, baseline, confidence=confidence, method=method)
    return tables.means(frame, columns, confidence=confidence, method=method)


def goals(given: list[str]) -> dict[str, Goal]:
    """Parse texts of the form `COLUMN=more` or `COLUMN=less`; return the goal of each column."""
    found: dict[str, Goal] = {}
    for text in given:
        column, _, goal = text.partition("=")
        if goal not in ("more", "less"):
            raise InputError(f"--goal {text}: expected COLUMN=more or COLUMN=less")
        found[column] = "more" if goal == "more" else "less"
    return found


def tell_lacking(note: str, *, allowed: bool) -> None:
    """If there is a note on missing runs, print it and, unless `allowed`, exit with code 3."""
    if note:
        typer.echo(f"rmfs: {note}", err=True)
        if not allowed:
            raise typer.Exit(INCOMPLETE)


def require_columns(frame: pd.DataFrame, columns: list[str]) -> None:
    """Raise an error if a column is missing from the results or is not numeric.

    Raises
    ------
    InputError
        If a column is missing or not numeric.
    """
    from rmfs.experiments.statistics.intervals import require

    require(frame, *columns)
    words = [c for c in columns if not _is_number(frame[c])]
    if words:
        raise InputError(f"column {', '.join(words)}: is not numeric")


def _is_number(values: pd.Series) -> bool:
    from pandas.api.types import is_numeric_dtype

    return bool(is_numeric_dtype(values))
