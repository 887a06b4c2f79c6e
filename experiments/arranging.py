"""Rearranging tables of results: one column per factor, or one column per level of a factor."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pandas as pd

from rmfs.errors import InputError
from rmfs.experiments.tables import columns_of

if TYPE_CHECKING:
    from rmfs.experiments.design.planning import Plan
    from rmfs.experiments.tables import Table

COUNTS = ("seeds", "pairs")
"""Columns that count runs."""


def by_factors(table: Table, plan: Plan) -> Table:
    """Replace the name of each arm in a table by one column per factor.

    Raises
    ------
    InputError
        If the factors do not distinguish the arms.
    """
    levels = _levels(table, plan)
    frame = table.frame.copy()
    frame.index = pd.MultiIndex.from_frame(levels)
    return replace(table, frame=frame)


def across(table: Table, plan: Plan, factor: str) -> Table:
    """Arrange the levels of a factor as columns, and combinations of the other factors as rows.

    Parameters
    ----------
    factor
        Key or short name of the factor.

    Raises
    ------
    InputError
        If the factor does not exist or has only one level in the table, if no other factor has
        several levels, or if the factors do not distinguish the arms.
    """
    levels = _levels(table, plan)
    name = plan.short_names.get(factor, factor)
    if name not in levels or levels.shape[1] < 2:
        valid = ", ".join(map(str, levels.columns)) if levels.shape[1] > 1 else "needs two factors"
        raise InputError(f"--across {factor}: not one of several factors; valid: {valid}")
    rows = pd.MultiIndex.from_frame(levels.drop(columns=name))
    order = rows.drop_duplicates()
    parts: dict[tuple[str, str], pd.Series] = {}
    decimals = {}
    for level in levels[name].unique():
        chosen = (levels[name] == level).to_numpy()
        part = table.frame[chosen].set_axis(rows[chosen], axis=0).reindex(order)
        for measure, statistic in columns_of(table.frame):
            if measure not in COUNTS:
                label = f"{measure}, {name}={level}"
                parts[label, statistic] = part[measure, statistic]
                decimals[label, statistic] = table.decimals.get((measure, statistic), 0)
    made = pd.DataFrame(parts)
    made.columns = pd.MultiIndex.from_tuples(list(parts))
    if made.index.nlevels == 1:
        made.index = made.index.get_level_values(0)
    counts = [table.frame[pair] for pair in columns_of(table.frame) if pair[0] in COUNTS]
    return replace(table, frame=made, decimals=decimals, caption=f"{table.caption}{_told(counts)}")


def _levels(table: Table, plan: Plan) -> pd.DataFrame:
    """Return the factors with several levels in a table: the level as text, one row per arm."""
    short = plan.short_names
    rows = [
        {short[factor]: _text(level) for factor, level in plan.arm(str(arm)).levels.items()}
        for arm in table.frame.index
    ]
    made = pd.DataFrame(rows, index=table.frame.index)
    made = made[[column for column in made if len(made[column].unique()) > 1]]
    if made.empty or made.duplicated().any():
        raise InputError("the factors of this design do not distinguish its arms")
    return made


def _text(level: object) -> str:
    return "none" if level is None else str(level)


def _told(counts: list[pd.Series]) -> str:
    """Return a sentence on the number of seeds per cell; empty if it is unknown."""
    if not counts:
        return ""
    least, most = int(counts[0].min()), int(counts[0].max())
    if most == 0:  # differences of arms with independent seeds have no pairs
        return ""
    return f" {least} seeds per cell." if least == most else f" {least} to {most} seeds per cell."
