"""Analysis of variance: how much of the variation of a measure each factor explains.

Every effect is determined by comparing two linear models, with and without the effect, fitted by
least squares. The number of parameters of a model is taken to be its rank. An interaction therefore
has fewer degrees of freedom if a design leaves out combinations of levels. Effects that the design
cannot separate are detected.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from math import isfinite
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from scipy import linalg, optimize, stats

from rmfs.errors import InputError
from rmfs.experiments.statistics.intervals import independent, require

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

SEEDS, RESIDUAL, POOLED = "seeds", "residual", "interactions"
"""Names of rows that are not the effect of a factor or a pair of factors."""

CROSS = " x "
"""Separator of the names of two factors in the name of their interaction."""

NEGLIGIBLE = 1e-9
"""A model column adds a parameter if the others leave more than this share of it unexplained."""

Effect = tuple[int, ...]
"""An effect: the numbers of its factors, one for a main effect and two for an interaction."""


def anova(
    frame: pd.DataFrame,
    column: str,
    factors: Sequence[str],
    *,
    interactions: bool = True,
    block: str | None = "replication",
    confidence: float = 0.95,
    names: Mapping[str, str] | None = None,
) -> pd.DataFrame:
    """Return the analysis-of-variance table of categorical factors.

    Sums of squares are of type II: each effect is adjusted for all others that do not contain it,
    so that factors of an unbalanced design (with excluded combinations) are not credited with each
    other's effects.

    Interactions of two factors have one row each if the runs can separate all effects and leave at
    least one degree of freedom for the residual. Otherwise (as in a fractional design), a single
    row, `interactions`, holds those differences between combinations of levels that the main
    effects do not explain, and the residual is the variation between runs of the same combination.
    If there are too few runs even for this, interactions are part of the residual. The table's
    attribute `attrs["interactions"]` states which case applies.

    Parameters
    ----------
    factors
        Columns of the factors; those with only one level are left out.
    interactions
        Whether to separate interactions from the residual. Default True.
    block
        Column of the seeds. The variation between seeds gets its own row, as is appropriate with
        common random numbers. If `block` is None, or if runs of the same block have different
        seeds, this variation is part of the residual instead. Default `replication`.
    confidence
        Confidence of the intervals of `partial_eta_sq`. Default 0.95.
    names
        Names of factors in the table, by column. Default: the names of the columns.

    Returns
    -------
    One row per effect, largest sum of squares first, then the rows of seeds and residual. Columns:
    `sum_sq`, `df`, `f`, `p` and the effect sizes `eta_sq` (share of the total of `sum_sq`),
    `partial_eta_sq` with its confidence interval (`partial_eta_sq_low`, `partial_eta_sq_high`;
    Steiger 2004) and `omega_sq` (`eta_sq` corrected for what chance alone explains on average;
    may be negative).

    Raises
    ------
    InputError
        If a column is missing, no factor varies, there are too few runs for the model, or the main
        effect of a factor cannot be separated from those of the others.
    """
    require(frame, column, *factors)
    known = frame[frame[column].notna()]
    varying = varying_factors(known, factors)
    if not varying:
        raise InputError("analysis of variance: no factor has more than one level")
    blocked = block is not None and block in known and len(known[block].unique()) > 1
    blocked = blocked and not independent(known, str(block))
    mains, pairs = _effects(len(varying))
    data = _Data(
        known[column].to_numpy(dtype=float),
        [_coded(known[factor]) for factor in varying],
        _coded(known[block]) if blocked else None,
        [*mains, *pairs],
    )
    called = [(names or {}).get(factor, factor) for factor in varying]
    made, told = _table(data, called, mains, pairs if interactions else [])
    found = _with_sizes(made, confidence)
    found.attrs["interactions"] = told
    found.attrs["confidence"] = confidence
    return found


def varying_factors(frame: pd.DataFrame, factors: Sequence[str]) -> list[str]:
    """Return the factors with more than one level in these runs."""
    return [factor for factor in factors if len(frame[factor].unique()) > 1]


def tell_apart(frame: pd.DataFrame, factors: Sequence[str]) -> bool:
    """Return whether the runs can separate all main effects and two-factor interactions.

    Parameters
    ----------
    factors
        Columns of the factors; those with only one level are left out.
    """
    codes = [_coded(frame[factor]) for factor in varying_factors(frame, factors)]
    mains, pairs = _effects(len(codes))
    data = _Data(np.zeros(len(frame)), codes, None, [*mains, *pairs])
    return bool(pairs) and _told_apart(data, mains, pairs)


def _effects(factors: int) -> tuple[list[Effect], list[Effect]]:
    """Return all main effects, and all pairs."""
    numbers = range(factors)
    return [(number,) for number in numbers], list(itertools.combinations(numbers, 2))


@dataclass(frozen=True)
class _Fit:
    """Residual sum of squares and parameters of a linear model."""

    rest: float
    rank: int


class _Data:
    """Values, factors and blocks of an experiment, to which models are fitted.

    Parameters
    ----------
    y
        A value per run.
    factors
        For each factor, the indicator columns of all levels but the first.
    block
        Indicator columns of all seeds but the first; None: models ignore the seeds.
    effects
        All effects that models may contain.
    """

    def __init__(
        self,
        y: NDArray[np.float64],
        factors: list[NDArray[np.float64]],
        block: NDArray[np.float64] | None,
        effects: Sequence[Effect],
    ) -> None:
        self.y, self.factors, self.block = y, factors, block
        self.runs = len(y)
        parts = {effect: self._columns(effect) for effect in effects}
        columns = [np.ones((self.runs, 1)), *parts.values()]
        if block is not None:
            columns.append(block)
        ends = np.cumsum([part.shape[1] for part in columns])
        places = [
            np.arange(end - part.shape[1], end) for end, part in zip(ends, columns, strict=True)
        ]
        self._constant = places[0]
        self._seeds = places[-1] if block is not None else places[0][:0]
        self._places = dict(zip(effects, places[1:], strict=False))
        # all models are columns of one matrix: reduced to a triangle once, they are small
        basis, triangle = linalg.qr(np.hstack(columns), mode="economic")
        self._triangle = np.asarray(triangle, dtype=np.float64)
        about = y - y.mean()
        self._turned = basis.T @ about
        outside = about - basis @ self._turned
        self._outside = float(outside @ outside)

    def fit(self, effects: Sequence[Effect], *, seeds: bool = True) -> _Fit:
        """Fit the model of these effects, and of the seeds if there are any."""
        chosen = [self._constant, *(self._places[effect] for effect in effects)]
        if seeds:
            chosen.append(self._seeds)
        found = _fitted(self._triangle[:, np.concatenate(chosen)], self._turned)
        return _Fit(found.rest + self._outside, found.rank)

    def fit_combinations(self) -> _Fit:
        """Fit a mean for every combination of levels, beside the seeds."""
        _, cell, count = np.unique(
            np.hstack(self.factors), axis=0, return_inverse=True, return_counts=True
        )
        cell = cell.ravel()

        def within(values: NDArray[np.float64]) -> NDArray[np.float64]:
            sums = np.zeros((len(count), values.shape[1]))
            np.add.at(sums, cell, values)
            return np.asarray(values - (sums / count[:, None])[cell])

        y = within(self.y[:, None])[:, 0]
        if self.block is None:
            return _Fit(float(y @ y), len(count))
        found = _fitted(within(self.block), y)
        return _Fit(found.rest, found.rank + len(count))

    def _columns(self, effect: Effect) -> NDArray[np.float64]:
        made = self.factors[effect[0]]
        for factor in effect[1:]:
            made = (made[:, :, None] * self.factors[factor][:, None, :]).reshape(self.runs, -1)
        return made


def _fitted(model: NDArray[np.float64], y: NDArray[np.float64]) -> _Fit:
    """Fit a model to y; columns that depend linearly on others do not count as parameters."""
    basis, triangle, _ = linalg.qr(model, mode="economic", pivoting=True)
    size = np.abs(np.diag(triangle))
    basis = basis[:, size > NEGLIGIBLE * max(1.0, size[0])]
    rest = y - basis @ (basis.T @ y)
    return _Fit(float(rest @ rest), basis.shape[1])


def _coded(values: pd.Series) -> NDArray[np.float64]:
    # a missing level is a level: the parameter as it is in the file
    text = values.astype(object).map(lambda level: "" if pd.isna(level) else str(level))
    codes, levels = pd.factorize(text)
    return np.equal.outer(codes, np.arange(1, len(levels))).astype(float)


def _table(
    data: _Data, names: Sequence[str], mains: list[Effect], pairs: list[Effect]
) -> tuple[pd.DataFrame, str]:
    """Return sums of squares and degrees of freedom, and what was done with interactions."""
    alone = data.fit(mains)
    for effect in mains:
        if _between(data, effect, mains)[1] == 0:
            raise InputError(
                f"analysis of variance: the levels of {names[effect[0]]} cannot be separated "
                "from those of the other factors"
            )
    told, chosen, residual = "", mains, alone
    rows: dict[str, tuple[float, int]] = {}
    if pairs:
        whole, cells = data.fit([*mains, *pairs]), data.fit_combinations()
        if data.runs > whole.rank and _told_apart(data, mains, pairs):
            chosen, residual = [*mains, *pairs], whole
            told = "each interaction of two factors has a row"
        elif data.runs > cells.rank > alone.rank:
            rows[POOLED] = (alone.rest - cells.rest, cells.rank - alone.rank)
            residual = cells
            told = (
                "these runs cannot separate the interactions of single pairs of factors: all "
                "interactions form one row"
            )
        else:
            told = "too few runs to separate interactions: they are in the residual"
    elif len(names) > 1:
        told = "interactions are in the residual"
    if data.runs <= residual.rank:
        raise InputError(
            f"analysis of variance: {data.runs} runs are too few for {len(names)} factors"
        )
    for effect in chosen:
        rows[CROSS.join(names[number] for number in effect)] = _between(data, effect, chosen)
    if data.block is not None:
        without = data.fit(chosen, seeds=False)
        present = data.fit(chosen)
        rows[SEEDS] = (max(0.0, without.rest - present.rest), present.rank - without.rank)
    rows[RESIDUAL] = (residual.rest, data.runs - residual.rank)
    made = pd.DataFrame.from_dict(rows, orient="index", columns=["sum_sq", "df"])
    made.index.name = "effect"
    return made, told


def _between(data: _Data, effect: Effect, model: Sequence[Effect]) -> tuple[float, int]:
    """Return sum of squares and degrees of freedom of an effect (type II) in a model."""
    others = [other for other in model if not set(effect) <= set(other)]
    without, present = data.fit(others), data.fit([*others, effect])
    return max(0.0, without.rest - present.rest), present.rank - without.rank


def _told_apart(data: _Data, mains: list[Effect], pairs: list[Effect]) -> bool:
    """Whether no effect loses degrees of freedom if interactions are in the model."""
    model = [*mains, *pairs]
    return all(
        _between(data, effect, model)[1] == _between(data, effect, [*mains, effect])[1] > 0
        for effect in model
    )


def _with_sizes(raw: pd.DataFrame, confidence: float) -> pd.DataFrame:
    made = raw.copy()
    # a factor may explain a column to the last digit: what is left is rounding
    made["sum_sq"] = made["sum_sq"].where(
        made["sum_sq"] > NEGLIGIBLE**2 * made["sum_sq"].sum(), 0.0
    )
    rest, rest_df = float(made["sum_sq"][RESIDUAL]), int(made["df"][RESIDUAL])
    total, mean_square = made["sum_sq"].sum(), rest / rest_df
    effect = made.index != RESIDUAL
    made["f"] = (made["sum_sq"] / made["df"] / mean_square).where(effect)
    made["p"] = stats.f.sf(made["f"], made["df"], rest_df)
    made["eta_sq"] = made["sum_sq"] / total
    made["partial_eta_sq"] = (made["sum_sq"] / (made["sum_sq"] + rest)).where(effect)
    omega_sq = (made["sum_sq"] - made["df"] * mean_square) / (total + mean_square)
    made["omega_sq"] = omega_sq.where(effect)
    ends = [
        _partial_interval(f, df, rest_df, confidence)
        for f, df in zip(made["f"], made["df"], strict=True)
    ]
    made["partial_eta_sq_low"], made["partial_eta_sq_high"] = zip(*ends, strict=True)
    last = [name for name in (SEEDS, RESIDUAL) if name in made.index]
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
        while (beyond := excess(most)) > 0:
            most *= 2  # with very few degrees of freedom, the interval is wide
        if np.isnan(beyond):
            return float("nan")  # the distribution cannot be computed for so large an F
        noncentrality = float(optimize.brentq(excess, 0.0, most))
        return noncentrality / (noncentrality + df + rest_df + 1)

    return share((1 + confidence) / 2), share((1 - confidence) / 2)
