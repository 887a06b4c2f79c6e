"""Functions shared by several measures: ratios and quartiles."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.measure.columns import LESS, REAL, Column

if TYPE_CHECKING:
    import pandas as pd

NOTHING = float("nan")


def ratio(amount: float, by: float) -> float:
    """Return `amount / by`; nan if `by` is 0."""
    return amount / by if by else NOTHING


def spread_columns(name: str, meaning: str) -> tuple[Column, ...]:
    """Declare columns for the mean, median and quartiles of a time in s.

    Lower values are declared as better.

    Parameters
    ----------
    name
        Beginning of the columns' names.
    meaning
        Name of the time in the descriptions of the columns, such as "the lateness of late orders".
    """
    told = {
        "mean": "Mean of",
        "median": "Median of",
        "lower_quartile": "First quartile of",
        "upper_quartile": "Third quartile of",
    }
    return tuple(
        Column(f"{name}_{key}_s", REAL, "s", f"{what} {meaning}", better=LESS)
        for key, what in told.items()
    )


def spread(name: str, values: pd.Series[float]) -> dict[str, Any]:
    """Return mean, median and quartiles of times by column name; nan if `values` is empty."""
    return {
        f"{name}_mean_s": values.mean(),
        f"{name}_median_s": values.median(),
        f"{name}_lower_quartile_s": values.quantile(0.25),
        f"{name}_upper_quartile_s": values.quantile(0.75),
    }
