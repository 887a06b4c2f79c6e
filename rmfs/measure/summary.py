"""The few figures of a footprint that are worth a look when a run has ended."""

from __future__ import annotations

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
    ("score (share of what is possible at most)", "units_score", "{:z.1%}"),
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


def summary(footprint: pd.Series) -> Group:
    """Return the main figures as an aligned table; what was not measured shows as -.

    What measures of the user say stands below.
    """
    from rich import box
    from rich.console import Group
    from rich.table import Table

    names = " / ".join(footprint[["layout", "scenario", "controllers"]])
    title = f"{names}, seed {footprint['seed']}"
    table = Table(box=box.SIMPLE_HEAD, show_header=False)
    table.add_column()
    table.add_column(justify="right")
    for label, column, form in FIGURES:
        table.add_row(label, shown(footprint[column], column, form))
    for own in own_columns(footprint):
        table.add_row(*figure(footprint, own))
    return Group(title, table)


def own_columns(footprint: pd.Series) -> list[Column]:
    """Return the columns of a footprint that come from measures of the user."""
    return [column for column in learnt() if column.name in footprint]


def figure(footprint: pd.Series, column: Column) -> tuple[str, str]:
    """Return label and value of a column that is not among the main figures."""
    label = f"{column.name}, {column.unit}" if column.unit else column.name
    form = "{:,.6g}" if column.is_number else "{}"
    return label, shown(footprint[column.name], column.name, form)


def shown(value: Any, column: str, form: str) -> str:
    """Return a figure in its format, - for what was not measured."""
    import pandas as pd

    if pd.isna(value):
        return "-"
    return form.format(value / 1000.0 if column == "distance_m" else value)
