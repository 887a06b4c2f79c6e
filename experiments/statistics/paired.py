"""Differences between arms, seed by seed.

With common random numbers, runs of two arms with the same seed face the same demand, so the
difference within such a pair usually varies less than the results of the arms themselves.
Differences are always "arm minus baseline".
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from scipy import stats

from rmfs.errors import InputError
from rmfs.experiments.statistics.intervals import Method, independent, interval, require

if TYPE_CHECKING:
    from collections.abc import Hashable

    from numpy.typing import NDArray


def paired(
    arm: pd.Series, baseline: pd.Series, *, confidence: float = 0.95, method: Method = "t"
) -> dict[str, float]:
    """Compare two arms seed by seed.

    Parameters
    ----------
    arm, baseline
        One number per seed, indexed by seed; only seeds that both arms have are used.

    Returns
    -------
    `pairs` (number of seeds used), `difference` (mean of arm minus baseline), `low` and `high`
    (ends of the confidence interval of `difference`), `relative` (`difference` / mean of the
    baseline), and `p` of the paired t test (two-sided; nan for fewer than two pairs).
    """
    both = pd.concat([arm, baseline], axis=1, keys=["arm", "baseline"], join="inner").dropna()
    values = both.to_numpy(dtype=float)
    differences = values[:, 0] - values[:, 1]
    found = interval(differences, confidence, method)
    base = float(values[:, 1].mean()) if len(values) else np.nan
    return {
        "pairs": found.count,
        "difference": found.mean,
        "low": found.low,
        "high": found.high,
        "relative": found.mean / base if base else np.nan,
        "p": _p_value(differences),
    }


def unpaired(arm: pd.Series, baseline: pd.Series, *, confidence: float = 0.95) -> dict[str, float]:
    """Compare two arms that share no seeds, by Welch's t test.

    Returns
    -------
    The same entries as `paired` returns; `pairs` is 0, and `low`, `high` and `p` are those of
    Welch's test.
    """
    a, b = arm.dropna().to_numpy(dtype=float), baseline.dropna().to_numpy(dtype=float)
    difference = float(a.mean() - b.mean()) if len(a) and len(b) else np.nan
    low = high = p = np.nan
    if len(a) > 1 and len(b) > 1 and (a.std() > 0 or b.std() > 0):
        test = stats.ttest_ind(a, b, equal_var=False)
        found = test.confidence_interval(confidence)
        low, high, p = float(found.low), float(found.high), float(test.pvalue)
    base = float(b.mean()) if len(b) else np.nan
    return {
        "pairs": 0,
        "difference": difference,
        "low": low,
        "high": high,
        "relative": difference / base if base else np.nan,
        "p": p,
    }


def against(
    frame: pd.DataFrame,
    column: str,
    baseline: Hashable,
    *,
    confidence: float = 0.95,
    method: Method = "t",
    by: str = "arm",
    pair: str = "replication",
) -> pd.DataFrame:
    """Compare every arm with a baseline: seed by seed or, if they share no seeds, as `unpaired`.

    Parameters
    ----------
    baseline
        The arm with which the others are compared.
    method
        Method for the intervals of paired differences.
    pair
        Column that identifies pairs. Default `replication`, the seed as given in the design.

    Returns
    -------
    One row per other arm. Columns: the entries that `paired` returns; `p_holm`, which is `p`
    corrected for the number of rows by Holm's method (Holm 1979); and `direction`: "higher" or
    "lower" than the baseline if `p_holm` is below 1 - `confidence`, otherwise "unclear".

    Raises
    ------
    InputError
        If a column is missing, or the baseline has no results.
    """
    require(frame, by, column, pair)
    wide = frame.pivot_table(index=pair, columns=by, values=column, aggfunc="mean", sort=False)
    if baseline not in wide:
        raise InputError(f"baseline {baseline}: no such arm with results")
    others = [arm for arm in frame[by].unique() if arm != baseline and arm in wide]
    apart = independent(frame, pair)
    rows = {
        arm: unpaired(wide[arm], wide[baseline], confidence=confidence)
        if apart
        else paired(wide[arm], wide[baseline], confidence=confidence, method=method)
        for arm in others
    }
    made = pd.DataFrame.from_dict(rows, orient="index")
    made.index.name = by
    if made.empty:
        return made
    made["pairs"] = made["pairs"].astype(int)
    made["p_holm"] = holm(made["p"])
    unclear = ~(made["p_holm"] < 1.0 - confidence)
    made["direction"] = np.where(made["difference"] > 0.0, "higher", "lower")
    made.loc[unclear, "direction"] = "unclear"
    return made


def holm(p_values: pd.Series) -> pd.Series:
    """Return p values corrected by Holm's method (Holm 1979); missing values stay missing."""
    # not by statsmodels, which collects garbage at each call: a third of a second each time
    values = p_values.to_numpy(dtype=float, na_value=np.nan)
    known = int(np.count_nonzero(~np.isnan(values)))
    smallest_first = np.argsort(values, kind="stable")[:known]
    multiplied = values[smallest_first] * np.arange(known, 0, -1)
    corrected = np.full(len(values), np.nan)
    corrected[smallest_first] = np.minimum(np.maximum.accumulate(multiplied), 1.0)
    return pd.Series(corrected, index=p_values.index)


def _p_value(differences: NDArray[np.float64]) -> float:
    """Return p of the paired t test: that of one sample of differences."""
    if len(differences) < 2:
        return np.nan
    if (differences == differences[0]).all():
        # no spread at all: the test statistic is 0 / 0 or infinite
        return 1.0 if differences[0] == 0.0 else 0.0
    return float(stats.ttest_1samp(differences, 0.0).pvalue)
