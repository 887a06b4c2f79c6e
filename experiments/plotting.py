"""Whole pictures from results: which figure goes where."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.errors import InputError
from rmfs.experiments.figures import effects, intervals, pareto, progression
from rmfs.experiments.figures.style import COLOURS, axis_label, saving
from rmfs.experiments.results import load

if TYPE_CHECKING:
    from pathlib import Path

    import pandas as pd

    from rmfs.experiments.design.planning import Plan

KINDS = {
    "intervals": ("units_per_h",),
    "effects": ("units_per_h",),
    "pareto": ("robots", "units_per_h"),
    "progression": ("orders_completed", "distance_m"),
}
"""Kinds of pictures, and the columns each shows by default."""

MOST_COLUMNS = 4


def draw(
    kind: str,
    plan: Plan,
    frame: pd.DataFrame,
    folder: Path,
    columns: list[str],
    path: Path,
    *,
    confidence: float = 0.95,
) -> None:
    """Draw a picture.

    Parameters
    ----------
    kind
        One of `KINDS`.
    frame
        Results, as `experiments.load` returns them.
    folder
        Where they are stored, for the time series.
    columns
        What is shown.
    path
        The .png, .pdf or .svg file to write.

    Raises
    ------
    InputError
        If the picture cannot be drawn of these results.
    """
    if len(columns) > MOST_COLUMNS:
        raise InputError(f"a picture shows at most {MOST_COLUMNS} columns")
    match kind:
        case "intervals":
            _intervals(frame, columns, path, confidence)
        case "effects":
            _effects(plan, frame, columns, path, confidence)
        case "pareto":
            _pareto(frame, columns, path, confidence)
        case "progression":
            _progression(folder, columns, path, confidence)


def _intervals(frame: pd.DataFrame, columns: list[str], path: Path, confidence: float) -> None:
    rows = frame["arm"].nunique()
    with saving(path, 3.5 + 3.5 * len(columns), 1.2 + 0.28 * rows) as figure:
        axes = figure.subplots(1, len(columns), sharey=True, squeeze=False)[0]
        for column, ax in zip(columns, axes, strict=True):
            intervals(frame, column, ax, confidence=confidence)


def _effects(
    plan: Plan, frame: pd.DataFrame, columns: list[str], path: Path, confidence: float
) -> None:
    factors = [f for f in plan.factors if len(frame[f].unique()) > 1]
    if not factors:
        raise InputError("effects: no factor has more than one level")
    names = [plan.short_names[factor] for factor in factors]
    with saving(path, 1.0 + 1.6 * len(factors), 0.6 + 2.8 * len(columns)) as figure:
        grid = figure.subplots(len(columns), len(factors), sharey="row", squeeze=False)
        for column, axes in zip(columns, grid, strict=True):
            effects(frame, column, factors, list(axes), names=names, confidence=confidence)


def _pareto(frame: pd.DataFrame, columns: list[str], path: Path, confidence: float) -> None:
    if len(columns) != 2:
        raise InputError("pareto: needs two columns, the one to be small first")
    with saving(path) as figure:
        pareto(frame, columns[0], columns[1], figure.subplots(), confidence=confidence)


def _progression(folder: Path, columns: list[str], path: Path, confidence: float) -> None:
    series = load(folder, table="series")
    end_s = float(series["time_s"].max())
    with saving(path, 7.0, 0.6 + 2.4 * len(columns)) as figure:
        axes = figure.subplots(len(columns), 1, sharex=True, squeeze=False)[:, 0]
        for number, (column, ax) in enumerate(zip(columns, axes, strict=True)):
            progression(series, column, ax, bin_s=bin_of(end_s), confidence=confidence)
            ax.set_ylabel(axis_label(column, "series", per="hour"))
            ax.label_outer()
            if number == 0 and series["arm"].nunique() <= 2 * len(COLOURS):
                ax.legend(fontsize=8)


def bin_of(end_s: float) -> float:
    """Return a bin width for runs of this length: about 24 bins, of whole minutes up to an hour."""
    for width in (60.0, 120.0, 300.0, 600.0, 1200.0, 1800.0):
        if end_s / width <= 24:
            return width
    return 3600.0
