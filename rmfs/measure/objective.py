"""Objectives for the optimisation of rules and guidance: weighted sums of footprint columns."""

from __future__ import annotations

from math import inf, isfinite
from typing import TYPE_CHECKING, Any

from rmfs.errors import InputError
from rmfs.measure.dictionary import names

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pandas as pd


def check_objective(weights: Mapping[str, float]) -> None:
    """Check that every column of an objective is a column of the footprint.

    Raises
    ------
    InputError
        If there is no such column.
    """
    for column in weights:
        if column not in names("footprint"):
            raise InputError(f"objective {column}: is not a column of the footprint")


def objective_of(footprint: pd.Series[Any], weights: Mapping[str, float]) -> float:
    """Return the weighted sum of columns of a footprint; -inf if a column has no finite value.

    A mean, for example, has no value if nothing happened; such a run must not count as good.

    Parameters
    ----------
    footprint
        Values by column.
    weights
        Weights by column.

    Raises
    ------
    InputError
        If a column contains text.
    """
    values = []
    for column, weight in weights.items():
        if isinstance(footprint[column], str):
            raise InputError(f"objective {column}: is a column of text, not of numbers")
        values.append(float(footprint[column]) * weight)
    return sum(values) if all(map(isfinite, values)) else -inf


def require_objective(value: float, weights: Mapping[str, float], made: str) -> None:
    """Check that an objective had a value before it is optimised.

    Parameters
    ----------
    value
        The objective of a run, or its mean over runs; see `objective_of`.
    weights
        Weights by column.
    made
        How the runs were made; for the message.

    Raises
    ------
    InputError
        If the objective had no value.
    """
    if not isfinite(value):
        raise InputError(
            f"objective {', '.join(weights)}: must have a value in every run {made}; choose "
            "other columns, or longer runs"
        )
