"""Observations for a policy: global features, and the k best candidates of a question."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rmfs.control.features import (
    COLUMNS,
    KINDS,
    LIMIT,
    RANKINGS,
    SCALES,
    Feature,
    best_rows,
    features_of,
    unscaled,
)
from rmfs.control.overview import GLOBAL_FEATURES, overview
from rmfs.control.problems import Problem
from rmfs.control.task_candidates import MOVE, has_tasks
from rmfs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.simulation.decision import Decision

_NONE = np.empty(0, np.intp)


class Options(NamedTuple):
    """The answers offered to a policy.

    Attributes
    ----------
    decision
        The question.
    rows
        Row numbers in `decision.candidates` of the best candidates (at most k), the best first.
    features
        Scaled features of these candidates, shape (k, F); if there are fewer than k, the
        remaining rows are zero.
    mask
        Which actions are possible, shape (k + 1,): action i chooses the candidate in `rows[i]`, and
        the last action declines.
    """

    decision: Decision
    rows: NDArray[np.intp]
    features: NDArray[np.float32]
    mask: NDArray[np.int8]

    @property
    def kind(self) -> str:
        """The kind of the question, one of `Observing.kinds`."""
        return kind_of(self.decision)

    @property
    def is_forced(self) -> bool:
        """Whether only one action is possible."""
        return int(np.count_nonzero(self.mask)) < 2


class Observing:
    """Creates observations for a set of decision problems.

    Parameters
    ----------
    problems
        The problems that the policy decides.
    candidates
        Maximum number k of candidates offered.
    rankings
        Weights of features for ranking the candidates, by kind of question. For kinds not given,
        those of `rmfs.control.features.RANKINGS` apply.

    Attributes
    ----------
    kinds
        Kinds of question that may be asked.
    features
        Descriptions of the features of a candidate, in order of the columns of `Options.features`.
    global_features
        Descriptions of the features of warehouse and question, in order of the elements of the
        vector that `globals_of` returns.

    Raises
    ------
    InputError
        If `candidates` is less than 1, or a problem, kind of question or feature does not exist.
    """

    def __init__(
        self,
        problems: Sequence[str],
        candidates: int,
        rankings: Mapping[str, Mapping[str, float]] | None = None,
    ) -> None:
        if candidates < 1:
            raise InputError(f"candidates: must be 1 or more (given: {candidates})")
        known = [str(problem) for problem in KINDS]
        for problem in problems:
            if problem not in known:
                raise InputError(f"problem {problem}: must be one of {', '.join(known)}")
        self.k = candidates
        self.kinds = tuple(kind for one in problems for kind in KINDS[Problem(one)])
        self.features = features_of(self.kinds)
        self.global_features = (
            *GLOBAL_FEATURES,
            *(
                Feature(f"is {kind}", "", 1.0, "1 if the question is of this kind")
                for kind in self.kinds
            ),
        )
        self._shape = (candidates, len(self.features))
        self._only_decline = np.zeros(candidates + 1, np.int8)
        self._only_decline[candidates] = 1
        self._names = [feature.name for feature in self.features]
        self._places = {kind: _places(kind, self._names) for kind in self.kinds}
        self._rankings = {**RANKINGS, **_checked(rankings or {})}

    def options(self, decision: Decision, *, may_move: bool) -> Options:
        """Return the best candidates of a question, their features, and the mask of actions.

        Parameters
        ----------
        may_move
            Whether the candidates of TA include the task of moving an idle pod.
        """
        kind = kind_of(decision)
        if kind == "ta" and not may_move and not has_tasks(decision.view):
            return Options(decision, _NONE, np.zeros(self._shape, np.float32), self._only_decline)
        candidates = decision.candidates
        rows = None  # all
        if kind == "ta" and not may_move:
            rows = (candidates.columns["kind"] != MOVE).nonzero()[0]
        count = len(candidates) if rows is None else len(rows)
        mask = np.zeros(self.k + 1, np.int8)
        mask[: min(count, self.k)] = 1
        mask[self.k] = decision.kind != "next station"
        found = np.zeros(self._shape, np.float32)
        if not count:
            return Options(decision, _NONE, found, mask)
        # one row per feature: a few long operations instead of many short ones
        block = unscaled(candidates, kind, decision.view)
        if rows is not None:
            block = block[:, rows]
        columns = dict(zip(COLUMNS[kind], block, strict=True))
        best = best_rows(columns, self._rankings[kind], self.k)
        block = block[:, best]
        places, scales = self._places[kind]
        if len(block):
            block /= scales
            np.minimum(block, LIMIT, out=block)
            np.maximum(block, -LIMIT, out=block)
            found[: len(best), places] = block.T
        return Options(decision, best if rows is None else rows[best], found, mask)

    def globals_of(self, view: View, decision: Decision | None) -> NDArray[np.float32]:
        """Return the features of the warehouse and then of the question, shape (G,).

        Those of the question are a one-hot encoding of its kind, or 0 if there is none.
        """
        found = np.zeros(len(self.global_features), np.float32)
        found[: len(GLOBAL_FEATURES)] = overview(view)
        if decision is not None:
            found[len(GLOBAL_FEATURES) + self.kinds.index(kind_of(decision))] = 1.0
        return found


def kind_of(decision: Decision) -> str:
    """Return `decision.kind`, or the name of the problem if that kind is `turn`."""
    return decision.problem.value if decision.kind == "turn" else decision.kind


def _places(kind: str, names: Sequence[str]) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
    """Return the positions of the features of a kind of question, and their scales, (F, 1)."""
    places = np.array([names.index(name) for name in COLUMNS[kind]], np.intp)
    return places, np.array([[SCALES[name]] for name in COLUMNS[kind]])


def _checked(rankings: Mapping[str, Mapping[str, float]]) -> dict[str, dict[str, float]]:
    for kind, weights in rankings.items():
        if kind not in COLUMNS:
            raise InputError(
                f"rankings.{kind}: unknown kind of question; valid: {', '.join(COLUMNS)}"
            )
        for name in weights:
            if name not in COLUMNS[kind]:
                raise InputError(
                    f"rankings.{kind}.{name}: unknown feature; valid: {', '.join(COLUMNS[kind])}"
                )
    return {kind: dict(weights) for kind, weights in rankings.items()}


def is_same(answer: Any, other: Any) -> bool:
    """Return whether two answers are equal."""
    return type(answer) is type(other) and bool(answer == other)
