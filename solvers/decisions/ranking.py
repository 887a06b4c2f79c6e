"""Comparison of methods by timed runs: primal gaps and integrals, performance and data profiles.

A *question* is a problem instance for an optimiser. A run solves one question with one method.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from rmfs.solvers.decisions.profiling import primal_gap, primal_integral

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

_RUN = ["question", "family", "method", "seed"]
MAXIMISED = frozenset({"run_bound"})


def with_gaps(table: pd.DataFrame, best: Mapping[str, float] | None = None) -> pd.DataFrame:
    """Add the columns `best` (best known value of the question) and `gap` (primal gap) to a table.

    Parameters
    ----------
    table
        Timed runs, one row per run, with the columns of `profiling.points`.
    best
        Best known value of each question, by the name of the question. A better value in the
        table takes precedence. Default: only the values in the table are known.

    Returns
    -------
    A copy of the table with the two columns.
    """
    known = dict(best or {})
    sign = np.where(table["family"].isin(MAXIMISED), -1.0, 1.0)
    least = (table["value"] * sign).groupby(table["question"]).min()
    column = []
    for question, own, one in zip(
        table["question"], table["question"].map(least), sign, strict=True
    ):
        value = known.get(question, math.nan)
        better = own if math.isnan(value) else np.fmin(own, value * one)
        column.append(better * one)
    gaps = [primal_gap(v, b) for v, b in zip(table["value"], column, strict=True)]
    return table.assign(best=column, gap=gaps)


def integrals(table: pd.DataFrame) -> pd.DataFrame:
    """Return primal integrals over wall time and over work for each question, method and seed.

    The integral over time ends at the duration of the longest run of any method on the question.
    Methods count work in different units, so the integral over work ends at the largest work limit
    of the method itself or, if the method exceeded this limit, at the largest work that it used.

    Parameters
    ----------
    table
        Timed runs with their gaps, as returned by `with_gaps`.

    Returns
    -------
    One row per question, method and seed; the integrals are in the columns `over_wall` and
    `over_work`.
    """
    end_s = table.groupby("question")["wall_s"].max().to_dict()
    rows = []
    for key, run in table.groupby(_RUN, sort=False):
        assert isinstance(key, tuple)
        question = str(key[0])
        wall = zip(run["wall_s"], run["gap"], strict=True)
        work = zip(run["work"], run["gap"], strict=True)
        most = float(run["work_limit"].max())
        rows.append(
            {
                **dict(zip(_RUN, key, strict=True)),
                "over_wall": primal_integral(wall, float(end_s[question])),
                "over_work": primal_integral(work, max(most, float(run["work"].max()))),
            }
        )
    return pd.DataFrame(rows)


def times_to_gap(table: pd.DataFrame, gap: float) -> pd.DataFrame:
    """Return the wall time, in s, that each method needs to reach a given gap on each question.

    Parameters
    ----------
    table
        Timed runs with their gaps, as returned by `with_gaps`.
    gap
        Largest primal gap at which a question counts as solved.

    Returns
    -------
    One row per question and seed, one column per method. An entry is inf if the method never
    reaches the gap, and nan if there is no run of the method.
    """
    reached = table["wall_s"].where(table["gap"] <= gap, np.inf)
    frame = table.assign(reached=reached)
    return frame.pivot_table(
        index=["question", "seed"], columns="method", values="reached", aggfunc="min"
    )


def performance(times: pd.DataFrame, ratios: Sequence[float]) -> pd.DataFrame:
    """Return the performance profile of Dolan and Moré (2002).

    Parameters
    ----------
    times
        Times to solve each question, as returned by `times_to_gap`.
    ratios
        Multiples of the shortest time in which any method solved a question.

    Returns
    -------
    One row per ratio, one column per method: the share of questions that the method solved within
    this multiple of the shortest time of any method on the same question. Each pair of question
    and seed counts as one question. If there is no run of a method on a question, the method
    counts as not having solved it.
    """
    quickest = times.min(axis=1)
    ratio = times.div(quickest, axis=0).where(np.isfinite(times), np.inf)
    return _shares(ratio, ratios)


def data_profile(times: pd.DataFrame, seconds: Sequence[float]) -> pd.DataFrame:
    """Return the share of questions that each method has solved within each of the given times.

    Parameters
    ----------
    times
        Times to solve each question, as returned by `times_to_gap`. The share of a method covers
        only the questions on which it was run.
    seconds
        Wall times in s.

    Returns
    -------
    One row per wall time, one column per method.
    """
    return _shares(times, seconds)


def _shares(values: pd.DataFrame, limits: Sequence[float]) -> pd.DataFrame:
    asked = values.notna().sum()
    rows: list[NDArray[np.float64]] = [
        (values <= limit * (1 + 1e-12)).sum().to_numpy() / asked.to_numpy() for limit in limits
    ]
    return pd.DataFrame(rows, index=list(limits), columns=values.columns)
