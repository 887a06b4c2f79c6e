"""The main figures of a footprint, for a quick look at a finished run."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any

from rmfs.measure.dictionary import learnt

if TYPE_CHECKING:
    import pandas as pd
    from rich.console import Group

    from rmfs.measure.columns import Column

FIGURES: tuple[tuple[str, str, str], ...] = (
    ("orders completed", "orders_completed", "{:,.0f}"),
    ("orders per hour", "orders_per_h", "{:,.1f}"),
    ("units picked", "units_picked", "{:,.0f}"),
    ("units per hour", "units_per_h", "{:,.1f}"),
    ("score (share of the upper bound)", "units_score", "{:z.1%}"),
    ("bundles stored", "bundles_stored", "{:,.0f}"),
    ("units per pod visit", "units_per_visit", "{:.2f}"),
    ("distance per unit, m", "distance_per_unit_m", "{:,.1f}"),
    ("distance, km", "distance_m", "{:,.1f}"),
    ("pick stations idle", "pick_station_idle_share", "{:z.1%}"),
    ("replenishment stations idle", "replenishment_station_idle_share", "{:z.1%}"),
    ("robots busy", "robot_busy_share", "{:z.1%}"),
    ("robots queueing", "robot_queueing_share", "{:z.1%}"),
    ("order turnover, median, s", "order_turnover_median_s", "{:,.0f}"),
    ("orders late", "late_share", "{:z.1%}"),
    ("collisions", "collisions", "{:,.0f}"),
    ("simulated seconds per wall second", "sim_per_wall", "{:,.0f}"),
)
"""Label, column and format of each figure."""

MISSING = "-"
"""Placeholder for what was not measured."""


LINES = 19
"""Maximum number of lines of a summary at a prompt."""


@dataclass(frozen=True)
class Summary:
    """The main figures of a run as plain text, a rich table, or HTML.

    Attributes
    ----------
    title
        Names of the layout, the scenario and the controllers, and the seed.
    rows
        Labels and values; those of users' measures come last.
    """

    title: str
    rows: tuple[tuple[str, str], ...]

    def __str__(self) -> str:
        told = [row for row in self.rows if row[1] != MISSING]
        if len(told) >= LINES:
            told = [*told[: LINES - 2], ("...", f"{len(told) - LINES + 2} more")]
        widest = [max(len(row[column]) for row in told) for column in (0, 1)]
        lines = [f"  {label:{widest[0]}}  {value:>{widest[1]}}" for label, value in told]
        return "\n".join([self.title, *lines])

    __repr__ = __str__

    def __rich__(self) -> Group:
        from rich import box
        from rich.console import Group
        from rich.table import Table

        table = Table(box=box.SIMPLE_HEAD, show_header=False)
        table.add_column()
        table.add_column(justify="right")
        for label, value in self.rows:
            table.add_row(label, value)
        return Group(self.title, table)

    def _repr_html_(self) -> str:
        cell = '<td style="text-align: {}">{}</td>'
        rows = [
            f"<tr>{cell.format('left', escape(label))}{cell.format('right', escape(value))}</tr>"
            for label, value in self.rows
        ]
        return f"<table><caption>{escape(self.title)}</caption>{''.join(rows)}</table>"


def summarised(footprint: pd.Series) -> Summary:
    """Return the main figures and those of users' measures; `-` marks what was not measured."""
    names = " / ".join(footprint[["layout", "scenario", "controllers"]])
    return Summary(
        f"{names}, seed {footprint['seed']}",
        (
            *((label, shown(footprint[column], column, form)) for label, column, form in FIGURES),
            *(figure(footprint, own) for own in own_columns(footprint)),
        ),
    )


def own_columns(footprint: pd.Series) -> list[Column]:
    """Return the columns of a footprint that come from users' measures."""
    return [column for column in learnt() if column.name in footprint]


def figure(footprint: pd.Series, column: Column) -> tuple[str, str]:
    """Return the label and the value, both as text, of a column that a user's measure added."""
    label = f"{column.name}, {column.unit}" if column.unit else column.name
    form = "{:,.6g}" if column.is_number else "{}"
    return label, shown(footprint[column.name], column.name, form)


def shown(value: Any, column: str, form: str) -> str:
    """Return the value of a column as text (`distance_m` in km); `-` if it was not measured."""
    import pandas as pd

    if pd.isna(value):
        return MISSING
    return form.format(value / 1000.0 if column == "distance_m" else value)
