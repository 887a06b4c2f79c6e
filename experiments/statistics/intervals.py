"""Means of independent runs and their confidence intervals."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
import pandas as pd
from scipy import stats

from rmfs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

Method = Literal["t", "bootstrap"]

RESAMPLES = 1999
BOOTSTRAP_SEED = 0
"""Seed of the resampling, which is fixed so that equal data give equal intervals."""


@dataclass(frozen=True, slots=True)
class Interval:
    """A mean and its confidence interval.

    Attributes
    ----------
    count
        Number of runs.
    low, high
        Ends of the interval; nan for fewer than two runs.
    """

    count: int
    mean: float
    low: float
    high: float

    @property
    def half_width(self) -> float:
        """Half the length of the interval."""
        return (self.high - self.low) / 2.0


def interval(
    values: Sequence[float] | NDArray[np.float64] | pd.Series,
    confidence: float = 0.95,
    method: Method = "t",
) -> Interval:
    """Return the mean of independent runs and its confidence interval.

    Parameters
    ----------
    values
        One number per run; missing values are ignored.
    confidence
        Probability with which such an interval covers the true mean. Default 0.95.
    method
        `t`: Student's t, exact if the values are normally distributed. `bootstrap`: bias-corrected
        and accelerated (Efron 1987), for other distributions; with few runs, its intervals are too
        narrow (see `tests.tools.coverage`). Default `t`.
    """
    given = np.asarray(values, dtype=float)
    given = given[~np.isnan(given)]
    if len(given) == 0:
        return Interval(0, np.nan, np.nan, np.nan)
    mean = float(given.mean())
    if len(given) == 1:
        return Interval(1, mean, np.nan, np.nan)
    if (given == given[0]).all():
        return Interval(len(given), mean, mean, mean)
    if method == "t":
        low, high = stats.t.interval(confidence, len(given) - 1, loc=mean, scale=stats.sem(given))
    elif method == "bootstrap":
        found = stats.bootstrap(
            (given,),
            np.mean,
            confidence_level=confidence,
            n_resamples=RESAMPLES,
            method="BCa",
            rng=np.random.default_rng(BOOTSTRAP_SEED),
        ).confidence_interval
        low, high = found.low, found.high
    else:
        raise InputError(f"method {method}: no such interval; valid: t, bootstrap")
    return Interval(len(given), mean, float(low), float(high))


def per_arm(
    frame: pd.DataFrame,
    column: str,
    *,
    confidence: float = 0.95,
    method: Method = "t",
    by: str = "arm",
) -> pd.DataFrame:
    """Return the mean of a column and its confidence interval, for every arm.

    Parameters
    ----------
    by
        Column that identifies the arms. Default `arm`.

    Returns
    -------
    One row per arm, in order of first appearance. Columns: `count`, `mean`, `low`, `high`,
    `half_width`, `relative_half_width` (half width divided by the absolute value of the mean) and
    `sd` (standard deviation).
    """
    require(frame, by, column)
    rows = {}
    for arm, given in frame.groupby(by, sort=False)[column]:
        # counts that a run does not have, such as charges without batteries, are NA, not nan
        values = pd.Series(given.to_numpy(dtype=float, na_value=np.nan))
        found = interval(values, confidence, method)
        rows[arm] = {
            "count": found.count,
            "mean": found.mean,
            "low": found.low,
            "high": found.high,
            "half_width": found.half_width,
            "relative_half_width": found.half_width / abs(found.mean) if found.mean else np.nan,
            "sd": float(values.std(ddof=1)),
        }
    made = pd.DataFrame.from_dict(rows, orient="index").astype({"count": int})
    made.index.name = by
    return made


def independent(frame: pd.DataFrame, pair: str = "replication") -> bool:
    """Return whether runs of the same replication differ in their seeds.

    This is the case in a design without common random numbers. Such runs are not pairs.

    Parameters
    ----------
    frame
        One row per run. Without the column `seed`, replications are assumed to be seeds.
    pair
        Column of the replications. Default `replication`.
    """
    if "seed" not in frame or pair not in frame:
        return False
    return bool(frame[[pair, "seed"]].drop_duplicates()[pair].duplicated().any())


def require(frame: pd.DataFrame, *columns: str) -> None:
    """Raise an error if a column is missing from a frame.

    Raises
    ------
    InputError
        If a column is missing; the message names similar ones.
    """
    import difflib

    for column in columns:
        if column not in frame:
            near = difflib.get_close_matches(column, [str(c) for c in frame.columns], n=3)
            hint = f"; did you mean {' or '.join(near)}?" if near else ""
            raise InputError(f"column {column}: not in the results{hint}")
