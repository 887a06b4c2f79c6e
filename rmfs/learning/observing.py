"""Observations for a policy: global features, and the k best candidates of a question."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from rmfs.control.features import (
    COLUMNS,
    KINDS,
    LIMIT,
    RANKINGS,
    SCALES,
    Feature,
    features_of,
    unscaled,
    weights_of,
)
from rmfs.control.overview import GLOBAL_FEATURES, overview
from rmfs.control.problems import Problem
from rmfs.control.task_candidates import TaskCandidates, lacks_tasks
from rmfs.errors import InputError
from rmfs.traffic._core import offered  # the package has one compiled library

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.simulation.decision import Decision

_NONE = np.empty(0, np.int64)


class Options(NamedTuple):
    """The answers from which a policy can choose.

    Attributes
    ----------
    decision
        The question to be answered.
    rows
        Rows of `decision.candidates` with the best candidates (at most k), the best first.
    features
        The F scaled features of each of these candidates, shape (k, F). With fewer than k
        candidates, the remaining rows are zero.
    mask
        Whether each action is possible, shape (k + 1,): action i chooses the candidate in row
        `rows[i]`, and action k declines.
    """

    decision: Decision
    rows: NDArray[np.int64]
    features: NDArray[np.float32]
    mask: NDArray[np.bool_]

    @property
    def kind(self) -> str:
        """The kind of the question, one of `Observing.kinds`."""
        return kind_of(self.decision)

    @property
    def is_forced(self) -> bool:
        """Whether at most one action is possible."""
        return len(self.rows) + self.mask.item(-1) < 2


class Observing:
    """Creates observations for a set of decision problems.

    Parameters
    ----------
    problems
        The problems that the policy decides.
    candidates
        Maximum number k of candidates offered.
    rankings
        Weights of features for ranking the candidates, by kind of question. For kinds that are not
        given, the weights in `rmfs.control.features.RANKINGS` are used.

    Attributes
    ----------
    kinds
        Kinds of question that come up in these problems.
    features
        Descriptions of the F features of a candidate, in order of the columns of
        `Options.features`.
    global_features
        Descriptions of the G features of the warehouse and the question, in order of the elements
        of the vector that `globals_of` returns.

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
        if isinstance(problems, str):
            raise InputError(f'problems {problems}: must be a list, such as ["{problems}"]')
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
        self._nothing = np.zeros((candidates, len(self.features)), np.float32)
        self._nothing.flags.writeable = False
        self._masks = {
            (count, may_decline): _mask(count, candidates, may_decline)
            for count in range(candidates + 1)
            for may_decline in (False, True)
        }
        none = np.zeros(len(self.kinds), np.float32)
        self._is_kind = {kind: none.copy() for kind in self.kinds}
        for at, kind in enumerate(self.kinds):
            self._is_kind[kind][at] = 1.0
        self._is_kind[""] = none
        known_rankings = {**RANKINGS, **_checked(rankings or {})}
        names = [feature.name for feature in self.features]
        self._ranked = {
            kind: (weights_of(kind, known_rankings), candidates, *_places(kind, names))
            for kind in self.kinds
        }

    def options(self, decision: Decision, *, may_move: bool) -> Options:
        """Return the best candidates of a question, their features, and which actions are possible.

        Parameters
        ----------
        may_move
            Whether the candidates of TA include repositioning, the task of moving an idle pod.
        """
        kind = kind_of(decision)
        if kind == "ta" and not may_move and lacks_tasks(decision.view):
            return self._none(decision)
        candidates = decision.candidates
        rows = None  # all
        if isinstance(candidates, TaskCandidates) and not may_move:
            rows = candidates.without_moves()
        count = len(candidates) if rows is None else len(rows)
        if not count:
            return self._none(decision)
        if isinstance(candidates, TaskCandidates):
            values = candidates.features(rows)
        else:
            values = unscaled(candidates, kind, decision.view)
        best, features = offered(values, *self._ranked[kind])
        if rows is not None:
            best = np.array([rows[row] for row in best.tolist()], np.int64)
        mask = self._masks[min(count, self.k), decision.kind != "next station"]
        return Options(decision, best, features, mask)

    def _none(self, decision: Decision) -> Options:
        """Return the options of a question without candidates."""
        mask = self._masks[0, decision.kind != "next station"]
        return Options(decision, _NONE, self._nothing, mask)

    def globals_of(self, view: View, decision: Decision | None) -> NDArray[np.float32]:
        """Return the features of the warehouse, followed by those of the question, shape (G,).

        The features of the question are a one-hot encoding of its kind; they are all 0 without a
        question.
        """
        kind = "" if decision is None else kind_of(decision)
        return np.concatenate((overview(view), self._is_kind[kind]))


def kind_of(decision: Decision) -> str:
    """Return the kind of a question or, if that is `turn`, the name of the problem."""
    return decision.problem if decision.kind == "turn" else decision.kind


def _mask(count: int, k: int, may_decline: bool) -> NDArray[np.bool_]:
    """Return whether each of k + 1 actions is possible with `count` candidates; read-only."""
    mask = np.zeros(k + 1, np.bool_)
    mask[:count] = True
    mask[k] = may_decline
    mask.flags.writeable = False
    return mask


def _places(
    kind: str, names: Sequence[str]
) -> tuple[NDArray[np.float64], NDArray[np.int64], int, float]:
    """Return the place of a kind's features in an observation.

    The result consists of the scales and columns of these features, the total number of columns,
    and the limit to which values are clipped.
    """
    places = np.array([names.index(name) for name in COLUMNS[kind]], np.int64)
    scales = np.array([SCALES[name] for name in COLUMNS[kind]], np.float64)
    return scales, places, len(names), LIMIT


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
