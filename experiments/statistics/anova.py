"""Analysis of variance: how much of the spread of a measure each factor explains."""

from __future__ import annotations

import itertools
from math import isfinite
from typing import TYPE_CHECKING

import pandas as pd
from scipy import optimize, stats

from rmfs.errors import InputError
from rmfs.experiments.statistics.intervals import require

if TYPE_CHECKING:
    from collections.abc import Sequence


def anova(
    frame: pd.DataFrame,
    column: str,
    factors: Sequence[str],
    *,
    interactions: bool = False,
    block: str | None = "replication",
    confidence: float = 0.95,
) -> pd.DataFrame:
    """Return the analysis-of-variance table of categorical factors.

    Sums of squares are of type II: each main effect after all other main effects, so that factors
    of an unbalanced design (with excluded combinations) do not take credit for each other.

    Parameters
    ----------
    factors
        Columns; factors with one level are left out.
    interactions
        Whether to add all pairs of factors. Default not.
    block
        Column of the seeds, whose share of the spread is taken out of the residual (with common
        random numbers). Default `replication`.
    confidence
        Of the intervals of `partial_eta_sq`. Default 0.95.

    Returns
    -------
    One row per effect, strongest first, then seeds and residual: `sum_sq df f p`, effect sizes
    `eta_sq` (share of the sum of all rows), `partial_eta_sq` with its interval
    (`partial_eta_sq_low`, `partial_eta_sq_high`; Steiger 2004) and `omega_sq` (an estimate
    that does not grow with the number of levels; may fall below 0).

    Raises
    ------
    InputError
        If no factor varies, or there are too few runs for the model.
    """
    from rmfs.experiments.extras import statsmodels

    require(frame, column, *factors)
    varying = [factor for factor in factors if len(frame[factor].unique()) > 1]
    if not varying:
        raise InputError("analysis of variance: no factor has more than one level")
    blocked = block is not None and block in frame and len(frame[block].unique()) > 1
    data, terms = _data(frame, column, varying, block if blocked else None, interactions)
    formula = "y ~ " + " + ".join(f"C({term})".replace(":", "):C(") for term in terms)
    model = statsmodels("formula.api").ols(formula, data).fit()
    if model.df_resid < 1:
        raise InputError(
            f"analysis of variance: {len(data)} runs are too few for {len(terms)} effects"
        )
    raw = statsmodels("stats.anova").anova_lm(model, typ=2)
    raw.index = pd.Index([*terms.values(), "residual"], name="effect")
    return _with_sizes(raw, "seeds" if blocked else None, confidence)


def _data(
    frame: pd.DataFrame, column: str, factors: Sequence[str], block: str | None, interactions: bool
) -> tuple[pd.DataFrame, dict[str, str]]:
    """Return the data under names that a formula can hold, and name the terms."""
    safe = {factor: f"f{number}" for number, factor in enumerate(factors)}
    data = pd.DataFrame({"y": frame[column].astype(float)})
    for factor, name in safe.items():
        # a missing level is a level: the parameter as it is in the file
        data[name] = frame[factor].map(lambda level: "" if level is None else str(level))
    terms = {name: factor for factor, name in safe.items()}
    if interactions:
        terms |= {
            f"{safe[one]}:{safe[two]}": f"{one} x {two}"
            for one, two in itertools.combinations(factors, 2)
        }
    if block is not None:
        data["block"] = frame[block].astype(str)
        terms["block"] = "seeds"
    return data.dropna(), terms


def _with_sizes(raw: pd.DataFrame, seeds: str | None, confidence: float) -> pd.DataFrame:
    made = raw.rename(columns={"F": "f", "PR(>F)": "p"})[["sum_sq", "df", "f", "p"]]
    rest, rest_df = float(made["sum_sq"]["residual"]), float(made["df"]["residual"])
    total, mean_square = made["sum_sq"].sum(), rest / rest_df
    made["eta_sq"] = made["sum_sq"] / total
    made["partial_eta_sq"] = made["sum_sq"] / (made["sum_sq"] + rest)
    made["omega_sq"] = (made["sum_sq"] - made["df"] * mean_square) / (total + mean_square)
    made.loc["residual", ["partial_eta_sq", "omega_sq"]] = float("nan")
    ends = [
        _partial_interval(f, df, rest_df, confidence)
        for f, df in zip(made["f"], made["df"], strict=True)
    ]
    made["partial_eta_sq_low"], made["partial_eta_sq_high"] = zip(*ends, strict=True)
    made["df"] = made["df"].round().astype(int)
    last = [name for name in (seeds, "residual") if name is not None]
    effects = made.drop(index=last).sort_values("sum_sq", ascending=False)
    return pd.concat([effects, made.loc[last]])


def _partial_interval(
    f: float, df: float, rest_df: float, confidence: float
) -> tuple[float, float]:
    """Return the interval of a partial eta squared, from that of the noncentrality of F.

    Steiger (2004), Beyond the F test, Psychological Methods 9(2): the ends are the noncentralities
    for which the F found is the upper and the lower quantile.
    """
    if not isfinite(f):
        return float("nan"), float("nan")

    def share(quantile: float) -> float:
        def excess(noncentrality: float) -> float:
            return float(stats.ncf.cdf(f, df, rest_df, noncentrality)) - quantile

        if excess(0.0) <= 0:
            return 0.0
        most = 4 * f * df + 100
        noncentrality = float(optimize.brentq(excess, 0.0, most))
        return noncentrality / (noncentrality + df + rest_df + 1)

    return share((1 + confidence) / 2), share((1 - confidence) / 2)
