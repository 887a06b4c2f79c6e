"""Draws complete plots of results with the functions in `figures`."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from rmfs.errors import InputError
from rmfs.experiments.figures import effects, interaction, intervals, pareto, progression
from rmfs.experiments.figures.pareto import goal_of
from rmfs.experiments.figures.style import COLOURS, axis_label, saving
from rmfs.experiments.results import load
from rmfs.experiments.statistics.anova import tell_apart, varying_factors

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    import pandas as pd
    from matplotlib.figure import Figure, SubFigure

    from rmfs.experiments.design.planning import Plan
    from rmfs.experiments.figures.pareto import Goal

KINDS = {
    "intervals": ("units_per_h",),
    "effects": ("units_per_h",),
    "interaction": ("units_per_h",),
    "pareto": ("robots", "units_per_h"),
    "progression": ("orders_completed", "distance_m"),
}
"""Kinds of plots, and the default columns of each."""

MOST_COLUMNS = 4
MOST_PAIRS = 12


@dataclass(frozen=True)
class Wish:
    """Options of a plot.

    Attributes
    ----------
    confidence
        Confidence of the intervals. Default 0.95.
    interactions
        Whether the plot `effects` also shows the interactions of pairs of factors. They are left
        out if the runs cannot separate all of them from other effects. Default: yes.
    factors
        Factors of the plot `interaction`: at least two, each given by its key or short name (see
        `Plan`). Default: all with more than one level.
    goals
        For each column of the plot `pareto`: "more" if larger values are better, otherwise "less".
        Default: as in the data dictionary.
    note
        A line below the plot. Default: none.
    """

    confidence: float = 0.95
    interactions: bool = True
    factors: Sequence[str] = ()
    goals: Mapping[str, Goal] = field(default_factory=dict)
    note: str = ""


def draw(
    kind: str,
    plan: Plan,
    frame: pd.DataFrame,
    folder: Path,
    columns: list[str],
    path: Path | None,
    wish: Wish | None = None,
) -> Figure:
    """Draw one of the `KINDS` of plots from results.

    Parameters
    ----------
    kind
        One of `KINDS`.
    frame
        Results, as `experiments.load` returns them.
    folder
        Folder of the results, from which the plot `progression` reads the time series.
    columns
        Columns to show.
    path
        The .png, .pdf or .svg file to write; None: no file.

    Raises
    ------
    InputError
        If `kind` is not one of `KINDS`, or the plot cannot show these results and columns.
    """
    if kind not in KINDS:
        raise InputError(f"{kind}: no such plot; valid: {', '.join(KINDS)}")
    if len(columns) > MOST_COLUMNS:
        raise InputError(f"a plot shows at most {MOST_COLUMNS} columns")
    wish = wish or Wish()
    match kind:
        case "intervals":
            return _intervals(frame, columns, path, wish)
        case "effects":
            return _effects(plan, frame, columns, path, wish)
        case "interaction":
            return _interaction(plan, frame, columns, path, wish)
        case "pareto":
            return _pareto(frame, columns, path, wish)
    return _progression(folder, columns, path, wish)


def _intervals(frame: pd.DataFrame, columns: list[str], path: Path | None, wish: Wish) -> Figure:
    rows = frame["arm"].nunique()
    with saving(path, 3.5 + 3.5 * len(columns), 1.2 + 0.28 * rows, note=wish.note) as figure:
        axes = figure.subplots(1, len(columns), sharey=True, squeeze=False)[0]
        for column, ax in zip(columns, axes, strict=True):
            intervals(frame, column, ax, confidence=wish.confidence)
    return figure


def _effects(
    plan: Plan, frame: pd.DataFrame, columns: list[str], path: Path | None, wish: Wish
) -> Figure:
    factors = varying_factors(frame, plan.factors)
    if not factors:
        raise InputError("effects: no factor has more than one level")
    names = [plan.short_names[factor] for factor in factors]
    if wish.interactions and tell_apart(frame, factors):
        return _matrix(frame, columns, factors, names, path, wish)
    width, height = 1.0 + 1.6 * len(factors), 0.6 + 2.8 * len(columns)
    with saving(path, width, height, note=wish.note) as figure:
        grid = figure.subplots(len(columns), len(factors), sharey="row", squeeze=False)
        for column, axes in zip(columns, grid, strict=True):
            effects(frame, column, factors, list(axes), names=names, confidence=wish.confidence)
    return figure


def _matrix(
    frame: pd.DataFrame,
    columns: list[str],
    factors: list[str],
    names: list[str],
    path: Path | None,
    wish: Wish,
) -> Figure:
    """Draw main effects on the diagonal, interactions elsewhere (a line per level of the row)."""
    count = len(factors)
    width, height = 2.2 + 1.9 * count, (0.6 + 1.8 * count) * len(columns)
    with saving(path, width, height, note=wish.note) as figure:
        for column, part in _parts(figure, columns):
            grid = part.subplots(count, count, sharex="col", sharey=True, squeeze=False)
            for row, column_of in itertools.product(range(count), repeat=2):
                ax = grid[row, column_of]
                if row == column_of:
                    effects(frame, column, [factors[row]], [ax], confidence=wish.confidence)
                    ax.set_title("")
                else:
                    pair = (factors[column_of], factors[row])
                    interaction(frame, column, *pair, ax, confidence=wish.confidence, legend=False)
                ax.set_xlabel(names[column_of])
                ax.set_ylabel(axis_label(column))
                ax.label_outer()
            for row in range(count):
                other = grid[row, 0 if row else 1]
                grid[row, -1].legend(
                    *other.get_legend_handles_labels(),
                    title=names[row],
                    loc="center left",
                    bbox_to_anchor=(1.0, 0.5),
                    fontsize=7,
                    title_fontsize=7,
                )
    return figure


def _interaction(
    plan: Plan, frame: pd.DataFrame, columns: list[str], path: Path | None, wish: Wish
) -> Figure:
    varying = varying_factors(frame, plan.factors)
    keys = {name: key for key, name in plan.short_names.items()} | {key: key for key in varying}
    unknown = [name for name in wish.factors if keys.get(name) not in varying]
    short = [plan.short_names[factor] for factor in varying]
    if unknown:
        raise InputError(
            f"factor {', '.join(unknown)}: no factor with several levels; valid: {', '.join(short)}"
        )
    chosen = [keys[name] for name in dict.fromkeys(wish.factors)] or varying
    pairs = list(itertools.combinations(chosen, 2))
    if not pairs:
        raise InputError("interaction: needs two factors with more than one level each")
    if len(pairs) > MOST_PAIRS:
        raise InputError(
            f"interaction: {len(pairs)} pairs of factors are too many for one plot; choose "
            f"some with --factor: {', '.join(short)}"
        )
    across = min(3, len(pairs))
    rows = -(-len(pairs) // across)
    width, height = 0.6 + 3.4 * across, 0.4 + 3.0 * rows * len(columns)
    with saving(path, width, height, note=wish.note) as figure:
        for column, part in _parts(figure, columns):
            axes = part.subplots(rows, across, sharey=True, squeeze=False).ravel()
            for ax, pair in zip(axes, pairs, strict=False):
                names = (plan.short_names[pair[0]], plan.short_names[pair[1]])
                interaction(frame, column, *pair, ax, names=names, confidence=wish.confidence)
            for ax in axes[len(pairs) :]:
                ax.set_axis_off()
    return figure


def _parts(figure: Figure, columns: list[str]) -> Iterator[tuple[str, SubFigure]]:
    """Yield a part of a figure for each column, one below another."""
    parts = np.asarray(figure.subfigures(len(columns), 1, squeeze=False)).ravel()
    yield from zip(columns, parts, strict=True)


def _pareto(frame: pd.DataFrame, columns: list[str], path: Path | None, wish: Wish) -> Figure:
    if len(columns) != 2:
        raise InputError("pareto: needs two columns")
    x, y = columns
    goals = {"x_goal": goal_of(x, wish.goals.get(x)), "y_goal": goal_of(y, wish.goals.get(y))}
    with saving(path, note=wish.note) as figure:
        pareto(frame, x, y, figure.subplots(), **goals, confidence=wish.confidence)
    return figure


def _progression(folder: Path, columns: list[str], path: Path | None, wish: Wish) -> Figure:
    series = load(folder, table="series")
    end_s = float(series["time_s"].max())
    with saving(path, 7.0, 0.6 + 2.4 * len(columns), note=wish.note) as figure:
        axes = figure.subplots(len(columns), 1, sharex=True, squeeze=False)[:, 0]
        for number, (column, ax) in enumerate(zip(columns, axes, strict=True)):
            progression(series, column, ax, bin_s=bin_of(end_s), confidence=wish.confidence)
            ax.set_ylabel(axis_label(column, "series", per="hour"))
            ax.label_outer()
            if number == 0 and series["arm"].nunique() <= 2 * len(COLOURS):
                ax.legend(fontsize=8)
    return figure


def bin_of(end_s: float) -> float:
    """Return the width of the time bins, in s, for a plot of runs that end at `end_s`.

    The width is the smallest of several values from one minute to half an hour that gives at most
    24 bins; if there is none, it is one hour.
    """
    for width in (60.0, 120.0, 300.0, 600.0, 1200.0, 1800.0):
        if end_s / width <= 24:
            return width
    return 3600.0
